"""The passes that read a G-buffer, and the bytes that they fetch."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ....gbuffer.layouts.kept import quantity_of
from ....gbuffer.layouts.layout import Layout
from ...ground.options.counts import in_range
from ...ground.options.words import Names
from ...ground.output.errors import UsageError

ALL, JOINED = "all", "+"
MOST = 64.0
# The words of a layout that each attribute lies in, without what follows their point. Engines' layouts do not tell the
# bits of flags, shadows and others apart.
WORDS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "normal": ("normal",),
        "base_color": ("base_color",),
        "roughness": ("roughness", "power"),
        "metallic": ("metallic",),
        "f0": ("f0", "f0.rgb"),
        "ao": ("ao",),
        "motion": ("motion",),
        "emissive": ("emissive",),
        "shading_model": ("shading_model",),
    }
)
TIMES = {0.0: "never", 1.0: "once", 2.0: "twice"}


@dataclass(frozen=True)
class Readers:
    """The passes that read a G-buffer.

    Attributes:
        full: number of passes that read all of it.
        parts: the attributes that each other pass reads.
    """

    full: float
    parts: tuple[tuple[str, ...], ...] = ()

    def bytes_of(self, layout: Layout) -> float:
        """Return the bytes per pixel that all passes fetch: the whole layout for each full pass, and for each other
        pass the targets that hold its attributes."""
        return self.full * layout.bytes_per_pixel + sum(_bytes_of(layout, part) for part in self.parts)

    @property
    def said(self) -> str:
        """The reads of a G-buffer in words, full reads first: once in full, once for normal and roughness."""
        return ", ".join([f"{times(self.full)} in full", *(f"once for {' and '.join(part)}" for part in self.parts)])


def times(count: float) -> str:
    """Return a count in words: once, twice, 3 times."""
    return TIMES.get(count, f"{count:g} times")


def read_readers(words: Names) -> Readers:
    """Return the passes that the words of --readers describe: a number of passes that read everything, `all` for one
    such pass, or the attributes that a pass reads, joined by +. Raises UsageError for anything else."""
    full, parts = 0.0, []
    for word in map(str, words):
        count = _count(word)
        if count is None:
            parts.append(tuple(_attributes(word)))
        else:
            full += count
    in_range("--readers", full, 0.0, MOST)
    return Readers(full, tuple(parts))


def check_held(readers: Readers, held: Collection[str], stencil: Collection[str]) -> None:
    """Raise UsageError if a pass reads an attribute that is not held, or that is in the stencil."""
    for name in (name for part in readers.parts for name in part):
        if name in stencil:
            raise UsageError(f"--readers {name}: stored in the stencil, whose bytes are not counted; leave it out")
        if name not in held:
            raise UsageError(
                f"--readers {name}: not in --hold; in --hold: {', '.join(name for name in held if name in WORDS)}"
            )


def _count(word: str) -> float | None:
    if word == ALL:
        return 1.0
    try:
        count = float(word)
    except ValueError:
        return None
    # What is no number is out of range as well.
    return count if math.isfinite(count) and count >= 0 else -1.0


def _attributes(word: str) -> Iterator[str]:
    for name in map(str.strip, word.split(JOINED)):
        if name not in WORDS:
            raise UsageError(
                f"--readers {word}: unknown; use a number, {ALL}, or attributes joined by {JOINED}: {', '.join(WORDS)}"
            )
        yield name


def _bytes_of(layout: Layout, part: Collection[str]) -> int:
    """Return the total bytes per pixel of the targets that hold any of these attributes."""
    names = {word for name in part for word in WORDS[name]}
    if "normal" in names:
        # A quantity that carries a sign of the normal is read with it.
        names |= {layout.carrier.component} if layout.carrier else set()
        names |= {"depth"} if layout.has_signed_depth else set()
    indices = {word.target for word in layout.words if quantity_of(word.component) in names}
    return sum(sum(layout.targets[index].storage.bits) // 8 for index in indices)
