"""The chart of mixed codes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....reports.charts.chart import Axis, Chart, Kind, Mark, Scale, Shades, distinct
from ..charts import backends_of, having, one_backend
from ..table import Row
from .verdict import decides, worst_of_each

# Angles from the least to the largest that the colours of mixes tell apart, and from where a cell is bright.
LEAST, MOST, BRIGHT = 0.1, 180.0, 10.0


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield a chart of mixing with a cell for each codec and operation, coloured by the largest error and labelled
    with the share of garbage.

    Args:
        rows: rows of the mix table. The worst row of each cell is drawn: of the rows that decide verdicts, if any,
            otherwise of all rows.
    """
    cells = _cells(_deciding_rows(rows))
    tips = (("codec", "codec"), ("operation", "operation"), ("angle", "largest error (degrees)"))
    if cells:
        place: dict[str, Any] = {"x": "operation", "y": "codec"}
        yield Chart(
            name="mix",
            title=_finding_sentence(cells),
            subtitle=f"Result of mixing for each codec, by {backends_of(rows)}; "
            "in each cell: the share of garbage results",
            description="The largest error of each operation and the share of garbage, from the rows that decide the "
            "verdicts. The figures are in the tables below.",
            x=Axis(title="", scale=Scale.NAMES, names=tuple(dict.fromkeys(_operation_text(row) for row in rows))),
            y=Axis(title="", scale=Scale.NAMES, names=distinct(cells, "codec")),
            rows=tuple(cells),
            colour=Shades("angle", "largest error (degrees)", LEAST, MOST),
            marks=(
                Mark(kind=Kind.CELLS, **place, colour="angle", tips=(*tips, ("garbage", "garbage (%)"))),
                Mark(kind=Kind.TEXTS, **place, text="said", colour="on"),
            ),
        )


def _cells(rows: Sequence[Row]) -> list[Row]:
    """Return a cell for each row, a codec and an operation, with the largest error and the share of garbage as text;
    codecs with the most garbage come last."""
    cells: list[Row] = [
        {
            "codec": f"{row['encoding']} {row['storage']}",
            "operation": _operation_text(row),
            "angle": max(row["angle_max_deg"], LEAST),
        }
        | {"garbage": row["garbage_percent"], "said": _garbage_text(row["garbage_percent"])}
        | {"on": "#000000" if row["angle_max_deg"] > BRIGHT else "#FFFFFF"}
        for row in rows
    ]
    total: dict[str, tuple[float, float]] = {}
    for cell in cells:
        garbage, angle = total.get(cell["codec"], (0.0, 0.0))
        total[cell["codec"]] = garbage + cell["garbage"], angle + cell["angle"]
    return sorted(cells, key=lambda cell: total[cell["codec"]])


def _deciding_rows(rows: Sequence[Row]) -> list[Row]:
    usable = one_backend(having(rows, "garbage_percent", "angle_max_deg"))
    return worst_of_each([row for row in usable if decides(row)] or usable)


def _operation_text(row: Row) -> str:
    return str(row["operation"]).replace("_", " ")


def _garbage_text(percent: float) -> str:
    return "" if not percent else f"{percent:.0f}%" if percent >= 1 else "< 1%"


def _finding_sentence(cells: Sequence[Row]) -> str:
    """Return a sentence on how many codecs give no garbage, and which codec gives the most, with the operation."""
    codecs = distinct(cells, "codec")
    bad = {cell["codec"] for cell in cells if cell["garbage"]}
    worst = max(cells, key=lambda cell: (cell["garbage"], cell["angle"]))
    sentence = f"{len(codecs) - len(bad)} of {len(codecs)} codecs give no garbage"
    return (
        f"{sentence}; {worst['codec']} gives the most, {worst['said']} with {worst['operation']}" if bad else sentence
    )
