"""The chart of motion vectors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....reports.charts.chart import MUTED, Axis, Chart, Kind, Mark, Names, Scale, distinct
from ....reports.page.codec_key import CodecKey
from ..charts import having, one_backend
from ..table import Row
from .order import place

# What an error as large as the motion is called.
LOST = "error equal to the motion"


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of the mean error by speed, if any row has figures."""
    usable = sorted(one_backend(having(rows, "speed", "error_mean_px")), key=place)
    if usable:
        yield vectors_chart(usable)


def vectors_chart(rows: Sequence[Row]) -> Chart:
    """Return the chart of the mean error of motion vectors by speed, with a panel for each bit count and a line for
    each codec.

    Args:
        rows: rows of the vectors table for one backend: encoding, storage, bits, range, speed, error_mean_px.
    """
    points = [
        {"line": name, "encoding": row["encoding"], "storage": row["storage"], "bits": _bits_text(row["bits"])}
        | {"x": row["speed"], "y": row["error_mean_px"]}
        for name, line in vector_lines(rows).items()
        for row in line
    ]
    all_bits = tuple(map(_bits_text, sorted({row["bits"] for row in rows})))
    speeds = sorted({(row["bits"], row["speed"]) for row in rows})
    lost = tuple({"line": LOST, "bits": _bits_text(bits), "x": speed, "y": speed} for bits, speed in speeds)
    looks: dict[str, Any] = {"by": ("line", "bits"), "colour": "encoding"}
    tips = (("line", "code"), ("x", "speed (pixels per frame)"), ("y", "mean error (pixels)"))
    dotted: dict[str, Any] = {"rows": lost, "by": ("line", "bits"), "colour": MUTED}
    return Chart(
        name="vectors",
        title=_finding_sentence(rows),
        subtitle="Error of motion vectors by speed",
        description="The mean error of a motion vector in pixels by its speed in pixels per frame, on logarithmic "
        "scales, with a line for each encoding in its storage. The dotted line is an error equal to the "
        "motion: anything on it is lost. The figures are in the table.",
        x=Axis(title="speed (pixels per frame)", scale=Scale.LOG),
        y=Axis(title="mean error (pixels)", scale=Scale.LOG),
        rows=tuple(points),
        # An encoding has one colour in all panels.
        colour=Names("encoding", distinct(rows, "encoding")),
        dash=Names("storage", distinct(rows, "storage")),
        panels=Names("bits", all_bits),
        marks=(
            Mark(kind=Kind.LINES, **dotted, dash="dotted"),
            Mark(kind=Kind.LINES, **looks, dash="storage", tips=tips),
            Mark(kind=Kind.ENDS, **dotted, text="line"),
            Mark(kind=Kind.ENDS, **looks, text="line"),
        ),
    )


def _bits_text(bits: int) -> str:
    return f"{bits} bits"


def vector_lines(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Return each codec's rows in order of speed, by codec name; rows with zero error are left out, because the axis
    is logarithmic."""
    several = len({row.get("range") for row in rows if row.get("range")}) > 1
    lines: dict[str, list[Row]] = {}
    for row in sorted(rows, key=lambda row: row["speed"]):
        if row["error_mean_px"] > 0:
            ending = f" range {row['range']:g}" if several and row.get("range") else ""
            lines.setdefault(f"{CodecKey.of(row).label}{ending}", []).append(row)
    return lines


def _finding_sentence(rows: Sequence[Row]) -> str:
    """Return a sentence that names the codec with the smallest error at the lowest speed, for each bit count."""
    least = min(row["speed"] for row in rows)
    phrases = []
    for bits in sorted({row["bits"] for row in rows}):
        part = [row for row in rows if (row["bits"], row["speed"]) == (bits, least)]
        if part:
            best = min(part, key=lambda row: row["error_mean_px"])
            phrases.append(f"{CodecKey.of(best).label}, {bits} bits ({best['error_mean_px']:.2g})")
    return f"Smallest mean error in pixels, at {least:g} pixels per frame: {', '.join(phrases)}"
