"""Plots of tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

FORMATS = ("png", "svg", "pdf")
DPI = 120
# Okabe and Ito's colours, told apart by most people who do not see all of them.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999", "#8C564B")


class PlotError(Exception):
    """A plot that cannot be drawn; one line."""


def check_format(path: Path) -> None:
    """Raises PlotError where a file's name does not end as one of FORMATS."""
    if path.suffix.lower()[1:] not in FORMATS:
        raise PlotError(f"{path}: a plot's name ends in {', '.join('.' + name for name in FORMATS)}")


def drawn_off_screen() -> Any:
    """matplotlib's pyplot, which needs no display."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    return pyplot


def save(figure: Any, *files: tuple[Path, str]) -> None:
    """Write a figure to each path as its format, one of FORMATS, and be done with it. Raises OSError."""
    from matplotlib import pyplot
    from matplotlib.backend_bases import get_registered_canvas_class

    try:
        figure.dpi = DPI
        for path, ending in files:
            # savefig would draw everything once more, to nowhere, where it lays out or has laid out a figure.
            canvas = get_registered_canvas_class(ending)(figure)
            getattr(canvas, f"print_{ending}")(path)
            figure.dpi = DPI
            # What is laid out once stays where it is.
            figure.set_layout_engine("none")
    finally:
        pyplot.close(figure)


MARKERS = "osD^v<>PX"


def lights_figure(rows: Sequence[dict[str, Any]]) -> Any:
    """What is lost over the number of lights, a line for each light buffer: of equal lights, and of coloured ones.

    Args:
        rows: of `lights`, the experiments equal and random.

    Returns:
        a figure for `save`.
    """
    pyplot = drawn_off_screen()

    found = [equal_lines(rows), random_lines(rows)]
    panels = [(title, lines) for title, lines in found if lines]
    figure, axes = pyplot.subplots(
        1, len(panels), figsize=(2.2 + 4.6 * len(panels), 4.6), squeeze=False, layout="constrained"
    )
    names = list(dict.fromkeys(row["light_buffer"] for row in rows))
    for axis, (title, lines) in zip(axes[0], panels, strict=True):
        for name, line in lines.items():
            at = names.index(name)
            counts, errors, bounds = zip(*sorted(line), strict=True)
            # A logarithmic axis has no zero: what is exact is drawn at its foot.
            style = {"color": COLOURS[at % len(COLOURS)], "marker": MARKERS[at % len(MARKERS)]}
            axis.plot(counts, [max(e, LEAST_ERROR) for e in errors], label=name, linewidth=1.6, **style)
            if any(bounds):
                axis.plot(counts, bounds, color=style["color"], linewidth=1.0, linestyle=":", alpha=0.6)
        axis.set_xscale("log", base=2)
        axis.set_yscale("log")
        axis.set_xlabel("lights")
        axis.set_xticks(sorted({count for line in lines.values() for count, *_ in line}))
        axis.xaxis.set_major_formatter("{x:.0f}")
        axis.set_title(title, size=10)
        axis.grid(alpha=0.3)
    axes[0][0].set_ylabel("error in light, by the model")
    figure.legend(*axes[0][-1].get_legend_handles_labels(), loc="outside right center")
    figure.suptitle("dotted: blends times half a step; errors below 1e-6 are drawn at 1e-6", size=9)
    return figure


LEAST_ERROR = 1e-6
Lines = dict[str, list[tuple[int, float, float]]]


def equal_lines(rows: Sequence[dict[str, Any]]) -> tuple[str, Lines]:
    """Of equal lights of the least sum: each buffer's worst channel."""
    equal = [row for row in rows if row["experiment"] == "equal"]
    total = min((row["sum"] for row in equal), default=0.0)
    lines: Lines = {}
    for row in equal:
        if row["sum"] == total:
            lines.setdefault(row["light_buffer"], []).append((row["lights"], abs(row["error"]), row["bound"]))
    worst = {name: [max(p for p in line if p[0] == n) for n in {p[0] for p in line}] for name, line in lines.items()}
    return f"equal lights that sum to {total:g}, worst channel", worst


def random_lines(rows: Sequence[dict[str, Any]]) -> tuple[str, Lines]:
    """Of coloured lights: the largest error of the worst order."""
    lines: Lines = {}
    for row in rows:
        if row["experiment"] == "random":
            lines.setdefault(row["light_buffer"], []).append((row["lights"], row["model_max"], row["bound"]))
    worst = {name: [max(p for p in line if p[0] == n) for n in {p[0] for p in line}] for name, line in lines.items()}
    return "coloured lights with falloff, worst pixel and order", worst
