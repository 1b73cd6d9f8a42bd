"""The charts of compressed normal maps."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....reports.charts.chart import FAINT, Axis, Chart, Kind, Mark, Names, Scale, distinct
from ..charts import LEAST_DEG, having
from ..table import Row
from .order import group_of, in_order

# What is marked of each line: the column, what it is called, and its shape.
MARKED = (
    ("angle_mean_deg", "mean", "circle"),
    ("angle_p99_deg", "99%", "diamond"),
    ("angle_max_deg", "largest", "square"),
)
COLUMNS = [column for column, *_ in MARKED]


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield a chart for each image and decoder."""
    usable = in_order(having(rows, *COLUMNS))
    for index, group in enumerate(dict.fromkeys(map(group_of, usable))):
        yield _chart(index, group, [row for row in usable if group_of(row) == group])


def _chart(index: int, group: tuple[str, str], rows: Sequence[Row]) -> Chart:
    """Return the chart for an image and a decoder: a line of angles for each encoding and format, in the order of the
    rows from the top."""
    lines = [
        {"codec": f"{row['encoding']} {row['block']}", "line": _line_name(row)}
        | {column: max(row[column], LEAST_DEG) for column in COLUMNS}
        for row in rows
    ]
    points = tuple(line | {"what": name, "x": line[column]} for line in lines for column, name, _ in MARKED)
    names, shapes = tuple(name for _, name, _ in MARKED), tuple(shape for *_, shape in MARKED)
    tips = (("line", "code"), ("what", "angle"), ("x", "degrees"))
    return Chart(
        name=f"maps-{index}",
        title=_finding_sentence(group[0], rows),
        subtitle=f"Error of block compression on {group[0]}, decoded by {group[1]}",
        description="The mean angle, the 99th percentile and the largest angle, in degrees, for each encoding and "
        "format. The figures are in the table below.",
        x=Axis(title="angle between normal and decode (degrees)", scale=Scale.LOG),
        y=Axis(title="", scale=Scale.NAMES, names=distinct(lines, "line")),
        rows=points,
        colour=Names("what", names),
        shape=Names("what", names, looks=shapes),
        marks=(
            Mark(kind=Kind.RULES, rows=tuple(lines), x=COLUMNS[0], x2=COLUMNS[-1], y="line", colour=FAINT),
            Mark(kind=Kind.POINTS, y="line", colour="what", shape="what", tips=tips),
        ),
    )


def _finding_sentence(name: str, rows: Sequence[Row]) -> str:
    """Return a sentence that names the encoding and format with the smallest mean angle for each number of bits."""
    best: dict[float, Row] = {}
    for row in sorted(rows, key=lambda row: (row["bits_per_texel"], row["angle_mean_deg"])):
        best.setdefault(row["bits_per_texel"], row)
    parts = [f"{_line_name(row)} ({row['angle_mean_deg']:.2g})" for row in best.values()]
    return f"Smallest mean angles on {name}, in degrees: {'; '.join(parts)}"


def _line_name(row: Row) -> str:
    """Return the name of a line: the encoding, the format, its swizzle and its bits."""
    return f"{row['encoding']} {row['block']} {row['swizzle']}, {row['bits_per_texel']} bits"
