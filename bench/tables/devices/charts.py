"""The chart of encoding and decoding times on the devices of readers."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Sequence

from ....reports.charts.chart import Axis, Chart, Kind, Mark, Names, Scale, distinct
from ..table import Row
from .agreement import codec_name, device_of, many, time_of

# Codecs of a chart.
MOST_DRAWN = 60


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of times, with a dot for each codec and device; nothing if no row has a time."""
    drawn = timed(rows)
    if drawn:
        devices = Names("device", distinct(drawn, "device"))
        tips = (("codec", "codec"), ("device", "device"), ("ms", "ms per megapixel"))
        yield Chart(
            name="devices",
            title=_finding_sentence(drawn),
            subtitle="Encoding and decoding time on readers' devices",
            description="Milliseconds per megapixel to encode and to decode, a dot for each device. The fastest codec "
            f"is on top. At most {MOST_DRAWN} codecs are drawn. The figures are in the table.",
            x=Axis(title="milliseconds per megapixel to encode and decode", scale=Scale.LOG),
            y=Axis(title="", scale=Scale.NAMES, names=distinct(drawn, "codec")),
            rows=tuple(drawn),
            colour=devices,
            shape=devices,
            marks=(Mark(kind=Kind.POINTS, x="ms", y="codec", colour="device", shape="device", tips=tips),),
        )


def timed(rows: Sequence[Row]) -> list[Row]:
    """Return a row for each codec and device with its milliseconds, the codec with the lowest geometric mean first.

    Times that are not above 0 are left out, because the axis is logarithmic.
    """
    points = [{"codec": codec_name(row), "device": device_of(row), "ms": time_of(row)} for row in rows]
    points = [row for row in points if row["ms"] is not None and row["ms"] > 0]
    logs: dict[str, list[float]] = {}
    for row in points:
        logs.setdefault(row["codec"], []).append(math.log(row["ms"]))
    order = sorted(logs, key=lambda name: statistics.fmean(logs[name]))[:MOST_DRAWN]
    return sorted((row for row in points if row["codec"] in order), key=lambda row: order.index(row["codec"]))


def _finding_sentence(drawn: Sequence[Row]) -> str:
    """Return a sentence that names the fastest and the slowest codec, with their times."""
    first, last = drawn[0]["codec"], drawn[-1]["codec"]
    least, most = (min(row["ms"] for row in drawn if row["codec"] == codec) for codec in (first, last))
    devices = many(len(distinct(drawn, "device")), "device")
    return (
        f"Fastest on {devices}: {first}, {least:.3g} ms per megapixel at best; slowest: {last}, {most:.3g} ms at best"
    )
