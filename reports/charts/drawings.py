"""Charts, as files and as drawings on a page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from .chart import Chart
from .draw import figure, settings
from .plots import save
from .wire import Spec, spec


@dataclass(frozen=True)
class Drawing:
    """A chart that can be drawn.

    Attributes:
        name: name of its files, without an extension.
        title: its title.
        description: what it shows, for readers who cannot see it.
        draw: function that returns a figure for `plots.save`.
        spec: function that returns the chart as the page draws it; None if the page has an image instead.
    """

    name: str
    title: str
    description: str
    draw: Callable[[], Any]
    spec: Callable[[], Spec] | None = None


def of(chart: Chart) -> Drawing:
    """Return a chart as a `Drawing`, which is drawn only when it is needed."""
    description = f"{chart.subtitle}. {chart.description}"
    return Drawing(chart.name, chart.title, description, partial(figure, (chart,)), partial(spec, chart))


def write(drawing: Drawing, *files: tuple[Path, str]) -> None:
    """Write a drawing to each path as its format, one of plots.FORMATS. Raises OSError."""
    with settings(drawing.name):
        save(drawing.draw(), *files)
