"""The plot of cost against error: what is added up, what is left out, who is beaten, and where things stand."""

import itertools
import math
import warnings

import pytest
from matplotlib.collections import LineCollection

from normalbench.bench.subjects.normals.normal_sets import axes
from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.cost import plot as cost_plot
from normalbench.bench.tables.cost.charts import front_chart
from normalbench.bench.tables.cost.codec_costs import Costs, LeftOutError, Where
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.reports.charts import draw, labels, pareto
from normalbench.reports.charts.pareto import ERRORS, Panel, Point, decibels

WHERE = Where("isa", "navi21", "fragment")

LARGEST_ANGLE = ERRORS["max"][1]


def row(what: str, operation: str, count: float | None, **more) -> dict:
    """A row of navi21's fragment shaders, of an encoding or of a storage's packing."""
    is_packing = operation in cost.PACKING_OPERATIONS.values()
    about = {"encoding": None, "storage": what} if is_packing else {"encoding": what, "storage": None}
    given = {"measure": "isa", "family": "navi21", "stage": "fragment", "operation": operation, "instructions": count}
    return TABLES["cost"].empty() | {"device": "a Radeon", "driver": "Mesa 1.2.3"} | given | about | more


ROWS = [
    *(row(name, "encode", count) for name, count in (("xy", 1), ("xyz", 2), ("xy_sign", 4), ("octahedral", 14))),
    row("rgba8 8:8", "pack", 20),
    row("rgba8 8:8:8", "pack", 30),
    row("rgba8 signed depth 8:8:8", "pack", 500),
    row("rgba8 depth 8:8:8", "pack", 200),
]


def cost_of(name: str, rows=ROWS, storage: str = "rgba8") -> float:
    return Costs(rows).of(Codec(ENCODINGS[name], STORAGES[storage]), WHERE, "encode", "instructions").cost


@pytest.mark.parametrize("name, total", [("xy", 21), ("xyz", 32), ("octahedral", 34), ("xy_sign", 4 + 20 + 500 - 200)])
def test_a_codec_costs_its_encoding_its_storage_and_its_sign(name, total):
    assert cost_of(name) == total


@pytest.mark.parametrize(
    "name, storage, lost, reason",
    [
        ("xy", "rgba8", "rgba8 8:8", "what rgba8 8:8 costs is not known"),
        ("xy", "rgba8", "xy", "what it costs is not known"),
        ("xy_sign", "rgba8", "rgba8 signed depth 8:8:8", "what rgba8 signed depth 8:8:8 costs is not known"),
        ("xyz", "rg8", "nothing", "rg8 does not hold it: 3 components, but RG8 has 2 channels"),
        ("xy", "rg8", "nothing", "what rg8 8:8 costs is not known"),
    ],
)
def test_a_part_that_is_not_known_is_not_nothing(name, storage, lost, reason):
    for gone in ([r for r in ROWS if lost not in (r["storage"], r["encoding"])], []):
        rows = gone or [r | {"instructions": None} if lost in (r["storage"], r["encoding"]) else r for r in ROWS]
        with pytest.raises(LeftOutError) as found:
            cost_of(name, rows, storage)
        assert str(found.value) == reason


def test_a_loop_has_no_sum_and_a_branch_is_marked():
    with pytest.raises(LeftOutError, match="xy encode contains a loop, which counts once"):
        cost_of("xy", [*ROWS, row("xy", "encode", 1, loops=1, branches=1)])
    codec = Codec(ENCODINGS["xy"], STORAGES["rgba8"])
    marked = Costs([*ROWS, row("xy", "encode", 1, loops=0, branches=1)]).of(codec, WHERE, "encode", "instructions")
    assert marked.branches and marked.cost == 21


def test_a_front_is_what_no_other_beats():
    points = [
        Point(*values)
        for values in (
            ("a", 1, 10, 16),
            ("b", 2, 20, 16),
            ("c", 2, 15, 16),
            ("d", 3, 20, 16),
            ("e", 3, 30, 24),
            ("f", 1, 10, 16),
            ("g", 4, 10, 8),  # dear and no better, in half of the bits
        )
    ]
    assert [p.name for p in pareto.pareto_front(points, decibels("PSNR"))] == ["a", "f", "b", "e", "g"]
    assert [p.name for p in pareto.pareto_front(points, LARGEST_ANGLE)] == ["a", "f", "g"]


@pytest.mark.parametrize(
    "error, near, far",
    [(decibels("PSNR"), (48.563975, 48.563965), (48.6, 48.5)), (LARGEST_ANGLE, (5.0, 5.02), (5.0, 5.03))],
)
def test_what_is_no_difference_beats_nobody(error, near, far):
    """0.05 dB, or 0.5 % of an angle: equally dear codecs are beaten by more than that, and dearer ones by less too."""
    for (good, bad), front in ((near, ["good", "bad"]), (far, ["good"])):
        points = [Point("good", 10, good, 16), Point("bad", 10, bad, 16)]
        assert [p.name for p in pareto.pareto_front(points, error)] == front
    dear = [Point("dear", 11, near[0], 16), Point("cheap", 10, near[1], 16)]
    assert [p.name for p in pareto.pareto_front(dear, error)] == ["cheap"]


def test_a_time_within_its_spread_beats_nobody():
    points = [Point("a", 1.00, 40.0, 16, 0.1), Point("b", 1.08, 40.0, 16, 0.1), Point("c", 1.12, 40.0, 16, 0.1)]
    assert [p.name for p in pareto.pareto_front(points, decibels("PSNR"))] == ["a", "b"]


COSTS = (2, 4, 3, 3, 26, 17, 9, 12, 15, 10, 30, 16, 68)
DECIBELS = (18.5, 44.4, 52.7, 54.4, 41.6, 41.5, 48.5, 48.5, 48.5, 43.6, 37.6, 49.9, 61.8)
NAMES = (
    *("xy", "xy_sign", "xyz", "xyz_renormalised", "spherical", "spherical_lut", "spheremap", "spheremap_classic"),
    *("cryengine3", "stereographic", "per_pixel_view", "octahedral", "best_fit"),
)
# Of codecs as near each other as the default plot's, and one where the legend used to stand.
POINTS = [Point(*values, 16) for values in zip(NAMES, COSTS, DECIBELS, strict=True)] + [Point("last", 68, 18.5, 24)]


@pytest.fixture
def drawn():
    """Draws panels; the figure is gone afterwards."""
    from matplotlib import pyplot

    yield lambda *panels, error=None: draw.figure([front_chart("cost", "Cost", panels, error or decibels("PSNR"))])
    pyplot.close("all")


def test_labels_lie_over_no_point_line_or_other_label(drawn):
    (axis,) = drawn(Panel("title", "instructions", POINTS)).axes
    boxes = [labels.extent(text) for text in axis.texts]
    assert len(boxes) == len(POINTS)
    assert not [1 for a, b in itertools.combinations(boxes, 2) if a.overlaps(b)]
    for x, y in axis.transData.transform([(p.cost, p.error) for p in POINTS]):
        assert not [box for box in boxes if box.contains(x, y)]
    for line in axis.lines:
        places = [tuple(place) for place in line.get_xydata()]
        corners = [places[0], *(corner for a, b in itertools.pairwise(places) for corner in ((b[0], a[1]), b))]
        corners = axis.transData.transform(corners)
        steps = [step for a, b in itertools.pairwise(corners) for step in labels.along(a, b, 0)]
        assert not [1 for box, step in itertools.product(boxes, steps) if box.overlaps(step)]


def test_no_point_lies_within_the_legends_box(drawn):
    """Nor does the legend cover any of an axis."""
    figure = drawn(Panel("a", "instructions", POINTS), Panel("b", "instructions", POINTS[::-1]))
    ((legend,),) = [part.legends for part in figure.subfigs]
    box = legend.get_window_extent()
    for axis in figure.axes:
        assert axis.get_legend() is None and not box.overlaps(axis.get_window_extent())
        assert not [1 for x, y in axis.transData.transform([(p.cost, p.error) for p in POINTS]) if box.contains(x, y)]
    assert [text.get_text() for text in legend.get_texts()] == ["16 bits", "24 bits"]


def test_angles_stand_on_an_axis_of_logarithms_and_decibels_do_not(drawn):
    panel = Panel("title", "instructions", [Point("a", 1, 0.3, 16), Point("b", 2, 120.0, 16)])
    assert drawn(panel, error=LARGEST_ANGLE).axes[0].get_yscale() == "log"
    (axis,) = drawn(panel).axes
    assert (axis.get_yscale(), axis.get_ylabel()) == ("linear", "PSNR, dB")


def test_one_point_is_a_plot_without_a_warning(drawn):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (axis,) = drawn(Panel("title", "instructions", [Point("alone", 3, 48.5, 16)])).axes
    assert [text.get_text() for text in axis.texts] == ["alone"]


def test_spreads_are_bars(drawn):
    (axis,) = drawn(Panel("title", "ms a megapixel", [Point("a", 3, 48.5, 16, 0.5), Point("b", 4, 50.0, 16)])).axes
    (bars,) = [one for one in axis.collections if isinstance(one, LineCollection)]
    assert [float(s[1][0] - s[0][0]) for s in bars.get_segments()] == [0.5]


def test_instructions_and_times_are_charts_of_their_own(monkeypatch):
    made = [Panel("a", "instructions", POINTS, is_counted=True), Panel("b", "ms a megapixel", POINTS)]
    monkeypatch.setattr(cost_plot, "panels", lambda *_: made)
    assert [chart.x.title for chart in cost_plot.charts([], [], [], [], "psnr")] == ["instructions", "ms a megapixel"]
    monkeypatch.setattr(cost_plot, "panels", lambda *_: [])
    assert cost_plot.charts([], [], [], [], "psnr") == []


def plotted(rows, capsys, *storages: str) -> tuple[list[Panel], str]:
    """The panels that rows make on a few directions, and what is said."""
    encodings = [ENCODINGS[name] for name in dict.fromkeys(r["encoding"] for r in rows if r["encoding"])]
    chosen = [STORAGES[name] for name in storages or ("rgba8",)]
    return cost_plot.panels(rows, encodings, chosen, [axes()], "psnr"), capsys.readouterr().err


def test_what_is_left_out_is_said_with_its_reason(capsys):
    rows = [r for r in ROWS if r["storage"] != "rgba8 signed depth 8:8:8"]
    rows.append(row("octahedral", "encode", 14, loops=1))
    (panel,), said = plotted(rows, capsys)
    assert {p.name: p.cost for p in panel.points} == {"xy": 21, "xyz": 32}
    assert panel.title.endswith("navi21, fragment, Mesa 1.2.3")
    assert said.splitlines() == [
        "normalbench: --plot: left out, what rgba8 signed depth 8:8:8 costs is not known: xy_sign",
        "normalbench: --plot: left out, octahedral encode contains a loop, which counts once: octahedral",
    ]


def test_every_family_stage_and_storage_has_a_panel_and_what_has_none_is_said(capsys):
    rows = [r | {"family": f, "stage": s} for f in "abcdefg" for s in ("fragment", "compute") for r in ROWS]
    rows += [row("rgba8_snorm 8:8", "pack", 0) | {"family": f, "stage": "fragment"} for f in "abcdefg"]
    panels, said = plotted(rows[: 4 * len(ROWS)], capsys)
    titles = [panel.title.splitlines()[1] for panel in panels]
    assert titles == [f"{f}, {s}, Mesa 1.2.3" for f in "ab" for s in ("fragment", "compute")] and said == ""
    panels, said = plotted(rows, capsys, "rgba8", "rgba8_snorm")
    assert len(panels) == pareto.MOST_PANELS
    (line,) = said.splitlines()
    assert (
        "room for 12 panels; left out: rgba8 axes g fragment encode, rgba8 axes g compute encode, rgba8_snorm" in line
    )


def test_times_are_milliseconds_with_their_spread_and_say_that_they_are_of_software(capsys):
    timed = {"measure": "time", "family": None, "stage": None, "software": True, "device": "llvmpipe", "driver": "GL"}
    rows = [r | timed | {"ns_per_megapixel": r["instructions"] * 1e6, "spread": 2e5} for r in ROWS]
    (panel,), said = plotted(rows, capsys)
    assert said == "" and panel.unit == "ms a megapixel" and panel.title.endswith("llvmpipe, in software")
    assert {p.name: (p.cost, round(p.spread, 9)) for p in panel.points}["xy"] == (21.0, 0.4)


def test_what_loses_nothing_has_no_place(capsys, monkeypatch):
    monkeypatch.setattr(cost_plot.quality, "measure", lambda _: {"psnr_db": math.inf})
    panels, said = plotted([row("xyz", "encode", 0), row("rgba8 8:8:8", "pack", 3)], capsys)
    assert panels == [] and said == "normalbench: --plot: left out, nothing is lost on axes: xyz\n"


def test_the_error_of_an_encoding_without_a_twin_is_glsls(capsys, monkeypatch):
    by_backend = {"jax": None, "glsl": 48.0}
    monkeypatch.setattr(cost_plot.quality, "measure", lambda case: {"psnr_db": by_backend[case.backend]})
    (panel,), said = plotted([row("xyz", "encode", 0), row("rgba8 8:8:8", "pack", 3)], capsys)
    assert [(point.name, point.error) for point in panel.points] == [("xyz", 48.0)] and said == ""
