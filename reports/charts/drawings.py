"""Charts as files, and as SVG that lies in a page and takes its colours."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from .plots import COLOURS, save

# What a chart's colours are called in page.css, which has them for either theme.
THEME = {
    "#ffffff": "paper",
    "#000000": "ink",
    "#777777": "muted",
    "#aaaaaa": "faint",
    "#bbbbbb": "faint",
    "#b0b0b0": "faint",
    "#cccccc": "faint",
    **{colour.lower(): f"chart-{at}" for at, colour in enumerate(COLOURS) if colour != "#000000"},
}


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
    """

    name: str
    title: str
    description: str
    draw: Callable[[], Any]


@contextmanager
def _settings(name: str) -> Iterator[None]:
    """Text stays text, names in the file are the same each time, and a letter that a font lacks is the reader's."""
    import matplotlib

    with warnings.catch_warnings(), matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": name}):
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


def inline(svg: str, drawing: Drawing) -> str:
    """A chart's SVG for a page: its colours the page's, its ids its own, its title and description said."""
    body = svg[svg.index("<svg") :]
    body = re.sub(r"<metadata>.*?</metadata>", "", body, count=1, flags=re.S)
    body = re.sub(r"<defs>\s*<style.*?</style>\s*</defs>", "", body, count=1, flags=re.S)
    body = _own_ids(re.sub(r"font-family: [^;\"]*;? ?", "", body), drawing.name)
    body = re.sub(r"#[0-9a-f]{6}\b", _themed, body, flags=re.I)
    view = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', body)
    # Points are 4/3 of a pixel.
    width, height = (float(size) * 4 / 3 for size in view.groups()) if view else (0, 0)
    label = f"{drawing.name}-title {drawing.name}-desc"
    head = (
        f'<svg class="drawing" role="img" aria-labelledby="{label}" {view[0] if view else ""} '
        f'style="--natural: {width:.0f}px; aspect-ratio: {width:.0f} / {height:.0f}" '
        f'xmlns:xlink="http://www.w3.org/1999/xlink"><title id="{drawing.name}-title">{escape(drawing.title)}</title>'
        f'<desc id="{drawing.name}-desc">{escape(drawing.description)}</desc>'
    )
    return re.sub(r"<svg[^>]*>", lambda _: head, body, count=1)


def _themed(match: re.Match[str]) -> str:
    colour = match[0].lower()
    return f"var(--{THEME[colour]}, {colour})" if colour in THEME else match[0]


def _own_ids(svg: str, name: str) -> str:
    """Ids that something refers to, told apart from other charts' on the page; the others go."""
    used = set(re.findall(r'(?:url\(#|href="#)([^")]+)', svg))
    svg = re.sub(r' id="([^"]*)"', lambda m: f' id="{name}-{m[1]}"' if m[1] in used else "", svg)
    return re.sub(r'(url\(#|href="#)', lambda m: f"{m[1]}{name}-", svg)
