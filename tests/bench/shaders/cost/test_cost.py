"""What encodings cost: exact subtraction, the same counts twice, and what happens where something fails."""

import itertools
import re
import subprocess
import sys
from pathlib import Path

import pytest
from costing import glsl

from normalbench.bench.ground.options.gpu_families import CHOICES
from normalbench.bench.measures.metrics import published
from normalbench.bench.shaders.isa import isa
from normalbench.bench.shaders.isa.disassembly import KINDS, issue_slots, kind, kinds, names
from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.cost import sheets as cost_sheets
from normalbench.bench.tables.cost import work
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.defines import kernels
from normalbench.gbuffer.defines.kernels import STAGES
from normalbench.gbuffer.defines.packings import PACKINGS


@pytest.fixture(scope="session")
def whole_table(radv, tmp_path_factory):  # noqa: ARG001 (asks for the compilers)
    """Every row of the default table, and its disassembly, from an empty cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        packings = [
            p
            for name in ("rgba8", "rgba8_snorm", "12:12", "depth16", "depth24", "depth24_sign")
            for p in PACKINGS[name]
        ]
        chosen = cost.cases(ENCODINGS.values(), packings, cost.OPERATIONS)
        lacks: list[str] = []
        found = list(cost.isa_rows(chosen, list(STAGES), CHOICES["radeon"], lacks, lambda _: None))
        assert not lacks
        return found


# Of a Radeon's row.
LISTED = ("issue_slots", *KINDS, "packed", "branches", "loops", "looped")
IDENTITIES = [
    ("two", "n.xy", "e.xyx", 2),
    ("crossed", "n.zy", "vec3(view.y, e.yx)", 2),
    ("three", "n", "e", 3),
    ("turned", "vec3(n.yz, view.x)", "e.zxy", 3),
]


@pytest.mark.slow
@pytest.mark.usefixtures("radv", "own_cache")
def test_an_encoding_that_does_nothing_costs_exactly_nothing(tmp_path):
    """Encode and decode, fragment and compute, every family, every figure; whatever it moves where."""
    encodings = [glsl(tmp_path, *identity) for identity in IDENTITIES]
    chosen = cost.cases(encodings, (), cost.OPERATIONS)
    rows = [r for r, _ in cost.isa_rows(chosen, list(STAGES), CHOICES["radeon"], [], lambda _: None)]
    assert len(rows) == len(IDENTITIES) * 2 * 2 * len(CHOICES["radeon"])
    for row in rows:
        columns = {*cost.STATISTICS, *LISTED, "spirv_instructions"} - {"stall_cycles"}
        figures = {column: row[column] for column in columns}
        assert set(figures.values()) == {0}, f"{row['encoding']} {row['operation']} {row['stage']} {row['family']}"


def costs_of(encode: str, before: str, folder: Path, families=CHOICES["radeon"]) -> list[dict]:
    """Rows of what encodes so, in both stages."""
    encoding = glsl(folder, "mine", encode, "vec3(e, 0.0)", 2, before)
    chosen = cost.cases([encoding], (), ["encode"])
    return [row for row, _ in cost.isa_rows(chosen, list(STAGES), list(families), [], lambda _: None)]


@pytest.mark.slow
@pytest.mark.usefixtures("radv", "own_cache")
def test_two_multiply_adds_cost_two_slots_everywhere(tmp_path):
    for row in costs_of("n.xy * view.x + n.z", "", tmp_path):
        assert (row["instructions"], row["full_rate"], row["issue_slots"]) == (2, 2, 2), row


@pytest.mark.slow
@pytest.mark.usefixtures("radv", "own_cache")
def test_a_loop_of_a_known_length_costs_what_it_does_written_out(tmp_path):
    turns = "vec2 turned(vec2 e, vec3 n) { for (int i = 0; i < 4; ++i) e = e * n.yz + n.zx; return e; }\n"
    once = "vec2 once(vec2 e, vec3 n) { return e * n.yz + n.zx; }\n"
    looped = costs_of("turned(n.xy, n)", turns, tmp_path)
    for row, written in zip(looped, costs_of("once(once(once(once(n.xy, n), n), n), n)", once, tmp_path), strict=True):
        columns = ("spirv_instructions", "instructions", "issue_slots", "loops", "branches")
        assert [row[c] for c in columns] == [written[c] for c in columns], row
        assert (row["issue_slots"], row["loops"], row["branches"]) == (8, 0, 0) and row["spirv_instructions"] > 8


@pytest.mark.slow
@pytest.mark.usefixtures("radv", "own_cache")
def test_a_loop_that_stays_and_a_branch_are_told(tmp_path):
    """Of either stage and each generation; the kernel's own branch is not one of them."""
    loop = "vec2 many(vec2 e) { while (e.x < 0.9) e = sin(e + e.yx); return e; }\n"
    rows = costs_of("many(n.xy)", loop, tmp_path, ("polaris10", "navi31"))
    for row in rows:
        assert row["loops"] == 1 and row["instructions"] < 40 and row["spirv_instructions"] is None, row
    assert cost.static_notes(rows) == [
        "static count: mine encode contains a loop, whose body counts once, however often it runs"
    ]
    dear = "; ".join("e = sin(e + e.yx) / e" for _ in range(12))
    sides = f"vec2 sides(vec2 e) {{ if (e.x > 0.3) {{ {dear}; }} return e; }}\n"
    rows = costs_of("sides(n.xy)", sides, tmp_path, ("polaris10", "navi31"))
    assert [(row["branches"], row["loops"]) for row in rows] == [(1, 0)] * 4
    assert cost.static_notes(rows) == ["static count: mine encode contains a branch, both of whose sides count"]


@pytest.mark.usefixtures("radv", "own_cache")
def test_names_of_the_kernels_are_free_for_users(tmp_path):
    taken = "const float made = 0.5, lane = 2.0;\nfloat given(float operation) { return operation * made; }\n"
    taken += "float beside(float sum) { return given(sum) * lane; }\n"
    rows = costs_of("n.xy * beside(1.0)", taken, tmp_path, ("navi21",))
    assert [row["skipped"] for row in rows] == [None, None] and {row["instructions"] for row in rows} == {0}


@pytest.mark.slow
def test_every_encoding_stage_and_family_has_its_row(whole_table):
    keys = [tuple(row[c] for c in ("encoding", "storage", "operation", "stage", "family")) for row, _ in whole_table]
    assert len(set(keys)) == len(keys)
    wanted = itertools.product(ENCODINGS, [None], cost.OPERATIONS, STAGES, CHOICES["radeon"])
    assert set(wanted) <= set(keys)
    for row, assembly in whole_table:
        assert tuple(row) == tuple(TABLES["cost"].empty())
        assert row["skipped"] is None and row["driver"].startswith("Mesa ") and row["instructions"] >= 0, row
        is_counted = row["encoding"] and not row["loops"] and not ENCODINGS[row["encoding"]].is_precise
        assert not is_counted or row["spirv_instructions"] >= 0, row
        assert assembly


@pytest.mark.slow
def test_the_kinds_add_up_to_the_drivers_own_count(whole_table):
    for row, assembly in whole_table:
        assert sum(row[kind] for kind in KINDS) == row["instructions"], row
        assert len(names(assembly)) > row["instructions"]


STORE = re.compile(r"^\s+buffer_store_\w+ v\d+, (v\d+), s\[[\d:]+\], (\S+) offen", re.M)


@pytest.mark.slow
def test_no_kernel_computes_addresses(whole_table):
    """Every store of a compute kernel is by the lane's one register and an offset within the instruction."""
    for row, assembly in whole_table:
        if row["stage"] == "compute":
            stores = STORE.findall(assembly)
            assert len(stores) >= 7 and len(set(stores)) == 1 and stores[0][1] == "0", (
                cost.listing(row, "")[0],
                stores,
            )


@pytest.mark.slow
def test_slots_are_what_the_drivers_model_says_where_arithmetic_is_all_there_is(whole_table):
    """Navi's fragment shaders, wave of 64: two cycles a slot, from one kernel of two numbers to another."""
    for family in ("navi10", "navi21", "navi31"):
        found = {
            row["encoding"]: (row["issue_slots"], row["kernel_inverse_throughput"])
            for row, _ in whole_table
            if (row["family"], row["stage"], row["operation"]) == (family, "fragment", "decode")
        }
        first = found["xy"]
        for name in ("spheremap", "stereographic", "octahedral", "spherical", "per_pixel_view"):
            slots, cycles = (a - b for a, b in zip(found[name], first, strict=True))
            assert cycles == 2 * slots > 0, (family, name)


@pytest.mark.slow
def test_stages_have_one_count_of_spirv(whole_table):
    found = {}
    for row, _ in whole_table:
        if row["encoding"]:
            found.setdefault((row["encoding"], row["operation"]), set()).add(row["spirv_instructions"])
    assert all(len(counts) == 1 for counts in found.values()), found


def instructions(table, operation: str, stage: str = "fragment") -> dict[str, dict[str, int]]:
    """By family and encoding or storage."""
    found: dict[str, dict[str, int]] = {}
    for row, _ in table:
        if (row["operation"], row["stage"]) == (operation, stage):
            found.setdefault(row["family"], {})[row["encoding"] or row["storage"]] = row["instructions"]
    return found


@pytest.mark.slow
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


@pytest.mark.slow
def test_spheremap_costs_the_articles_four_and_three_for_its_pole(whole_table):
    """ps_3_0: mad, rsq, mad, mov. Here mad, rsq, two mul, and cmp and two cndmask for n.z = -1; no scale and bias."""
    for row, assembly in whole_table:
        if (row["encoding"], row["operation"], row["stage"]) == ("spheremap", "encode", "fragment"):
            assert (row["full_rate"], row["transcendental"]) == (6, 1), row
            assert sum(name.startswith(("v_cmp", "v_cndmask")) for name in names(assembly)) == 3


@pytest.mark.slow
def test_storages_cost_what_their_conversion_is(whole_table):
    """UNORM one multiply-add a number, SNORM nothing, packed words more."""
    for stage, operation in itertools.product(STAGES, ("pack", "unpack")):
        for count in instructions(whole_table, operation, stage).values():
            assert (count["rgba8 8:8"], count["rgba8 8:8:8"]) == (2, 3)
            assert count["rgba8_snorm 8:8"] == count["rgba8_snorm 8:8:8"] == 0
            assert min(count["rgb8_12_12 12:12"], count["rgba8 depth 8:8"]) > 3 * count["rgba8 8:8"]
            assert count["rgba8 signed depth 8:8:8"] > count["rgba8 depth 8:8:8"]


@pytest.mark.slow
@pytest.mark.usefixtures("radv", "own_cache")
def test_an_encoding_that_is_rounded_precisely_costs_its_choice():
    """Of four codes of two numbers each is decoded: what a lane pays to round so."""
    plain, precise = (ENCODINGS[name] for name in ("octahedral", "octahedral_precise"))
    chosen = cost.cases([plain, precise], (), cost.OPERATIONS)
    rows = {
        (row["encoding"], row["operation"], row["stage"]): row
        for row, _ in cost.isa_rows(chosen, list(STAGES), ["navi21"], [], lambda _: None)
    }
    for stage in STAGES:
        once, again = (rows[name, "encode", stage] for name in ("octahedral", "octahedral_precise"))
        decode = rows["octahedral", "decode", stage]["instructions"]
        assert again["instructions"] > once["instructions"] + 4 * decode and again["spirv_instructions"] is None
        assert rows["octahedral_precise", "decode", stage]["instructions"] == decode


@pytest.mark.slow
def test_the_far_plane_is_no_lanes_work(whole_table):
    for row, _ in whole_table:
        assert row["transcendental"] == 0 or "depth" not in str(row["storage"]), row


@pytest.mark.slow
@pytest.mark.usefixtures("radv", "own_cache")
def test_instructions_wait_for_no_import_of_jax_or_pandas():
    """From the cache the table is there in two seconds, of which JAX would take one more."""
    program = (
        "import sys; from normalbench.bench.door.cli.app import main;"
        "asked = '--isa --encoding spheremap --family navi21 --storage rgba8';"
        "sys.argv = ['normalbench', 'cost', *asked.split()]; main();"
        "print({'jax', 'pandas', 'matplotlib'} & set(sys.modules) or 'light')"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "spheremap" in done.stdout and done.stdout.strip().endswith("light"), done.stdout[-200:]


@pytest.mark.slow
@pytest.mark.usefixtures("radv")
def test_disassembly_is_written(run, tmp_path):
    out = tmp_path / "listings"
    status, text, err = run(
        *("cost", "--isa", "--article", "--encoding", "xy,octahedral", "--storage", "rgba8"),
        *("--family", "navi10,navi21", "--disassembly", str(out)),
    )
    assert (status, err) == (0, "")
    listing = (out / "navi21" / "fragment-octahedral-encode.asm").read_text()
    assert listing.startswith("; octahedral encode, fragment, navi21\n") and "v_rcp_f32" in listing
    assert (out / "source" / "octahedral.glsl").read_text() == ENCODINGS["octahedral"].glsl.read_text()
    assert len(list(out.rglob("*.asm"))) == 2 * 2 * 2 * 4
    assert "ps_3_0 slots / navi10 fragment instructions: xy 1/0" in text and "Radeon HD 2400" in text


def test_the_articles_figures_are_whole():
    rows = cost_sheets.article_rows(ENCODINGS, cost.OPERATIONS)
    assert len(rows) == len(published.PSNR_DB) * 2 * (1 + len(published.GPUS))
    assert set(published.SLOTS) == set(published.CYCLES) == set(itertools.product(published.PSNR_DB, cost.OPERATIONS))
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
        ("v_mul_u32_u24_e32", "full_rate"),
        ("v_mul_hi_u32_u24_e32", "full_rate"),
        ("v_mul_lo_u16_e32", "full_rate"),
        ("v_cvt_f32_ubyte1_e32", "full_rate"),
        ("v_cvt_pkrtz_f16_f32_e64", "full_rate"),
        ("v_cvt_u32_f32_sdwa", "conversion"),
        ("v_cvt_f16_f32_e32", "conversion"),
        ("v_rcp_iflag_f32_e32", "transcendental"),
        ("v_sqrt_f32_e32", "transcendental"),
        ("v_sin_f32_e32", "transcendental"),
        ("v_log_f32_e32", "transcendental"),
        ("v_exp_f32_e32", "transcendental"),
        ("v_mul_hi_u32", "quarter_rate"),
        ("v_mul_hi_i32", "quarter_rate"),
        ("v_mad_u64_u32", "quarter_rate"),
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


def test_what_is_repeated_counts_as_often():
    text = "BB0:\n\tv_rcp_f32 v0, v0\n\tv_mul_f32 v4, v4, v4\n\t(then repeated 2 times)\n\ts_endpgm\n"
    found = kinds(text, 5)
    assert found and (found["full_rate"], found["transcendental"], found["waiting"]) == (3, 1, 1)


def test_fused_multiply_adds_are_slow_on_polaris_alone():
    assert [kind("v_fma_f32", family) for family in CHOICES["radeon"]] == ["quarter_rate", *["full_rate"] * 4]


def test_doubles_have_no_kind():
    with pytest.raises(ValueError, match="v_add_f64 computes doubles"):
        kind("v_add_f64")


@pytest.mark.parametrize(
    "family, slots",
    [("polaris10", 61), ("vega10", 61), ("navi10", 20), ("navi21", 20), ("navi31", 20), ("another", None)],
)
def test_slots_are_by_the_familys_rates(family, slots):
    """5 full-rate, 2 conversions, 3 products, 1 + 8 transcendental; nothing for what is no lane's."""
    counts = {"full_rate": 5, "conversion": 2, "quarter_rate": 3, "transcendental": 9, "scalar": 7, "memory": 11}
    expected = slots if slots is None else {61: 5 + 4 * (2 + 3 + 9), 20: 5 + 2 + 4 * 3 + 9}[slots]
    assert issue_slots({**counts, "waiting": 13}, family) == expected


def made(assembly: str, **statistics: float) -> isa.Compiled:
    names = {name.replace("_", " "): value for name, value in statistics.items()}
    kernel = isa.Kernel(64, {"Instructions": 2, "Code size": 8, **names}, assembly)
    return isa.Compiled("navi21", "a device", "1.2.3", (kernel,))


def test_spills_are_of_both_sorts_of_registers():
    few = {"VGPRs": 8, "SGPRs": 16, "Spilled_VGPRs": 1, "Spilled_SGPRs": 2}
    many = few | {"Spilled_VGPRs": 4, "Spilled_SGPRs": 7, "VGPRs": 12}
    row = TABLES["cost"].empty() | {"family": "navi21"}
    text = "BB0:\n\tv_mov_b32 v0, v1\n\ts_endpgm\n"
    found, _ = cost._figures(row, made(text, **many), made(text, **few))
    assert (found["spills"], found["vgprs"], found["sgprs"], found["kernel_vgprs"]) == (8, 4, 0, 12)


LISTINGS = {
    "xy": (4, "v_min_f32 v0, v1, v2"),
    "spherical": (9, "v_rcp_f32 v0, v1"),
    "spheremap": (7, "v_cmp_lt_f32 vcc, v0, v1"),
    "stereographic": (6, "v_cmpx_ne_u32 exec, v0, v1"),
}


def test_notes_say_which_change_places_and_what_their_listings_hold():
    """By slots xy, spheremap, stereographic, spherical; by these instructions stereographic comes before spheremap. Not
    only neighbours are compared, and the kernel's own mask is no guard."""
    listed = []
    for name, (count, line) in LISTINGS.items():
        row = TABLES["cost"].empty() | {"encoding": name, "operation": "encode", "instructions": count}
        listed.append(
            (row | {"stage": "fragment", "family": "navi21", "transcendental": name.count("r")}, f"\t{line}\n")
        )
    article = cost_sheets.article_rows(LISTINGS, ["encode"])
    first, turned, *rows = cost_sheets.order_notes(listed, article)
    assert first.endswith("xy 1/4, spheremap 4/7, stereographic 5/6, spherical 26/9")
    assert turned == "  the other way round: spheremap and stereographic"
    assert rows == [
        "  spheremap: 7 instructions for 4 slots, of them 1 to compare, choose or clamp, 1 transcendental",
        "  stereographic: 6 instructions for 5 slots, of them 0 to compare, choose or clamp, 2 transcendental",
    ]
    listed[0][0]["instructions"] = 8
    _, turned, *rows = cost_sheets.order_notes(listed, article)
    assert turned.endswith("xy and spheremap, xy and stereographic, spheremap and stereographic") and len(rows) == 3


def test_no_runner_knows_an_encoding():
    """Whatever is in the catalogue is measured: nothing is listed by hand."""
    for module in (cost, work, isa, kernels):
        text = Path(module.__file__).read_text()
        assert not [name for name in ENCODINGS if f'"{name}"' in text and name not in ("xy", "xyz")], module.__name__
