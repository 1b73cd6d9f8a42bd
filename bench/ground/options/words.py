"""Names as users give them: as comma-separated text or, in Python, as several names, some of which represent
values."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, TypeAlias

# In the name of a file.
MOST_COMMAS = 4


class Given(NamedTuple):
    """A Python caller's own value, with its name."""

    name: str
    value: Any

    def __str__(self) -> str:
        return self.name


Word: TypeAlias = str | Given
Names: TypeAlias = tuple[Word, ...]


def names(text: str, is_whole: Callable[[str], bool] = lambda _: False, repeats: bool = False) -> tuple[str, ...]:
    """Split text into a tuple of comma-separated names without surrounding spaces. No other function splits such
    text.

    Args:
        is_whole: tells whether a text with commas is one name, such as a file name.
        repeats: whether a name that occurs twice counts twice.
    """
    parts, words = text.split(","), list[str]()
    while parts:
        several = (size for size in range(min(len(parts), MOST_COMMAS + 1), 1, -1))
        size = next((size for size in several if is_whole(",".join(parts[:size]).strip())), 1)
        words.append(",".join(parts[:size]).strip())
        parts = parts[size:]
    words = [word for word in words if word]
    return tuple(words if repeats else dict.fromkeys(words))


def text_of(words: Iterable[Word]) -> str:
    """Return names as they are typed: as one comma-separated text."""
    return ",".join(map(str, words))


def typed(value: Any) -> Any:
    """Return an option's value as the user types it: a tuple of names as one comma-separated text, else unchanged."""
    return text_of(value) if isinstance(value, tuple) else value


def words_in(value: str | Names | None) -> Names:
    """Return an option's value as a tuple of words: a text as one word, several names unchanged, and None as no
    words."""
    return (value,) if isinstance(value, str) else value or ()
