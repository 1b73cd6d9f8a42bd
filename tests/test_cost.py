"""What encodings cost: exact subtraction, the same counts twice, and what happens where something fails."""

import itertools
import json
from pathlib import Path

import pytest
from costing import glsl

from normalbench.bench import cost, cost_command, cost_sheets, isa, seeds
from normalbench.bench.disassembly import KINDS, kind, kinds, names
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer import kernels
from normalbench.gbuffer.kernels import PACKINGS, STAGES
from normalbench.reports import pareto, plots


@pytest.fixture(scope="session")
def whole_table(radv, tmp_path_factory):  # noqa: ARG001 (asks for the compilers)
    """Every row of the default table, and its disassembly, from an empty cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        packings = [p for name in ("rgba8", "rgba8_snorm", "12:12", "depth16") for p in PACKINGS[name]]
        chosen = cost.cases(ENCODINGS.values(), packings, cost.OPERATIONS)
        lacks: list[str] = []
        found = list(cost.isa_rows(chosen, list(STAGES), list(isa.FAMILIES), lacks, lambda _: None))
        assert not lacks
        return found


IDENTITIES = [
    ("two", "n.xy", "e.xyx", 2),
    ("crossed", "n.zy", "vec3(view.y, e.yx)", 2),
    ("three", "n", "e", 3),
    ("turned", "vec3(n.yz, view.x)", "e.zxy", 3),
]


@pytest.mark.usefixtures("radv", "own_cache")
def test_an_encoding_that_does_nothing_costs_exactly_nothing(tmp_path):
    """Encode and decode, fragment and compute, every family, every figure; whatever it moves where."""
    encodings = [glsl(tmp_path, *identity) for identity in IDENTITIES]
    chosen = cost.cases(encodings, (), cost.OPERATIONS)
    rows = [r for r, _ in cost.isa_rows(chosen, list(STAGES), list(isa.FAMILIES), [], lambda _: None)]
    assert len(rows) == len(IDENTITIES) * 2 * 2 * len(isa.FAMILIES)
    for row in rows:
        figures = {column: row[column] for column in (*cost.STATISTICS, *KINDS)}
        assert set(figures.values()) == {0}, f"{row['encoding']} {row['operation']} {row['stage']} {row['family']}"
        if row["encoding"] in ("two", "three"):
            assert row["spirv_instructions"] == 0, row


def test_every_encoding_stage_and_family_has_its_row(whole_table):
    keys = [tuple(row[c] for c in ("encoding", "storage", "operation", "stage", "family")) for row, _ in whole_table]
    assert len(set(keys)) == len(keys)
    wanted = itertools.product(ENCODINGS, [None], cost.OPERATIONS, STAGES, isa.FAMILIES)
    assert set(wanted) <= set(keys)
    for row, assembly in whole_table:
        assert tuple(row) == cost.COLUMNS
        assert row["skipped"] is None and row["driver"].startswith("Mesa ") and row["instructions"] >= 0, row
        assert row["encoding"] is None or row["spirv_instructions"] >= 0, row
        assert assembly


def test_the_kinds_add_up_to_the_drivers_own_count(whole_table):
    for row, assembly in whole_table:
        assert sum(row[kind] for kind in KINDS) == row["instructions"], row
        assert len(names(assembly)) > row["instructions"]


def instructions(table, operation: str, stage: str = "fragment") -> dict[str, dict[str, int]]:
    """By family and encoding or storage."""
    found: dict[str, dict[str, int]] = {}
    for row, _ in table:
        if (row["operation"], row["stage"]) == (operation, stage):
            found.setdefault(row["family"], {})[row["encoding"] or row["storage"]] = row["instructions"]
    return found


@pytest.mark.parametrize("stage", STAGES)
def test_known_orders_hold_in_every_family(whole_table, stage):
    for family, count in instructions(whole_table, "encode", stage).items():
        cheap = [count[name] for name in ("xy", "spheremap", "stereographic", "octahedral")]
        assert cheap == sorted(set(cheap)), (family, count)
        # The other way round than in ps_3_0, where a slot computes up to four numbers.
        assert count["octahedral"] < count["spherical"] < count["per_pixel_view"] < count["best_fit"], (family, count)
        assert count["xyz"] == count["xy"] == 0
    for family, count in instructions(whole_table, "decode", stage).items():
        assert count["xy"] < count["stereographic"] < count["spheremap"] < count["octahedral"], (family, count)
        assert count["octahedral"] < count["spherical"] < count["per_pixel_view"], (family, count)


def test_spheremap_costs_the_articles_four_and_three_for_its_pole(whole_table):
    """ps_3_0: mad, rsq, mad, mov. Here mad, rsq, two mul, and cmp and two cndmask for n.z = -1; no scale and bias."""
    for row, assembly in whole_table:
        if (row["encoding"], row["operation"], row["stage"]) == ("spheremap", "encode", "fragment"):
            assert (row["full_rate"], row["transcendental"]) == (6, 1), row
            assert sum(name.startswith(("v_cmp", "v_cndmask")) for name in names(assembly)) == 3


def test_storages_cost_what_their_conversion_is(whole_table):
    """UNORM one multiply-add a number, SNORM nothing, packed words more."""
    for stage, operation in itertools.product(STAGES, ("pack", "unpack")):
        for count in instructions(whole_table, operation, stage).values():
            assert (count["rgba8 8:8"], count["rgba8 8:8:8"]) == (2, 3)
            assert count["rgba8_snorm 8:8"] == count["rgba8_snorm 8:8:8"] == 0
            assert count["rgba8 12:12"] > count["rgba8 depth 8:8"] > 3


@pytest.mark.usefixtures("radv")
def test_disassembly_and_plot_are_written(run, tmp_path):
    out, plot = tmp_path / "listings", tmp_path / "plot.svg"
    status, text, err = run(
        *("cost", "--isa", "--seeds", "--encoding", "xy,octahedral", "--storage", "rgba8", "--family", "navi10,navi21"),
        *("--normals", "axes"),
        *("--disassembly", str(out), "--plot", str(plot)),
    )
    assert (status, err) == (0, "")
    listing = (out / "navi21" / "fragment-octahedral-encode.asm").read_text()
    assert listing.startswith("; octahedral encode, fragment, navi21\n") and "v_rcp_f32" in listing
    assert len(list(out.rglob("*.asm"))) == 2 * 2 * 2 * 4
    assert "octahedral" in plot.read_text() or "<svg" in plot.read_text()
    assert "ps_3_0 slots / navi10 fragment instructions: xy 1/0" in text and "Radeon HD 2400" in text


@pytest.mark.usefixtures("gl")
def test_time_and_jax_rows_say_what_they_are(run):
    words = ["--encoding", "spheremap,per_pixel_view", "--size", "64x64", "--repeats", "3", "--count", "1024"]
    status, out, err = run("cost", "--time", "--jax", *words, "--format", "json")
    rows = json.loads(out)
    assert (status, err) == (0, "") and [row["measure"] for row in rows] == ["time"] * 4 + ["jax"] * 4
    for row in rows[:4]:
        assert row["device"] and row["driver"] and row["clock"] and row["turns"] >= 16 and row["size"] == "64x64"
        assert row["software"] is (row["clock"] != "GL timer query")
        assert row["spread"] >= 0
    assert rows[2]["ns_per_megapixel"] > rows[0]["ns_per_megapixel"] > 0, "a frame by pixel costs more than spheremap"
    assert all(row["millions_per_second"] > 0 for row in rows[4:])


def test_the_articles_figures_are_whole():
    rows = cost_sheets.article_rows(ENCODINGS, cost.OPERATIONS)
    assert len(rows) == len(seeds.PSNR_DB) * 2 * (1 + len(seeds.GPUS))
    assert set(seeds.SLOTS) == set(seeds.CYCLES) == set(itertools.product(seeds.PSNR_DB, cost.OPERATIONS))
    slots = {(r["encoding"], r["operation"]): r["instructions"] for r in rows if not r["device"]}
    # The article's own summary table.
    names = ("xy", "spherical", "spheremap", "stereographic", "per_pixel_view")
    assert [slots[name, "encode"] for name in names] == [1, 26, 4, 5, 17]
    assert [slots[name, "decode"] for name in names] == [8, 18, 9, 8, 22]
    cycles = {(r["encoding"], r["operation"], r["device"]): r["cycles"] for r in rows}
    assert [cycles[name, "encode", "GeForce 8800GTX"] for name in names] == [7, 43, 12, 12, 24]
    assert [cycles[name, "decode", "Radeon HD 2400"] for name in names] == [1, 17, 3, 4, 11]


@pytest.mark.parametrize(
    "name, expected",
    [
        ("v_fma_f32", "full_rate"),
        ("v_dual_mul_f32", "full_rate"),
        ("v_rsq_f32_e64", "transcendental"),
        ("v_s_rcp_f32", "transcendental"),
        ("v_mul_lo_u32", "quarter_rate"),
        ("s_and_b64", "scalar"),
        ("s_load_dwordx4", "memory"),
        ("v_interp_p1_f32_e32", "memory"),
        ("exp", "memory"),
        ("image_load", "memory"),
        ("s_waitcnt", "waiting"),
        ("s_endpgm", "waiting"),
    ],
)
def test_kinds_of_instructions(name, expected):
    assert kind(name) == expected


def test_a_listing_that_is_none_has_no_kinds():
    assert kinds("(no disassembler)\n", 3) is None
    assert kinds("BB0:\n\tv_mov_b32 v0, v1\n\tmystery v0\n", 2) is None
    assert kinds("BB0:\n\tv_mov_b32 v0, v1  ; 7e\n\ts_endpgm\n", 2)["full_rate"] == 1


def test_a_front_is_what_no_other_beats():
    points = [
        ("a", 1, 10, 16),
        ("b", 2, 20, 16),
        ("c", 2, 15, 16),
        ("d", 3, 20, 16),
        ("e", 3, 30, 24),
        ("f", 1, 10, 16),
    ]
    assert [p[0] for p in pareto.pareto_front(points, True)] == ["a", "f", "b", "e"]
    assert [p[0] for p in pareto.pareto_front(points, False)] == ["a", "f"]


def test_labels_lie_over_no_point_and_no_other_label(monkeypatch, tmp_path):
    """Of codecs as near each other as the default plot's."""
    from matplotlib import pyplot

    costs = (2, 4, 3, 3, 26, 17, 9, 12, 15, 10, 30, 16, 68)
    errors = (18.5, 44.4, 52.7, 54.4, 41.6, 41.5, 48.5, 48.5, 48.5, 43.6, 37.6, 49.9, 61.8)
    points = [(name, c, e, 16) for name, c, e in zip(ENCODINGS, costs, errors, strict=False)]
    monkeypatch.setattr(pyplot, "close", lambda _: None)
    plots.save(pareto.pareto_figure([("title", "instructions", points)], "psnr_db"), (tmp_path / "p.png", "png"))
    (axis,) = pyplot.gcf().axes
    boxes = [pareto._extent(text) for text in axis.texts]
    assert len(boxes) == len(points)
    assert not [1 for a, b in itertools.combinations(boxes, 2) if a.overlaps(b)]
    pyplot.gcf().clear()


def test_no_runner_knows_an_encoding():
    """Whatever is in the catalogue is measured: nothing is listed by hand."""
    for module in (cost, cost_command, isa, kernels):
        text = Path(module.__file__).read_text()
        assert not [name for name in ENCODINGS if f'"{name}"' in text and name not in ("xy", "xyz")], module.__name__
