"""Charts: as files, and as what a page draws."""

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
        name: of its files, without an ending.
        title: what it is called.
        description: what it shows, for who cannot see it.
        draw: gives a figure for `plots.save`.
        spec: gives the same as the page draws it; None where the page has a picture instead.
    """

    name: str
    title: str
    description: str
    draw: Callable[[], Any]
    spec: Callable[[], Spec] | None = None


def of(chart: Chart) -> Drawing:
    """A chart, to be drawn."""
    description = f"{chart.subtitle}. {chart.description}"
    return Drawing(chart.name, chart.title, description, partial(figure, (chart,)), partial(spec, chart))


def write(drawing: Drawing, *files: tuple[Path, str]) -> None:
    """Writes a chart to each path as its format, one of plots.FORMATS. Raises OSError."""
    with settings(drawing.name):
        save(drawing.draw(), *files)
