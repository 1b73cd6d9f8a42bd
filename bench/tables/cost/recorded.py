"""Recorded instruction counts of the catalogue's encodings and packings, for machines without compilers.

`python -m tests.recorded_costs` counts them again, and writes recorded.json next to this file.
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
    """An operation of an encoding or of a packing, by its name."""

    @property
    def name(self) -> str: ...
    @property
    def operation(self) -> str: ...
    def make(self) -> Operation: ...


def recorded(chosen: Sequence[Any], family: str, stage: str) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Yield operations with their `COLUMNS`, and with the compiler that counted them as `recorded_by`. Operations
    whose GLSL has changed since, or whose family was not counted, are left out."""
    known = _kept()["families"].get(family, {"stage": "", "by": "", "counts": {}})
    for case in chosen if known["stage"] == stage else ():
        counts = known["counts"].get(case.name)
        if counts and _kept()["sources"][case.name] == source_key(case, stage):
            yield case, dict(zip(COLUMNS, counts, strict=True)) | {"recorded_by": known["by"]}


def source_key(case: Counted, stage: str) -> str:
    """Return a key that changes whenever the GLSL of an operation's kernel does. Raises ShaderError."""
    return key_of(case.make().source(kernels.STAGES[stage]).text)[:16]


@cache
def _kept() -> dict[str, Any]:
    return json.loads(FILE.read_text(encoding="utf-8"))
