"""The data for a page: everything that a run left, gathered by a caller that can read runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..charts.pareto import Panel
from ..sheets import Row
from .codec_key import CodecKey
from .live import Live
from .pixels import Subject
from .sections import TableSection


@dataclass(frozen=True)
class SphereMap:
    """A codec's errors over the sphere; see `sphere_chart` for the arrays."""

    key: CodecKey
    bits: int
    mean_deg: np.ndarray
    max_deg: np.ndarray
    directions: int


@dataclass(frozen=True)
class Front:
    """Cost against error: a label for the decibels, and panels for each GPU family."""

    label: str
    panels: Sequence[Panel]


@dataclass(frozen=True)
class Listing:
    """A kernel's disassembly, and the GLSL of its encoding, which may be empty."""

    text: str
    source: str = ""


@dataclass(frozen=True)
class Found:
    """The results of a run.

    Attributes:
        name: name of the run's folder.
        facts: the contents of run.json.
        tables: rows by table, as they were stored.
        sections: the tables as sections of the page, in its order.
        steps: number of steps that have their rows.
        finished: whether all requested steps have their rows.
        encodings: names of encodings of normals: the catalogue's, and those in users' files.
        subjects: the normals and images on which codecs were tested, and their pixels.
        maps: errors over the sphere.
        agreement: how far the figures of the two backends differ, in a sentence; empty if no codec has both.
        fronts: cost against error.
        listings: disassemblies, by name.
        choices: the questions whose conditions a reader may change; empty if the run answers none.
        cards: facts about codecs and encodings; may be empty.
        code: source code for codecs that the run stores; empty if it stores none.
        live: data for the laboratory; None if the run has no laboratory.
        remarks: problems with the run, in sentences.
    """

    name: str
    facts: Row
    tables: Mapping[str, Sequence[Row]]
    sections: Sequence[TableSection] = ()
    steps: int = 0
    finished: bool = False
    encodings: frozenset[str] = frozenset()
    subjects: Sequence[Subject] = ()
    maps: Sequence[SphereMap] = ()
    agreement: str = ""
    fronts: Sequence[Front] = ()
    listings: Mapping[str, Listing] = field(default_factory=dict)
    choices: Mapping[str, Any] = field(default_factory=dict)
    cards: Mapping[str, Any] = field(default_factory=dict)
    code: Mapping[str, Any] = field(default_factory=dict)
    live: Live | None = None
    remarks: Sequence[str] = ()

    def with_remarks(self, more: Sequence[str]) -> Found:
        """Return the same run with more remarks."""
        return replace(self, remarks=[*self.remarks, *more])

    @property
    def machine(self) -> Row:
        """Names and versions of the hardware and software of the measurement, by component; empty if unknown."""
        machine = self.facts.get("machine")
        return machine if isinstance(machine, dict) else {}

    @property
    def begun(self) -> str:
        """The time at which the run began; empty if unknown."""
        return str(self.facts.get("time") or "")

    @property
    def sources(self) -> str:
        """The fingerprint of the code that made the run; empty if unknown."""
        return str(self.facts.get("sources") or "")

    @property
    def request(self) -> Row:
        """The options with which the run was requested; empty if unknown."""
        request = self.facts.get("request")
        return request if isinstance(request, dict) else {}

    @property
    def command(self) -> str:
        """The command line that made the run."""
        words = self.facts.get("command")
        return " ".join(["normalbench", *map(str, words if isinstance(words, list) else [])])


def plain_text(value: Any) -> Any:
    """Return a value with all texts in it, at any depth, made safe: control characters and line breaks become spaces,
    and lone surrogates become question marks."""
    if isinstance(value, dict):
        return {str(plain_text(str(name))): plain_text(inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [plain_text(inner) for inner in value]
    if not isinstance(value, str) or value.isprintable():
        return value
    return "".join(c if c.isprintable() else " " for c in value.encode("utf-8", "replace").decode("utf-8"))
