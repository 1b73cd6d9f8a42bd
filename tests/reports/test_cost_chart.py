"""The interactive chart of cost against error: a switch between GPUs, readable names and no crowded corner."""

import math

import pytest
from test_report import a_run, quality_row

from normalbench.bench.keep.runs import read_run
from normalbench.bench.show.report import gathered
from normalbench.bench.tables.cost.charts import HEIGHT, front_chart
from normalbench.bench.tables.registry import TABLES
from normalbench.reports.charts import wire
from normalbench.reports.charts.chart import Axis, Scale, lines_apart
from normalbench.reports.charts.pareto import Panel, Point

# Instructions to encode and to decode (normalbench cost --isa --family navi31,dg2), and PSNR in rgba8 (quality).
CODECS = {
    "xy": ((0, 4), (0, 1), 18.62),
    "spheremap": ((8, 11), (8, 11), 48.59),
    "cryengine3": ((15, 8), (14, 7), 48.59),
    "octahedral": ((15, 17), (11, 11), 49.95),
    "octahedral_precise": ((120, 17), (128, 11), 50.52),
}


FAMILIES = ("navi31", "dg2")


def points(family: int = 0, operation: int = 0) -> list[Point]:
    return [Point(name, counts[family][operation], counts[2], 16) for name, counts in CODECS.items()]


def test_names_far_apart_stay_next_to_their_points():
    for scale in (Scale.LINEAR, Scale.LOG):
        axis = Axis(title="error", scale=scale, domain=(0.05, 6.0))
        places = lines_apart(axis, [0.1, 5.0], HEIGHT, 1.0)
        assert [axis.at(share) for share in places] == pytest.approx([0.1, 5.0])


def test_the_most_expensive_codec_leaves_room_for_the_others():
    """octahedral_precise takes 120 instructions; the others take up to 15 and have over a third of the axis."""
    chart = front_chart("cost-0", "PSNR", [Panel("encode", points())])
    ((_, part),) = chart.parts()
    assert part.x.share(15) - part.x.share(0) > 0.35
    (panel,) = wire.spec(chart)["panels"]
    assert [number for number, _ in panel["x"]["ticks"]] == [0, 2, 5, 10, 20, 50, 100]


def test_only_a_chart_of_several_gpus_has_a_switch():
    panels = [Panel("encode", points(index), name, is_usual=name == "dg2") for index, name in enumerate(FAMILIES)]
    spec = wire.spec(front_chart("cost-0", "PSNR", panels))
    assert spec["switch"]["values"] == list(FAMILIES) and spec["switch"]["usual"] == "dg2"
    (panel,) = spec["panels"]
    assert set(panel["tables"][-1]["machine"]["names"]) == set(FAMILIES)
    alone = wire.spec(front_chart("cost-0", "PSNR", panels[:1]))
    assert not alone["switch"] and alone["panels"][0]["name"] == "encode"


def costs_of(codecs, family: str, at: int = 0) -> list[dict]:
    """Return cost rows for encodings on a GPU family, and for packing two numbers."""
    about = TABLES["cost"].empty() | {"measure": "isa", "stage": "fragment", "family": family, "driver": "Mesa"}
    rows = []
    for side, (operation, packed) in enumerate((("encode", "pack"), ("decode", "unpack"))):
        counts = {name: codecs[name][at][side] for name in codecs}
        rows += [about | {"operation": operation, "encoding": n, "instructions": c} for n, c in counts.items()]
        rows.append(about | {"operation": packed, "storage": "rgba8 8:8", "instructions": 2})
    return rows


def without_figures(name: str, why: str) -> dict:
    return quality_row(name, psnr_db=None, angle_mean_deg=None, skipped=why)


def charted(folder, quality: list[dict], codecs) -> tuple[list[dict], list[str]]:
    """Return the points in the page's chart of encoding on one GPU, and its remarks on codecs that are missing."""
    contents = gathered(folder, read_run(a_run(folder, {"quality": quality, "cost": costs_of(codecs, "navi31")})))
    (chart,) = TABLES["cost"].work.joined(contents)
    (_, encode), _ = chart.parts()
    return list(encode.rows), [remark for remark in contents.remarks if "charts of cost" in remark]


def test_users_encoding_without_a_twin_is_plotted_with_glsl_figures(tmp_path):
    """The user's encoding can beat the catalogue's; an encoding with both backends is plotted with JAX figures."""
    counts = {"xy": ((0, 4),), "octahedral": ((15, 17),), "mine": ((7, 11),), "mine:arithmetic=half": ((9, 11),)}
    rows = [without_figures("mine", "no twin"), quality_row("mine", backend="glsl", psnr_db=52.0)]
    rows += [quality_row("octahedral", backend="glsl", psnr_db=53.0), quality_row("octahedral", psnr_db=51.0)]
    rows += [quality_row("mine:arithmetic=half", psnr_db=40.0), quality_row("xy", psnr_db=20.0)]
    points, remarks = charted(tmp_path / "run", rows, counts)
    shown = {point["codec"]: (point["x"], point["y"], not point["rest"]) for point in points}
    assert remarks == [] and shown == {
        "xy rgba8": (2, 20.0, True),
        "mine rgba8": (9, 52.0, True),
        "octahedral rgba8": (17, 51.0, False),
        "mine:arithmetic=half rgba8": (11, 40.0, False),
    }


def test_the_page_explains_why_a_codec_is_not_in_its_chart(tmp_path):
    rows = [quality_row("xy"), quality_row("costless"), quality_row("odd", bits=17), quality_row("three", bits=24)]
    rows += [quality_row("same", psnr_db=math.inf), without_figures("lost", "no twin")]
    names = ("xy", "odd", "same", "lost", "three")
    points, remarks = charted(tmp_path / "run", rows, dict.fromkeys(names, ((1, 1),)))
    assert [point["codec"] for point in points] == ["xy rgba8"]
    assert remarks == [
        f"Not in the charts of cost, because {why}."
        for why in (
            "its storage is not known: odd rgba8",
            "its error is 0: same rgba8",
            "its error is not known (no twin): lost rgba8",
            "its cost is not known: costless rgba8",
            "the cost of rgba8 8:8:8 is not known: three rgba8",
        )
    ]
