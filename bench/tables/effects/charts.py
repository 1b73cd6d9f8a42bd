"""The chart of effects."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....reports.charts.chart import Axis, Chart, Kind, Mark, Names, Scale, distinct
from ....reports.page.codec_key import CodecKey
from ..charts import having
from ..table import Row


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield the chart of each effect's PSNR by the mean angular error of the normals; nothing without rows."""
    usable = having([row for row in rows if not row["depth"]], "effect_psnr_db", "normal_mean_deg")
    points = [
        {
            "codec": CodecKey.of(row).label,
            "effect": " on ".join(str(row[name]) for name in ("effect", "scene")),
            "x": row["normal_mean_deg"],
            "y": row["effect_psnr_db"],
        }
        for row in usable
        if row["normal_mean_deg"] > 0
    ]
    tips = (("codec", "codec"), ("x", "normals (degrees)"), ("y", "effect (dB)"), ("effect", "effect"))
    if points:
        yield Chart(
            name="effects",
            title=_finding_sentence(points),
            subtitle="Effect of errors in the normals",
            description="PSNR in dB of each effect's own image by the mean angle of the normals that it reads. The "
            "figures are in the table below.",
            x=Axis(title="mean angle of the normals (degrees)", scale=Scale.LOG),
            y=Axis(title="PSNR of the effect's own image (dB)"),
            rows=tuple(points),
            colour=Names("effect", distinct(points, "effect")),
            shape=Names("codec", distinct(points, "codec")),
            marks=(Mark(kind=Kind.POINTS, colour="effect", shape="codec", tips=tips),),
        )


def _finding_sentence(points: Sequence[Row]) -> str:
    """Return a sentence that names the effects with the lowest and the highest PSNR, each with its codec."""
    worst = min(points, key=lambda point: point["y"])
    best = max(points, key=lambda point: point["y"])
    return (
        f"Worst: {worst['effect']}, {worst['y']:.1f} dB with {worst['codec']}; "
        f"best: {best['effect']}, {best['y']:.1f} dB with {best['codec']}"
    )
