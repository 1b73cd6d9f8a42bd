"""Plots of tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

FORMATS = ("png", "svg", "pdf")
# Okabe and Ito's colours, told apart by most people who do not see all of them.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")


class PlotError(Exception):
    """A plot that cannot be drawn; one line."""


def check_format(path: Path) -> None:
    """Raises PlotError where a file's name does not end as one of FORMATS."""
    if path.suffix.lower()[1:] not in FORMATS:
        raise PlotError(f"{path}: a plot's name ends in {', '.join('.' + name for name in FORMATS)}")


def sweep_plot(rows: Sequence[dict[str, Any]], path: Path, format: str) -> None:
    """Milliseconds a frame over the number of objects, a line for each pipeline, a panel with shadows and one without.

    Args:
        rows: of a sweep: pipeline, objects, shadow, ms_frame, ms_frame_spread, size, lights, clock, device.
        path, format: where to write it, and as which of FORMATS.
    """
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot
    from matplotlib.ticker import LogLocator, ScalarFormatter

    shadows = sorted({row["shadow"] for row in rows}, reverse=True)
    # A layout or light buffer tells lines of one pipeline apart where there are several.
    names = list(dict.fromkeys(_line_name(row, rows) for row in rows))
    figure, panels = pyplot.subplots(
        1, len(shadows), figsize=(1.0 + 4.6 * len(shadows), 4.4), sharey=True, squeeze=False, layout="constrained"
    )
    for panel, shadow in zip(panels[0], shadows, strict=True):
        for name, colour in zip(names, COLOURS * len(names), strict=False):
            line = sorted((r for r in rows if r["shadow"] == shadow and _line_name(r, rows) == name), key=_objects)
            if line:
                milliseconds, spread = ([row[c] for row in line] for c in ("ms_frame", "ms_frame_spread"))
                half = [s / 2 for s in spread]
                panel.errorbar(
                    [row["objects"] for row in line],
                    milliseconds,
                    half,
                    label=name,
                    color=colour,
                    marker="o",
                    capsize=3,
                )
        panel.set_title("with shadow map" if shadow else "without shadow map")
        panel.set_xlabel("objects")
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        panel.yaxis.set_major_formatter(ScalarFormatter())
        counts = sorted({row["objects"] for row in rows})
        panel.set_xticks(counts, [str(count) for count in counts])
        panel.minorticks_off()
        panel.grid(alpha=0.3)
    panels[0][0].set_ylabel("ms a frame, median and quartiles")
    panels[0][-1].legend()
    first = rows[0]
    figure.suptitle(
        f"{first['size']}, {first['lights']} point lights and a sun\n{first['device']}, {first['clock']}", size=9
    )
    figure.savefig(path, format=format, dpi=120)
    pyplot.close(figure)


def _objects(row: dict[str, Any]) -> int:
    return row["objects"]


def _line_name(row: dict[str, Any], rows: Sequence[dict[str, Any]]) -> str:
    same = [other for other in rows if other["pipeline"] == row["pipeline"]]
    varied = [c for c in ("layout", "light_buffer", "light_targets") if len({other[c] for other in same}) > 1]
    return " ".join([row["pipeline"], *(str(row[column]) for column in varied)])
