"""The chart of curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....reports.charts.chart import Axis, Chart, Kind, Mark, Names, Scale, distinct
from ..charts import having, one_backend
from ..table import Row


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of the largest error on the sRGB curve by bit count, with a line for each curve and rounding;
    nothing if all rows have the same bit count."""
    usable = [row for row in one_backend(having(rows, "bits", "display_max")) if row["display_max"] > 0]
    if len({row["bits"] for row in usable}) > 1:
        yield curves_chart(sorted(usable, key=lambda row: row["bits"]))


def curves_chart(rows: Sequence[Row]) -> Chart:
    """Return the chart of the largest error on the sRGB curve by bit count.

    Args:
        rows: rows of the curves table for one backend: encoding, rounding, range, bits, display_max.
    """
    points = [
        {"line": _called(row), "curve": _curve(row), "how": row["rounding"], "x": row["bits"], "y": row["display_max"]}
        for row in rows
    ]
    ways = distinct(points, "how")
    least = min(row["bits"] for row in rows)
    best = min((row for row in rows if row["bits"] == least), key=lambda row: row["display_max"])
    return Chart(
        name="curves",
        title=f"Smallest displayed error at {least} bits: {_called(best)}, {best['display_max']:.3g} steps of 255",
        subtitle="Largest difference in a colour's channel on the sRGB curve, by bits",
        description="The largest difference between a channel and its decode on the sRGB curve, in 255ths, on a "
        "logarithmic scale, by the bits of the code: a line for each curve and rounding. The figures are "
        "in the table.",
        x=Axis(title="bits", ticks=tuple((float(bits), str(bits)) for bits in distinct(rows, "bits"))),
        y=Axis(title="largest difference (steps of 8-bit sRGB)", scale=Scale.LOG),
        rows=tuple(points),
        colour=Names("curve", distinct(points, "curve")),
        dash=Names("how", ways) if len(ways) > 1 else None,
        marks=(
            Mark(
                kind=Kind.LINES,
                by=("line",),
                colour="curve",
                dash="how" if len(ways) > 1 else "solid",
                tips=(("line", "curve"), ("x", "bits"), ("y", "steps")),
            ),
            Mark(kind=Kind.ENDS, by=("line",), colour="curve", text="line"),
        ),
    )


def _curve(row: Row) -> str:
    return f"{row['encoding']}" + ("" if row["range"] == 1 else f", range {row['range']:g}")


def _called(row: Row) -> str:
    """Return the name of a row's curve, with the rounding unless it is to nearest."""
    return _curve(row) + ("" if row["rounding"] == "nearest" else f", {row['rounding']}")
