"""The positions, colours, markers and strokes with which matplotlib draws a chart's marks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from .chart import DASHES, FAINT, INK, MUTED, PAPER, SHAPES, Axis, Chart, Mark, Names, Row, Scale, Shades

# How many letters of a name a chart has room for.
LONGEST = 48
ROLES = MappingProxyType({INK: "#000000", MUTED: "#777777", FAINT: "#AAAAAA", PAPER: "#FFFFFF"})
STROKES: Mapping[str, Any] = MappingProxyType({"solid": "-", "dashed": (0, (5, 4)), "dotted": (0, (1, 3))})
MARKERS = MappingProxyType(dict(zip((*SHAPES, "tick"), "osD^vP<>*X|", strict=True)))
# Perceptually uniform, and the same order to those who do not see all colours.
SHADES = "viridis"


def as_text(text: str) -> str:
    """Return text shortened to LONGEST characters, with dollar signs escaped, which would start mathematics."""
    return plain(text if len(text) <= LONGEST else text[: LONGEST - 3] + "...")


def plain(text: str) -> str:
    """Return text with dollar signs escaped, which matplotlib would read as mathematics."""
    return text.replace("$", r"\$")


def places(part: Chart, mark: Mark, rows: Sequence[Row]) -> tuple[list[Any], list[Any]]:
    """Return the x and the y positions of a mark's rows, as matplotlib's axes count them."""
    return [_axis_position(part.x, row[mark.x]) for row in rows], [_axis_position(part.y, row[mark.y]) for row in rows]


def _axis_position(axis: Axis, value: Any) -> Any:
    return axis.names.index(value) if axis.scale == Scale.NAMES else value


def colour_of(part: Chart, mark: Mark, row: Row) -> str:
    """Return the colour in which a mark draws a row."""
    if mark.rest and row.get(mark.rest):
        return ROLES[FAINT]
    if mark.colour in ROLES:
        return ROLES[mark.colour]
    names = part.named("colour", mark)
    return names.colours()[names.values.index(row[names.field])] if names else str(row[mark.colour])


def marker_of(part: Chart, mark: Mark, row: Row) -> str:
    """Return the matplotlib marker for a row's point."""
    names = part.named("shape", mark)
    return MARKERS[look(names, SHAPES, row) if names else mark.shape]


def stroke_of(part: Chart, mark: Mark, row: Row) -> Any:
    """Return the matplotlib line style for a row's line."""
    names = part.named("dash", mark)
    return stroke(look(names, DASHES, row)) if names else STROKES[mark.dash]


def stroke(lengths: Sequence[float]) -> Any:
    """Return a matplotlib line style for lengths of strokes and gaps; a solid line if there are no lengths."""
    return (0, tuple(lengths)) if lengths else "-"


def look(names: Names, looks: Sequence[Any], row: Row) -> Any:
    """Return the look for a row's name: a colour, shape or dash, from the names' own looks or from `looks`."""
    return names.of(looks)[names.values.index(row[names.field])]


def shade(shades: Shades) -> Any:
    """Return the matplotlib colour scale for numbers: logarithmic, between the ends of `shades`."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm

    return ScalarMappable(LogNorm(shades.low, shades.high, clip=True), SHADES)


def colour_map(count: int = 33) -> list[str]:
    """Return `count` colours from Viridis, #rrggbb, evenly spaced from dark to bright. The steps look equal, also to
    people with colour vision deficiency."""
    import matplotlib
    import numpy as np
    from matplotlib.colors import to_hex

    return [to_hex(colour) for colour in matplotlib.colormaps[SHADES](np.linspace(0, 1, count))]
