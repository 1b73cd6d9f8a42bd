"""Charts: as files, and as what a page draws."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .plots import save

# How many letters of a name a chart has room for.
LONGEST = 48


@dataclass(frozen=True)
class Drawing:
    """A chart that can be drawn.

    Attributes:
        name: of its files, without an ending.
        title: what it is called.
        description: what it shows, for who cannot see it.
        draw: gives a figure for `plots.save`.
        specs: gives the same as interactive charts (see `specs.py`); None where the page has a picture instead.
    """

    name: str
    title: str
    description: str
    draw: Callable[[], Any]
    specs: Callable[[], Sequence[dict[str, Any]]] | None = None


@contextmanager
def _settings(name: str) -> Iterator[None]:
    """Text stays text, names in the file are the same each time, and a letter that a font lacks is the reader's."""
    import matplotlib

    # Without a height for titles matplotlib lays out all labels anew at each drawing, to see what is in the way.
    chosen: Any = {"svg.fonttype": "none", "svg.hashsalt": name, "axes.titley": 1.0}
    with warnings.catch_warnings(), matplotlib.rc_context(chosen):
        warnings.filterwarnings("ignore", message=".*missing from.*font")
        warnings.filterwarnings("ignore", message="constrained_layout not applied")
        yield


def write(drawing: Drawing, *files: tuple[Path, str]) -> None:
    """Writes a chart to each path as its format, one of plots.FORMATS. Raises OSError."""
    with _settings(drawing.name):
        save(drawing.draw(), *files)


def as_text(text: str) -> str:
    """Text as a chart has room for it, whose dollars it does not read as mathematics."""
    short = text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."
    return short.replace("$", r"\$")


def for_drawing(rows: Sequence[dict[str, Any]], but: Sequence[str] = ()) -> list[dict[str, Any]]:
    """Rows whose text is as a chart can show it, but for columns that are no text to show."""
    return [{k: as_text(v) if isinstance(v, str) and k not in but else v for k, v in row.items()} for row in rows]
