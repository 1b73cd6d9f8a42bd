"""The charts of rendered images."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....reports.charts.chart import FAINT, Axis, Chart, Kind, Mark, Names, Scale, distinct
from ....reports.page.codec_key import CodecKey
from ..charts import having, lines_of
from ..table import Row
from .measure import shown_scene

IMAGE, NORMALS = "the image", "the normals"


def charts(rows: Sequence[Row]) -> Iterator[Chart]:
    """Yield a chart for each scene, or for each specular power of a scene."""
    usable = having(rows, "psnr_db", "normal_psnr_db")
    for index, scene in enumerate(dict.fromkeys(map(shown_scene, usable))):
        part = [row for row in usable if shown_scene(row) == scene]
        yield image_chart(index, scene, sorted(part, key=lambda row: CodecKey.of(row).label))


def image_chart(index: int, scene: str, rows: Sequence[Row]) -> Chart:
    """Return the chart of the final image's PSNR next to the PSNR of the normals that lit it, with a line for each
    codec, in the order of names: one orientation ranks nothing.

    Args:
        index: index of the chart among the charts of the table.
        rows: rows of one scene.
    """
    lines = [
        {"codec": CodecKey.of(row).label, "line": line, "image": row["psnr_db"], "normals": row["normal_psnr_db"]}
        for row, line in zip(rows, lines_of(rows), strict=True)
    ]
    points = [line | {"what": what, "x": line[field]} for line in lines for what, field in FIELDS]
    tips = (("line", "codec"), ("image", "image (dB)"), ("normals", "normals (dB)"))
    what = Names("what", (IMAGE, NORMALS))
    return Chart(
        name=f"image-{index}",
        title=_finding_sentence(lines),
        subtitle=f"The image of {scene} and the normals it was lit by",
        description="PSNR in dB of the final image for each codec, next to the PSNR of the normals in its G-buffer. "
        "The figures are in the table below.",
        x=Axis(title="PSNR (dB)"),
        y=Axis(title="", scale=Scale.NAMES, names=distinct(lines, "line")),
        rows=tuple(points),
        colour=what,
        shape=what,
        marks=(
            Mark(kind=Kind.RULES, rows=tuple(lines), x="image", x2="normals", y="line", colour=FAINT),
            Mark(kind=Kind.POINTS, y="line", colour="what", shape="what", tips=tips),
        ),
    )


FIELDS = ((IMAGE, "image"), (NORMALS, "normals"))


def _finding_sentence(lines: Sequence[Row]) -> str:
    """Return a sentence on the range of the images, which one orientation does not rank."""
    worst, best = (chosen(line["image"] for line in lines) for chosen in (min, max))
    return f"{worst:.1f} to {best:.1f} dB in one orientation, which does not rank encodings"
