"""Recorded instruction counts of the catalogue's encodings and packings, for machines without compilers.

`python -m tests.recorded_costs` counts the instructions again and writes recorded.json next to this file.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, Protocol

from ....gbuffer.defines import kernels
from ....gbuffer.defines.kernels import Operation
from ...ground.output.cache import key_of

FILE = Path(__file__).with_name("recorded.json")
COLUMNS = ("instructions", "executed_slots", "loops")


class Counted(Protocol):
    """A named operation of an encoding or a packing, whose instructions are counted."""

    @property
    def name(self) -> str: ...
    @property
    def operation(self) -> str: ...
    def make(self) -> Operation: ...


def recorded(chosen: Sequence[Any], family: str, stage: str) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Yield each operation of `chosen` that has recorded counts, with its `COLUMNS` and, as `recorded_by`, the
    compiler that counted it. Operations whose GLSL has changed since, or whose family was not counted, are left
    out."""
    known = _kept()["families"].get(family, {"stage": "", "by": "", "counts": {}})
    for case in chosen if known["stage"] == stage else ():
        counts = known["counts"].get(case.name)
        if counts and _kept()["sources"][case.name] == source_key(case, stage):
            yield case, dict(zip(COLUMNS, counts, strict=True)) | {"recorded_by": known["by"]}


def source_key(case: Counted, stage: str) -> str:
    """Return a key that changes whenever the GLSL source of an operation's kernel changes. Raises ShaderError."""
    return key_of(case.make().source(kernels.STAGES[stage]).text)[:16]


@cache
def _kept() -> dict[str, Any]:
    return json.loads(FILE.read_text(encoding="utf-8"))
