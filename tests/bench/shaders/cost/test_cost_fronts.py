"""The chart of cost against error: sums, Pareto fronts and positions of labels."""

import itertools
import warnings

import pytest

from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.cost.charts import front_chart
from normalbench.bench.tables.cost.codec_costs import Costs, LeftOutError, Where
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.reports.charts import draw, labels, pareto
from normalbench.reports.charts.pareto import Panel, Point

WHERE = Where("isa", "navi21", "fragment")


def row(what: str, operation: str, count: float | None, **more) -> dict:
    """Return a row of an encoding, or of a storage's packing, for navi21's fragment shaders."""
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
def test_cost_of_a_codec_is_the_sum_of_encoding_storage_and_sign(name, total):
    assert cost_of(name) == total


@pytest.mark.parametrize(
    "name, storage, lost, reason",
    [
        ("xy", "rgba8", "rgba8 8:8", "the cost of rgba8 8:8 is not known"),
        ("xy", "rgba8", "xy", "its cost is not known"),
        ("xy_sign", "rgba8", "rgba8 signed depth 8:8:8", "the cost of rgba8 signed depth 8:8:8 is not known"),
        ("xyz", "rg8", "nothing", "it does not fit in rg8: 3 components, but RG8 has 2 channels"),
        ("xy", "rg8", "nothing", "the cost of rg8 8:8 is not known"),
    ],
)
def test_unknown_part_of_a_cost_does_not_count_as_zero(name, storage, lost, reason):
    for gone in ([r for r in ROWS if lost not in (r["storage"], r["encoding"])], []):
        rows = gone or [r | {"instructions": None} if lost in (r["storage"], r["encoding"]) else r for r in ROWS]
        with pytest.raises(LeftOutError) as raised:
            cost_of(name, rows, storage)
        assert str(raised.value) == reason


def test_a_loop_has_no_total_cost_and_a_branch_is_marked():
    with pytest.raises(LeftOutError, match="xy encode contains a loop, which is counted only once"):
        cost_of("xy", [*ROWS, row("xy", "encode", 1, loops=1, branches=1)])
    codec = Codec(ENCODINGS["xy"], STORAGES["rgba8"])
    marked = Costs([*ROWS, row("xy", "encode", 1, loops=0, branches=1)]).of(codec, WHERE, "encode", "instructions")
    assert marked.branches and marked.cost == 21


def test_pareto_front_has_the_points_that_no_other_point_beats():
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
    assert [p.name for p in pareto.pareto_front(points)] == ["a", "f", "b", "e", "g"]


def test_negligible_differences_beat_no_point():
    """At equal cost, a difference of up to 0.05 dB beats no codec; a more expensive codec must gain more."""
    for good, bad, front in ((48.563975, 48.563965, ["good", "bad"]), (48.6, 48.5, ["good"])):
        assert [p.name for p in pareto.pareto_front([Point("good", 10, good, 16), Point("bad", 10, bad, 16)])] == front
    dear = [Point("dear", 11, 48.563975, 16), Point("cheap", 10, 48.563965, 16)]
    assert [p.name for p in pareto.pareto_front(dear)] == ["cheap"]


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
    """A function that draws panels; the figure is closed afterwards."""
    from matplotlib import pyplot

    yield lambda *panels: draw.figure([front_chart("cost", "PSNR", panels)])
    pyplot.close("all")


def test_labels_do_not_overlap_points_lines_or_other_labels(drawn):
    (axis,) = drawn(Panel("encode", POINTS)).axes
    boxes = [labels.extent(text) for text in axis.texts]
    assert len(boxes) == len(POINTS)
    assert not [1 for a, b in itertools.combinations(boxes, 2) if a.overlaps(b)]
    for x, y in axis.transData.transform([(p.cost, p.psnr) for p in POINTS]):
        assert not [box for box in boxes if box.contains(x, y)]
    for line in axis.lines:
        places = [tuple(place) for place in line.get_xydata()]
        corners = [places[0], *(corner for a, b in itertools.pairwise(places) for corner in ((b[0], a[1]), b))]
        corners = axis.transData.transform(corners)
        steps = [step for a, b in itertools.pairwise(corners) for step in labels.along(a, b, 0)]
        assert not [1 for box, step in itertools.product(boxes, steps) if box.overlaps(step)]


def test_a_single_point_is_plotted_without_a_warning(drawn):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (axis,) = drawn(Panel("encode", [Point("alone", 3, 48.5, 16)])).axes
    assert [text.get_text() for text in axis.texts] == ["alone"]
