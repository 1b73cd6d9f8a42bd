"""Costs of encodings: exact subtraction, repeatable counts and failures."""

import itertools
import re
from pathlib import Path

import pytest
from costing import glsl

from normalbench.bench.ground.options.gpu_families import CHOICES
from normalbench.bench.shaders.isa.disassembly import KINDS, names
from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.rules import by_rule
from normalbench.gbuffer.defines.kernels import STAGES
from normalbench.gbuffer.defines.packings import PACKINGS, StoragePacking

# The one without a multiply-add of full rate, and one with waves of 64; all five at night.
FAMILIES = ("polaris10", "navi21")


@pytest.fixture(scope="session")
def whole_table(radv, tmp_path_factory):  # noqa: ARG001 (asks for the compilers)
    """Every row of the default table for two families, and its disassembly, from an empty cache."""
    return table_of(FAMILIES, tmp_path_factory.mktemp("cache"))


def table_of(families, cache) -> list:
    """Return every row of the default table for some families, with its disassembly."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(cache))
        packings = [
            p
            for name in ("rgba8", "rgba8_snorm", "12:12", "depth16", "depth24", "depth24_sign")
            for p in PACKINGS[name]
        ]
        packings += [StoragePacking(by_rule("uint", (12, 12)), 2)]
        chosen = cost.cases(ENCODINGS.values(), packings, cost.OPERATIONS)
        lacks: list[str] = []
        rows = list(cost.isa_rows(chosen, list(STAGES), [*families], lacks, lambda _: None))
        assert not lacks
        return rows


# Of a Radeon's row.
LISTED = ("issue_slots", *KINDS, "packed", "branches", "loops", "looped")


IDENTITIES = [
    ("two", "n.xy", "e.xyx", 2),
    ("crossed", "n.zy", "vec3(view.y, e.yx)", 2),
    ("three", "n", "e", 3),
    ("turned", "vec3(n.yz, view.x)", "e.zxy", 3),
]


@pytest.mark.usefixtures("radv", "own_cache")
def test_an_encoding_that_does_nothing_costs_exactly_nothing(tmp_path):
    """This holds for both operations and stages, every family and every figure, even if components are swapped."""
    encodings = [glsl(tmp_path, *identity) for identity in IDENTITIES]
    chosen = cost.cases(encodings, (), cost.OPERATIONS)
    rows = [r for r, _ in cost.isa_rows(chosen, list(STAGES), CHOICES["radeon"], [], lambda _: None)]
    assert len(rows) == len(IDENTITIES) * 2 * 2 * len(CHOICES["radeon"])
    for row in rows:
        columns = {*cost.STATISTICS, *LISTED, "spirv_instructions"} - {"stall_cycles"}
        figures = {column: row[column] for column in columns}
        assert set(figures.values()) == {0}, f"{row['encoding']} {row['operation']} {row['stage']} {row['family']}"


def costs_of(encode: str, before: str, folder: Path, families=CHOICES["radeon"]) -> list[dict]:
    """Return the rows of an encoder in both stages."""
    encoding = glsl(folder, "mine", encode, "vec3(e, 0.0)", 2, before)
    chosen = cost.cases([encoding], (), ["encode"])
    return [row for row, _ in cost.isa_rows(chosen, list(STAGES), list(families), [], lambda _: None)]


@pytest.mark.usefixtures("radv", "own_cache")
def test_two_multiply_adds_cost_two_slots_everywhere(tmp_path):
    for row in costs_of("n.xy * view.x + n.z", "", tmp_path):
        assert (row["instructions"], row["full_rate"], row["issue_slots"]) == (2, 2, 2), row


@pytest.mark.usefixtures("radv", "own_cache")
def test_a_loop_of_known_length_costs_the_same_as_its_unrolled_form(tmp_path):
    turns = "vec2 turned(vec2 e, vec3 n) { for (int i = 0; i < 4; ++i) e = e * n.yz + n.zx; return e; }\n"
    once = "vec2 once(vec2 e, vec3 n) { return e * n.yz + n.zx; }\n"
    looped = costs_of("turned(n.xy, n)", turns, tmp_path)
    for row, written in zip(looped, costs_of("once(once(once(once(n.xy, n), n), n), n)", once, tmp_path), strict=True):
        columns = ("spirv_instructions", "instructions", "issue_slots", "loops", "branches")
        assert [row[c] for c in columns] == [written[c] for c in columns], row
        assert (row["issue_slots"], row["loops"], row["branches"]) == (8, 0, 0) and row["spirv_instructions"] > 8


@pytest.mark.usefixtures("radv", "own_cache")
def test_remaining_loops_and_branches_are_reported(tmp_path):
    """Both stages of an old and a new family are checked; the kernel's own branch does not count."""
    loop = "vec2 many(vec2 e) { while (e.x < 0.9) e = sin(e + e.yx); return e; }\n"
    rows = costs_of("many(n.xy)", loop, tmp_path, ("polaris10", "navi31"))
    for row in rows:
        assert row["loops"] == 1 and row["instructions"] < 40 and row["spirv_instructions"] is None, row
    assert cost.static_notes(rows) == ["static count: mine encode: each loop body counts once, however often it runs"]
    dear = "; ".join("e = sin(e + e.yx) / e" for _ in range(12))
    sides = f"vec2 sides(vec2 e) {{ if (e.x > 0.3) {{ {dear}; }} return e; }}\n"
    rows = costs_of("sides(n.xy)", sides, tmp_path, ("polaris10", "navi31"))
    assert [(row["branches"], row["loops"]) for row in rows] == [(1, 0)] * 4
    assert cost.static_notes(rows) == ["static count: mine encode: both sides of each branch count"]


@pytest.mark.usefixtures("radv", "own_cache")
def test_users_may_reuse_the_names_in_the_kernels(tmp_path):
    taken = "const float made = 0.5, lane = 2.0;\nfloat given(float operation) { return operation * made; }\n"
    taken += "float beside(float sum) { return given(sum) * lane; }\n"
    rows = costs_of("n.xy * beside(1.0)", taken, tmp_path, ("navi21",))
    assert [row["skipped"] for row in rows] == [None, None] and {row["instructions"] for row in rows} == {0}


def test_every_encoding_stage_and_family_has_its_row(whole_table):
    keys = [tuple(row[c] for c in ("encoding", "storage", "operation", "stage", "family")) for row, _ in whole_table]
    assert len(set(keys)) == len(keys)
    families = {row["family"] for row, _ in whole_table}
    assert families >= {*FAMILIES}
    wanted = itertools.product(ENCODINGS, [None], cost.OPERATIONS, STAGES, families)
    assert set(wanted) <= set(keys)
    for row, assembly in whole_table:
        assert tuple(row) == tuple(TABLES["cost"].empty())
        assert row["skipped"] is None and row["driver"].startswith("Mesa ") and row["instructions"] >= 0, row
        is_counted = row["encoding"] and not row["loops"] and not ENCODINGS[row["encoding"]].is_precise
        assert not is_counted or row["spirv_instructions"] >= 0, row
        assert assembly


def test_the_kinds_add_up_to_the_drivers_own_count(whole_table):
    for row, assembly in whole_table:
        assert sum(row[kind] for kind in KINDS) == row["instructions"], row
        assert len(names(assembly)) > row["instructions"]


STORE = re.compile(r"^\s+buffer_store_\w+ v\d+, (v\d+), s\[[\d:]+\], (\S+) offen", re.M)


def test_no_kernel_computes_addresses(whole_table):
    """Every store of a compute kernel uses one address register and an offset within the instruction."""
    for row, assembly in whole_table:
        if row["stage"] == "compute":
            stores = STORE.findall(assembly)
            assert len(stores) >= 7 and len(set(stores)) == 1 and stores[0][1] == "0", (
                cost.listing(row, "")[0],
                stores,
            )


def test_slots_match_the_drivers_model_for_pure_arithmetic(whole_table):
    """Fragment shaders on Navi in waves of 64 take two cycles per slot; two-component decoders are compared."""
    navis = {row["family"] for row, _ in whole_table} & {"navi10", "navi21", "navi31"}
    assert navis
    for family in navis:
        figures = {
            row["encoding"]: (row["issue_slots"], row["kernel_inverse_throughput"])
            for row, _ in whole_table
            if (row["family"], row["stage"], row["operation"]) == (family, "fragment", "decode")
        }
        first = figures["xy"]
        for name in ("spheremap", "stereographic", "octahedral", "spherical", "per_pixel_view"):
            slots, cycles = (a - b for a, b in zip(figures[name], first, strict=True))
            assert cycles == 2 * slots > 0, (family, name)


def test_both_stages_have_the_same_spirv_count(whole_table):
    by_code = {}
    for row, _ in whole_table:
        if row["encoding"]:
            by_code.setdefault((row["encoding"], row["operation"]), set()).add(row["spirv_instructions"])
    assert all(len(counts) == 1 for counts in by_code.values()), by_code


def instructions(table, operation: str, stage: str = "fragment") -> dict[str, dict[str, int]]:
    """Return the instructions of an operation by family and by encoding or storage."""
    counts: dict[str, dict[str, int]] = {}
    for row, _ in table:
        if (row["operation"], row["stage"]) == (operation, stage):
            counts.setdefault(row["family"], {})[row["encoding"] or row["storage"]] = row["instructions"]
    return counts


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


def test_spheremap_costs_the_articles_four_instructions_plus_three_for_its_pole(whole_table):
    """ps_3_0: mad, rsq, mad, mov. Here mad, rsq, two mul, and cmp and two cndmask for n.z = -1; no scale and bias."""
    for row, assembly in whole_table:
        if (row["encoding"], row["operation"], row["stage"]) == ("spheremap", "encode", "fragment"):
            assert (row["full_rate"], row["transcendental"]) == (6, 1), row
            assert sum(name.startswith(("v_cmp", "v_cndmask")) for name in names(assembly)) == 3


def test_storages_cost_as_much_as_their_conversion(whole_table):
    """UNORM takes one multiply-add per number, SNORM nothing, and packed words more, most if bytes are split."""
    for stage, operation in itertools.product(STAGES, ("pack", "unpack")):
        for count in instructions(whole_table, operation, stage).values():
            assert (count["rgba8 8:8"], count["rgba8 8:8:8"]) == (2, 3)
            assert count["rgba8_snorm 8:8"] == count["rgba8_snorm 8:8:8"] == 0
            assert min(count["rgb8_12_12 12:12"], count["rgba8 depth 8:8"]) > 3 * count["rgba8 8:8"]
            assert count["rgba8 8:8"] < count["r32_uint_12_12 12:12"] < 0.8 * count["rgb8_12_12 12:12"]
            assert count["rgba8 signed depth 8:8:8"] > count["rgba8 depth 8:8:8"]


@pytest.mark.usefixtures("radv", "own_cache")
def test_cost_of_precise_rounding_includes_its_search():
    """Each of the four candidate codes is decoded, which the count includes."""
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


def test_far_plane_is_not_computed_per_lane(whole_table):
    for row, _ in whole_table:
        assert row["transcendental"] == 0 or "depth" not in str(row["storage"]), row


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
    assert "Radeon HD 2400" in text
