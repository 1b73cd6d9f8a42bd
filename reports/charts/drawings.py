"""Charts for files and for a page."""

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
        title: title of the chart.
        description: text for readers who cannot see the chart.
        draw: function that returns a figure for `plots.save`.
        spec: function that returns the chart as data for the page; None if the page has an image instead.
    """

    name: str
    title: str
    description: str
    draw: Callable[[], Any]
    spec: Callable[[], Spec] | None = None


def of(chart: Chart) -> Drawing:
    """Return a `Drawing` of a chart; nothing is drawn until needed."""
    description = f"{chart.subtitle}. {chart.description}"
    return Drawing(chart.name, chart.title, description, partial(figure, (chart,)), partial(spec, chart))


def write(drawing: Drawing, *files: tuple[Path, str]) -> None:
    """Write a drawing to each path in the given format, one of plots.FORMATS. Raises OSError."""
    with settings(drawing.name):
        save(drawing.draw(), *files)
