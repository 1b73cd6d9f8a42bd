"""The chart of depth codes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....reports.charts.chart import Axis, Chart, Kind, Mark, Names, Scale, distinct
from ..charts import having, one_backend
from ..table import Row


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of the largest position error by distance; nothing if no row has figures."""
    usable = one_backend(having(rows, "distance", "error_max", "near", "far", "fov"))
    if usable:
        yield depth_chart(usable)


def depth_chart(rows: Sequence[Row]) -> Chart:
    """Return the chart of the largest position error by distance, with a line for each depth encoding in its storage
    and a panel for each pair of near and far planes.

    Args:
        rows: rows of depth encodings, whose distances are numbers.
    """
    points = [
        {name: row[name] for name in ("depth", "storage", "rounding", "rebuilt")}
        | {"line": _line_name(row), "range": _range_text(row), "x": row["distance"]}
        | {"y": row["error_max"] / row["distance"]}
        for row in sorted(_best_rebuilt(rows), key=lambda row: row["distance"])
        if row["error_max"] > 0
    ]
    looks: dict[str, Any] = {"by": ("line", "range"), "colour": "depth"}
    tips = tuple((name, name) for name in ("depth", "storage", "rounding", "rebuilt"))
    tips = (*tips, ("x", "distance"), ("y", "error"))
    first = rows[0]
    return Chart(
        name="depth",
        title=_finding_sentence(points),
        subtitle=f"Position error by distance; field of view {first['fov']:g} degrees; "
        f"{first['backend']}, {first['device']}",
        description="The largest distance between true and rebuilt position, relative to the distance from the eye, by "
        "that distance, on logarithmic scales, with a line for each depth encoding in its storage, rebuilt in its best "
        "way. The figures are in the table.",
        x=Axis(title="distance", scale=Scale.LOG, is_shared=False),
        y=Axis(title="largest position error / distance", scale=Scale.LOG),
        rows=tuple(points),
        colour=Names("depth", distinct(rows, "depth")),
        dash=Names("storage", distinct(rows, "storage")),
        panels=Names("range", tuple(dict.fromkeys(map(_range_text, rows)))),
        height=420,
        marks=(
            Mark(kind=Kind.LINES, **looks, dash="storage", tips=tips),
            Mark(kind=Kind.ENDS, **looks, text="line"),
        ),
    )


def _range_text(row: Row) -> str:
    return f"near {row['near']:g}, far {row['far']:g}"


def _best_rebuilt(rows: Sequence[Row]) -> list[Row]:
    """Return the rows of each line's best way to rebuild positions, by the largest relative error."""
    worst: dict[tuple[str, str], dict[str, float]] = {}
    for row in rows:
        ways, relative = worst.setdefault((_range_text(row), _line_name(row)), {}), row["error_max"] / row["distance"]
        ways[row["rebuilt"]] = max(relative, ways.get(row["rebuilt"], 0.0))
    best = {line: min(ways, key=lambda way: ways[way]) for line, ways in worst.items()}
    return [row for row in rows if row["rebuilt"] == best[_range_text(row), _line_name(row)]]


def _line_name(row: Row) -> str:
    words = (row["depth"], row["storage"], "" if row["rounding"] == "nearest" else row["rounding"])
    return " ".join(filter(None, words)).replace("_", " ")


def _finding_sentence(points: Sequence[Row]) -> str:
    """Return a sentence with the best and the worst line at the greatest distance; "No error" without points."""
    if not points:
        return "No error"
    farthest = max(point["x"] for point in points)
    last = sorted((point for point in points if point["x"] == farthest), key=lambda point: point["y"])
    best, worst = last[0], last[-1]
    ends = f"{best['line']} {best['y']:.2g}, {worst['line']} {worst['y']:.2g}"
    return f"Largest relative error at a distance of {farthest:g}: {ends}"
