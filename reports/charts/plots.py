"""Plots of tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

FORMATS = ("png", "svg", "pdf")
# Who made a file, by its format: such a file may be replaced.
MADE_BY = {"png": {"Software": "normalbench"}, "svg": {"Creator": "normalbench"}, "pdf": {"Creator": "normalbench"}}
DPI = 120


class PlotError(Exception):
    """An error with a one-line message: a plot cannot be drawn."""


def check_format(path: Path) -> None:
    """Raise PlotError unless the extension of a file name is one of FORMATS."""
    if path.suffix.lower()[1:] not in FORMATS:
        raise PlotError(f"{path}: unsupported plot format; use one of {', '.join('.' + name for name in FORMATS)}")


def drawn_off_screen() -> Any:
    """Return matplotlib's pyplot module, with a backend that needs no display."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    return pyplot


def save(figure: Any, *files: tuple[Path, str]) -> None:
    """Write a figure to each path in the given format, one of FORMATS, and close it. Raises OSError."""
    from matplotlib import pyplot
    from matplotlib.backend_bases import get_registered_canvas_class

    try:
        figure.dpi = DPI
        for path, ending in files:
            # savefig would draw everything once more, to nowhere, where it lays out or has laid out a figure.
            canvas = get_registered_canvas_class(ending)(figure)
            getattr(canvas, f"print_{ending}")(path, metadata=MADE_BY[ending])
            figure.dpi = DPI
            # What is laid out once stays where it is.
            figure.set_layout_engine("none")
    finally:
        pyplot.close(figure)
