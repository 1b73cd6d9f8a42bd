"""Names as typed, and values that stand for names: what a Python caller gives where the command line has text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class Words(str):
    """Comma-separated names, some of which stand for values of the caller's own.

    Attributes:
        given: those values by their names.
    """

    given: Mapping[str, Any]

    def __new__(cls, names: list[str], given: Mapping[str, Any]) -> Words:
        made = super().__new__(cls, ",".join(names))
        made.given = given
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        # A text's own way has no values.
        return Words, ([str(self)], self.given)


def given_in(names: str) -> Mapping[str, Any]:
    """The caller's own values among names; none in plain text."""
    return names.given if isinstance(names, Words) else {}
