"""Costs of the layouts of `budget`: bytes that passes fetch, and issue slots to pack and unpack."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from fitting import fit

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.isa import isa
from normalbench.bench.tables.budget import attributes as held
from normalbench.bench.tables.budget import cost
from normalbench.bench.tables.budget.bins import BINS
from normalbench.bench.tables.budget.readers import read_readers
from normalbench.bench.tables.budget.solve import Placed, Problem, Rules, solved
from normalbench.bench.tables.budget.table import BudgetOptions
from normalbench.gbuffer.layouts.presets import LAYOUTS


@pytest.mark.parametrize(
    ("readers", "unreal", "signed", "said"),
    [
        # Four targets of 4 bytes each. Unreal keeps the normal in the first, roughness and id in the second, base
        # colour and occlusion in the third. The other one keeps the normal's x and y in the first, and the sign of its
        # z on the depth in the second; base colour and id in the third, F0 and its power in the fourth.
        ("1", 16, 16, "once in full"),
        ("2.5", 40, 40, "2.5 times in full"),
        ("all,all", 32, 32, "twice in full"),
        ("normal", 4, 8, "never in full, once for normal"),
        (
            "normal+roughness, shading_model,1",
            28,
            32,
            "once in full, once for normal and roughness, once for shading_model",
        ),
        ("base_color+shading_model", 8, 4, "never in full, once for base_color and shading_model"),
        ("f0", 4, 4, "never in full, once for f0"),
        # Neither holds it.
        ("emissive", 0, 0, "never in full, once for emissive"),
        ("0", 0, 0, "never in full"),
    ],
)
def test_a_decoding_pass_fetches_only_the_targets_that_it_reads(readers, unreal, signed, said):
    parsed = read_readers(BudgetOptions(readers=readers).readers)
    assert parsed.bytes_of(LAYOUTS["unreal4"]) == unreal
    assert parsed.bytes_of(LAYOUTS["xy_depth_sign"]) == signed
    assert parsed.said == said


@pytest.mark.parametrize(
    ("readers", "said"),
    [
        ("-1", "--readers -1.0: out of range; use 0.0 to 64.0"),
        ("nan", "--readers -1.0: out of range; use 0.0 to 64.0"),
        ("32,33", "--readers 65.0: out of range; use 0.0 to 64.0"),
        ("normals", "--readers normals: unknown; use a number, all, or attributes joined by +: normal, base_color"),
        ("normal+flags", "--readers normal+flags: unknown"),
        ("normal+", "--readers normal+: unknown"),
    ],
)
def test_invalid_readers_are_an_error(readers, said):
    with pytest.raises(UsageError) as caught:
        read_readers(BudgetOptions(readers=readers).readers)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["--readers", "emissive"], "--readers emissive: not in --hold; in --hold: normal, base_color, roughness"),
        (["--family", "cypress"], "unknown"),
        (["--family", "navi22"], "navi22"),
        (["--most-instructions", "-1"], "--most-instructions -1: out of range; use 0 to 1000000"),
    ],
)
@pytest.mark.usefixtures("gl")
def test_invalid_request_is_an_error_message(run, asked, said):
    status, _, err = run("budget", "--scene", "ramps", "--size", "64x48", *asked)
    assert status != 0 and said in err and "Traceback" not in err, err


@pytest.mark.usefixtures("gl")
def test_a_slot_limit_without_a_compiler_names_the_missing_library(run, monkeypatch):
    monkeypatch.setattr(isa, "missing", lambda library: f"no {library}")
    status, _, err = run("budget", "--scene", "ramps", "--size", "64x48", "--most-instructions", "90")
    assert status == 3 and "--most-instructions requires a compiler: no libvulkan_radeon" in err, err


def test_cost_is_unknown_without_a_compiler(monkeypatch):
    monkeypatch.setattr(cost, "counted", lambda *_: {})
    assert cost.Slots(["navi21"]).columns(LAYOUTS["unreal4"], 1.5, 1.0) == {}


def test_most_expensive_family_is_chosen_per_pixel(monkeypatch):
    """With overdraw 3 and 1 pass, A takes 3 x 10 + 30 = 60 and B 3 x 20 + 5 = 65; with 4 passes A takes more."""
    told = {"A": (10, 30), "B": (20, 5)}

    def counted(cases, family, _):
        return {
            (case.storage, case.operation): {"executed_slots": told[family][case.operation == "unpack"]}
            for case in cases
        }

    monkeypatch.setattr(cost, "counted", counted)
    slots = cost.Slots(["A", "B"])
    row = slots.columns(LAYOUTS["unreal4"], 3.0, 1.0)
    assert row == {"pack_slots": 20, "unpack_slots": 5, "slots": 65, "dearest_family": "B"}
    assert slots.columns(LAYOUTS["unreal4"], 3.0, 4.0)["dearest_family"] == "A"
    assert slots.once(LAYOUTS["unreal4"]) == 40


# Three attributes in targets of unequal sizes, as a search by hand can go through.
FEW = [
    replace(held.SEEN["normal"], codes=tuple(c for c in held.SEEN["normal"].codes if c.bits[0] in (10, 12, 14))),
    replace(held.SEEN["roughness"], codes=held.SEEN["roughness"].codes[1:4]),
    replace(held.SEEN["metallic"], codes=held.SEEN["metallic"].codes[::2]),
]


HOMES = [replace(BINS[name], copies=1) for name in ("rgb10a2", "rg8", "r32_uint_fields")]


class Told:
    """Predefined slots: a number for each code, plus or minus a number for each word that a layout joins."""

    def __init__(self, seed: int, join: float):
        self._random, self._join = np.random.default_rng(seed), join
        self._codes: dict[tuple[str, str, str], int] = {}

    def count_codes(self, _):
        """Do nothing, because no code needs counting."""

    def of_code(self, code, one):
        return self._codes.setdefault((code.attribute, code.name, one.name), int(self._random.integers(1, 30)))

    def of_whole(self, placed):
        joined = len(placed) - len({part.bin.name for part in placed})
        return sum(self.of_code(part.code, part.bin) for part in placed) + self._join * joined


def _possible(limit: int):
    """Yield every way to place the codes of FEW in HOMES within a byte limit."""
    for codes in itertools.product(*(attribute.codes for attribute in FEW)):
        for homes in itertools.product(HOMES, repeat=len(codes)):
            if sum(home.bytes for home in set(homes)) <= limit and fit(codes, homes):
                yield [Placed(code, home, 0) for code, home in zip(codes, homes, strict=True)]


def _errors(seed: int) -> dict:
    """Return errors that fall by 6 dB per bit in two classes."""
    rng = np.random.default_rng(seed)
    starts = {a.name: 10 ** rng.uniform(-1, 1, 2) for a in FEW}
    return {
        (a.name, code.name): {
            f"class {i}": start * 4.0 ** (-code.total_bits / len(code.bits)) for i, start in enumerate(starts[a.name])
        }
        for a in FEW
        for code in a.codes
    }


@pytest.mark.parametrize("join", [0.0, 2.0, -2.0])
@pytest.mark.parametrize("seed", range(6))
def test_best_layout_within_a_slot_limit_matches_exhaustive_search(monkeypatch, seed, join):
    """The results match if layouts cost as much as their codes; in other cases a layout within the limit is found."""
    told = Told(seed, join)
    monkeypatch.setattr(cost, "whole", lambda slots, found: slots.of_whole(found.placed))
    problem = Problem(FEW, _errors(seed), ["class 0", "class 1"], HOMES, Rules(8, 3))
    possible = list(_possible(8))
    prices = [told.of_whole(placed) for placed in possible]

    def worst(placed) -> float:
        return max(sum(problem.error(part.code, name) for part in placed) for name in problem.classes)

    def solve(asked):
        return [answer] if (answer := solved(asked)) else []

    for most in (min(prices) - 1, min(prices), sorted(prices)[len(prices) // 3], max(prices)):
        solutions = cost.within(problem, most, told, solve)
        if most < min(prices):
            assert not solutions
            continue
        fitting = [worst(placed) for placed, price in zip(possible, prices, strict=True) if price <= most]
        (solution,) = solutions
        assert told.of_whole(solution.placed) <= most
        if not join:
            assert min(fitting) * (1 - 1e-6) <= worst(solution.placed) <= max(min(fitting) * 10**0.0202, 1e-6), most
    cheapest = cost.least(problem, told, solve)
    assert cheapest and told.of_whole(cheapest.placed) == min(prices)
