"""`normalbench budget`: comparison with exhaustive search, target rules, minimum precision, a rendered layout."""

import itertools
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from typed import attributes_held

from normalbench.bench.door.run import chosen_tables, options_of
from normalbench.bench.measures.metrics.totals import psnr_db
from normalbench.bench.tables.budget import attributes as held
from normalbench.bench.tables.budget import changes
from normalbench.bench.tables.budget.bins import BINS, WEBGPU, WEBGPU_BYTES, webgpu_cost
from normalbench.bench.tables.budget.charts import charts
from normalbench.bench.tables.budget.contract import KNOWN
from normalbench.bench.tables.budget.measure import Judged
from normalbench.bench.tables.budget.own import Own, own
from normalbench.bench.tables.budget.solve import Placed, Problem, Rules, Solution, enough_bytes, finalists, solved
from normalbench.bench.tables.budget.table import TABLE, BudgetOptions
from normalbench.bench.tables.budget.written import layout_of
from normalbench.bench.tables.vectors import measure as vectors
from normalbench.bench.tables.vectors.paths import Paths
from normalbench.encodings.catalogue import CURVE_ENCODINGS, MOTION_ENCODINGS
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.storages.rules import by_rule
from normalbench.encodings.storages.storage import STORAGES, TARGET_FORMATS
from normalbench.gbuffer.layouts.layout import DIFFUSE_F0
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import all_placed

DEFAULT = attributes_held(BudgetOptions().hold, BudgetOptions().speed)


# As `budget` asks where nobody says otherwise.
USUAL = Rules(
    16,
    6,
    together=(frozenset({"shading_model", "flags"}),),
    apart=frozenset({"motion"}),
    read=frozenset({"normal", "roughness"}),
)


def falling(seed: int = 0, attributes=DEFAULT, classes: int = 2) -> dict:
    """Return errors that fall by 6 dB per bit of each number, from a different start for each attribute and class."""
    rng = np.random.default_rng(seed)
    errors = {}
    for attr in attributes:
        starts = 10 ** rng.uniform(-1, 1, classes)
        for code in attr.codes:
            if code.trip is not None:
                error = 4.0 ** (-code.total_bits / len(code.bits))
                errors[attr.name, code.name] = {f"class {i}": float(start * error) for i, start in enumerate(starts)}
    return errors


def problem(rules: Rules, attributes=DEFAULT, errors=None, bins=None) -> Problem:
    known = falling(attributes=attributes) if errors is None else errors
    names = sorted({name for by_class in known.values() for name in by_class})
    return Problem(attributes, known, names, list(BINS.values()) if bins is None else bins, rules)


def by_target(found) -> dict:
    lying = {}
    for placed in found.placed:
        lying.setdefault((placed.bin.name, placed.copy), []).append(placed)
    return lying


@pytest.mark.parametrize("limit", [12, 14, 16, 20, 24])
def test_a_layout_holds_everything_within_its_bytes_and_channels(limit):
    """Each attribute is placed once, within the byte limit, and the renderer's layout reader agrees."""
    solution = solved(problem(replace(USUAL, bytes=limit)))
    assert solution is not None
    for name, lying in by_target(solution).items():
        assert len(lying) == 1 or "motion" not in {placed.code.attribute for placed in lying}, f"motion shares {name}"
    assert sorted(placed.code.attribute for placed in solution.placed) == sorted(wanted.name for wanted in DEFAULT)
    layout = layout_of("mine", solution)
    assert layout.bytes_per_pixel <= limit and len(layout.targets) <= 6
    bits = {code.attribute: code for attribute in DEFAULT for code in attribute.codes[:1]}
    kept = {word.component: word.bits or layout.targets[word.target].storage.bits[word.first] for word in layout.words}
    assert (
        kept["shading_model"] >= bits["shading_model"].total_bits and kept["motion.x"] == 16 and kept["normal.x"] >= 10
    )
    # All bits of a code are there, and nothing else's.
    for one in solution.placed:
        for word, size in zip(one.code.words, one.code.bits, strict=True):
            component = word.partition("(")[2].rstrip(")") or word
            assert component.startswith("other") or kept[component] >= size, one.code


def test_decal_attributes_have_their_own_targets_with_alpha_unused():
    blended = frozenset({"normal", "base_color", "roughness"})
    solution = solved(problem(Rules(24, 6, blended=blended)))
    assert solution is not None
    for (_, _), lying in by_target(solution).items():
        names = {placed.code.attribute for placed in lying}
        if names & blended:
            assert names <= blended, f"{names} share a target that decals blend into"
            target = lying[0].bin
            assert target.blends and not target.fields and all(p.code.blends for p in lying)
            channels = TARGET_FORMATS[target.format].channels
            assert sum(len(p.code.bits) for p in lying) < channels or channels < 4, (
                "the factor's channel holds a number"
            )


def test_without_fields_every_number_has_its_own_channel():
    """No target is an integer target either."""
    plain = [replace(home, shares=False) for home in BINS.values() if not home.fields]
    solution = solved(problem(replace(USUAL, bytes=24), bins=plain))
    assert solution is not None
    layout = layout_of("mine", solution)
    assert not any(word.bits for word in layout.words), layout.summary
    assert not any(target.storage.is_integer for target in layout.targets)


def test_number_next_to_unused_colour_channels_is_in_the_fourth_channel():
    code = next(code for code in held.SEEN["ao"].codes if code.bits == (8,))
    normal = next(code for code in held.SEEN["normal"].codes if code.name == "octahedral 16:16")
    placed = (Placed(normal, BINS["rg16"], 0), Placed(code, BINS["srgb8_a8"], 0))
    layout = layout_of("mine", Solution(placed, {}))
    (word,) = [word for word in layout.words if word.component == "ao"]
    assert word.first == 3


@pytest.mark.parametrize("limit", [12, 14, 16, 20])
def test_attributes_that_are_read_alone_share_small_targets(limit):
    """Normal and roughness take at most 8 bytes without a colour; shading model and flags share a target."""
    best = solved(problem(replace(USUAL, bytes=limit)))
    assert best is not None
    homes = [lying for lying in by_target(best).values() if {"normal", "roughness"} & {p.code.attribute for p in lying}]
    assert sum(lying[0].bin.bytes for lying in homes) <= 8
    assert not {"base_color", "motion"} & {p.code.attribute for lying in homes for p in lying}
    (home,) = [lying for lying in by_target(best).values() if any(p.code.attribute == "shading_model" for p in lying)]
    assert "flags" in {p.code.attribute for p in home}


def test_webgpu_bytes_per_sample_follow_the_specification():
    """Costs and alignments follow the table of plain colour formats; the limit is 32 bytes per sample."""
    assert WEBGPU_BYTES == 32 and webgpu_cost(["rgba8"] * 4) == 32
    assert webgpu_cost(["r8", "r32_uint"]) == 8 and webgpu_cost(["r32_uint", "r8"]) == 5
    assert webgpu_cost(["rg16f", "r32_uint", "rgb10a2"]) == 16 and webgpu_cost(["rg16"]) is None
    bins = [home for home in BINS.values() if home.format in WEBGPU]
    solution = solved(problem(Rules(20, 6, webgpu=24), bins=bins))
    assert solution is not None
    cost = webgpu_cost([target.format for target in layout_of("mine", solution).targets])
    assert cost is not None and cost <= 24


def test_attributes_that_no_image_shows_keep_their_bits():
    """Shading model, flags, custom data and motion keep their bits even if another byte would improve the image."""
    hold = "normal,base_color,roughness,metallic,f0,ao,shading_model:4,flags:6,motion,custom:32,other:7"
    wanted = attributes_held(hold, 64.0)
    for limit in (18, 20, 24):
        solution = solved(problem(Rules(limit, 8), wanted))
        assert solution is not None
        sizes = {placed.code.attribute: placed.code.total_bits for placed in solution.placed}
        assert sizes["shading_model"] == 4 and sizes["flags"] == 6 and sizes["custom"] == 32 and sizes["other"] == 7
        assert sizes["motion"] == 32


@pytest.mark.parametrize(
    ("code", "codec"),
    [
        (held.HALF_MOTION, MotionCodec(MOTION_ENCODINGS["linear"], STORAGES["rg16f"])),
        (held.FAST_MOTION, MotionCodec(MOTION_ENCODINGS["linear"], by_rule("snorm", (16, 16)))),
        (held.ROOT_MOTION, MotionCodec(MOTION_ENCODINGS["sqrt"], by_rule("snorm", (14, 14)))),
    ],
    ids=lambda one: one.name,
)
def test_every_motion_encoding_keeps_the_minimum_precision(code, codec):
    """Zero motion is exact, and up to the code's maximum speed the error is below 1/16 pixel at 1920 x 1080."""
    speed = held.UP_TO_PIXELS[code]
    assert codec.encoding.name in code.name and code in held.motion(speed, code is held.ROOT_MOTION).codes
    case = vectors.MotionVectorCase(codec, "jax", 1.0, (0.05, 1.0, 16.0, speed), Paths(2**12, 0, (1920, 1080)))
    rows = vectors.measure(case)
    assert all(row["still_px"] == 0 for row in rows)
    worst = max(row["error_max_px"] for row in rows)
    assert worst < 1 / 16, f"{worst:.4f} px"


def test_motion_too_fast_for_half_floats_is_stored_in_integers():
    """At one pixel per frame above the limit, half floats and the square root in a word are refused."""
    assert [code.name for code in held.motion(64.0, True).codes] == ["linear in halves", "sqrt 14:14"]
    assert [code.name for code in held.motion(121.0, True).codes] == ["linear 16:16"]


def test_finalists_use_different_codes_of_equal_quality():
    """The first finalist is the proposal; no finalist is worse than the smallest error by more than 0.2 dB."""
    asked = problem(USUAL)
    solutions = finalists(asked, 3)
    codes = [frozenset(placed.key for placed in each.placed) for each in solutions]
    assert len(set(codes)) == 3 and codes[0] == frozenset(placed.key for placed in solved(asked).placed)
    worst = [each.worst_of(asked.classes) for each in solutions]
    assert max(worst) <= min(worst) * 10**0.0202, worst


def test_bytes_within_the_limit_are_used_only_if_they_gain_something():
    """If errors are visible, the smallest layout within half a decibel of the best is chosen; if an 8-bit display
    shows no error, the smallest of all."""
    scaled = [{key: {n: scale * e for n, e in of.items()} for key, of in falling().items()} for scale in (1e3, 1e-6)]
    large, small = scaled
    for limit in (12, 16, 20):

        def worst(size: int, limit: int = limit) -> float:
            asked = problem(replace(USUAL, bytes=min(size, limit)), errors=large)
            solution = solved(asked)
            return solution.worst_of(asked.classes) if solution else np.inf

        size, most = enough_bytes(problem(replace(USUAL, bytes=limit), errors=large)), worst(limit) * 10**0.05
        # What is solved is exact to a thousandth, and the plainest may be 0.2 dB worse.
        assert worst(size) <= most * 10**0.0202 < worst(size - 1) * 10**0.0202, (limit, size)
        assert enough_bytes(problem(replace(USUAL, bytes=limit), errors=small)) == 12
    assert enough_bytes(problem(replace(USUAL, bytes=8))) is None


def test_bits_that_the_worst_class_does_not_need_go_to_other_classes():
    """A code whose error shows in one class gets all bits that fit, even if that class is not the worst."""
    (metalness,) = (attribute for attribute in DEFAULT if attribute.name == "metallic")
    errors = falling() | {
        ("metallic", code.name): {"class 0": 0.0, "class 1": 1e-4 * 4.0**-code.total_bits} for code in metalness.codes
    }
    chosen = [placed.code for placed in solved(problem(USUAL, errors=errors)).placed]
    assert next(code for code in chosen if code.attribute == "metallic").total_bits > min(
        code.total_bits for code in metalness.codes
    )


def test_each_scene_judges_the_layouts_chosen_for_other_scenes():
    """Two scenes show different attributes; each is measured with the layout chosen for the other scene."""
    rates = falling()
    errors = {key: {"first mirror": of["class 0"], "second mirror": of["class 1"]} for key, of in rates.items()}
    for (name, _), of in errors.items():
        of["first mirror" if name == "normal" else "second mirror"] *= 1e-6
    judged = object.__new__(Judged)
    judged._question = SimpleNamespace(judging=("mirror",), most_instructions=None, rules=[USUAL])
    judged._errors, judged._together = errors, {}
    asked = Own(DEFAULT, [BINS[name] for name in ("rgba8", "rg16", "rg16f", "rgb10a2")], replace(USUAL, bytes=16))
    names = ("first mirror", "second mirror")

    def worst(judge: str, chosen: Sequence[str]) -> float:
        whole = Problem(judged._usual(DEFAULT), errors, chosen, asked.bins, asked.rules)
        return solved(whole).worst_of([judge])

    held_back = [worst(name, [other]) for name, other in zip(names, reversed(names), strict=True)]
    assert judged._held_back_db(asked) == pytest.approx(psnr_db(np.mean(held_back)))
    assert max(held_back) > 1.2 * max(worst(name, names) for name in names), "else nothing is held back"
    judged._errors = {key: {"first mirror": of["first mirror"]} for key, of in errors.items()}
    assert judged._held_back_db(asked) is None, "one scene"


def test_two_codes_that_are_worse_together_are_not_combined():
    """The prediction adds the joint error of two codes; 20 dB of joint error makes the solver replace one code."""
    asked = problem(USUAL)
    solution = solved(asked)
    pair = frozenset(part.key for part in solution.placed if part.code.attribute in ("normal", "roughness"))
    beyond = {name: 99 * solution.errors[name] for name in asked.classes}
    other = solved(replace(asked, together={pair: beyond}))
    assert not pair <= {part.key for part in other.placed}
    limited = {
        attribute: replace(known, codes=tuple(c for c in known.codes if c.key in pair))
        for attribute, known in ((a.name, a) for a in DEFAULT)
        if attribute in ("normal", "roughness")
    }
    forced = [limited.get(known.name, known) for known in DEFAULT]
    both = solved(replace(asked, attributes=forced, together={pair: beyond}))
    apart = sum(asked.error(placed.code, "class 0") for placed in both.placed)
    assert both.errors["class 0"] == pytest.approx(apart + beyond["class 0"])


# The whole layouts of metal/rough materials, which a proposal is compared with.
COMPARED = [layout for layout in LAYOUTS.values() if layout.is_whole and layout.reflects_by != DIFFUSE_F0]


@pytest.mark.parametrize("layout", COMPARED, ids=lambda one: one.name)
def test_a_proposal_holds_a_layouts_attributes_in_the_same_target_formats(layout):
    asked = own(layout, USUAL)
    codes = [code for attribute in asked.attributes for code in attribute.codes if code.trip]
    errors = {code.key: {"class": 4.0 ** -min(code.bits)} for code in codes}
    solution = solved(Problem(asked.attributes, errors, ["class"], asked.bins, asked.rules))
    assert solution is not None
    mine = layout_of("mine", solution)
    assert mine.bytes_per_pixel <= layout.bytes_per_pixel
    theirs = Counter(target.format.removesuffix("_snorm") for target in layout.targets)
    assert Counter(target.format for target in mine.targets) <= theirs
    # A power is another word for a roughness, and a light of four numbers for one of three.
    words = [{c for c in lay.components if c not in ("power", "emissive.a", "normal.z")} for lay in (mine, layout)]
    assert words[0] == words[1]
    others = [sum(bits_of(lay, word) for word in words_of(lay) if word.component == "other") for lay in (mine, layout)]
    assert others[0] >= others[1]


def words_of(layout):
    return [word for index, target in enumerate(layout.targets) for word in all_placed(layout.name, index, target)]


def bits_of(layout, word) -> int:
    return word.bits or layout.targets[word.target].storage.bits[word.first]


def test_codes_share_10_bit_channels():
    """A normal and a metallic value use 27 of 30 bits; the two alpha bits hold flags."""
    home = BINS["rgb10a2"]
    codes = {code.key: code for attribute in held.SEEN.values() for code in attribute.codes}
    flags = held.exact_bits("flags", "other", 2).codes[0]
    names = [("normal", "octahedral 11:11"), ("metallic", "linear 5")]
    layout = layout_of("mine", Solution(tuple(Placed(c, home, 0) for c in (*(codes[n] for n in names), flags)), {}))
    (target,) = layout.targets
    assert target.holds == "normal.x:11 normal.y:11 metallic:5 -:3 other"


@pytest.mark.parametrize("name", ["rg32_uint", "rgba32_uint", "rgba16_uint"])
def test_codes_share_the_channels_of_wide_targets(name):
    """Wide targets hold everything except motion; only in `rgba16_uint` may a number cross two channels."""
    bins = [BINS[f"{name}_fields"], BINS["rg16f"]]
    solution = solved(problem(replace(USUAL, bytes=20, together=(), read=frozenset()), bins=bins))
    assert solution is not None
    layout = layout_of("mine", solution)
    assert {target.format for target in layout.targets} == {name, "rg16f"}
    part = bins[0].part
    across = [w for w in layout.words if w.bits and w.first // part != (w.first + w.bits - 1) // part]
    assert not across or name == "rgba16_uint", across


def test_usual_reflectance_is_close_to_a_code():
    for code in held.SEEN["f0"].codes:
        curve, _, limit = code.words[0].partition("(")[0].partition(":")
        scale = 2 ** code.bits[0] - 1
        number = float(CURVE_ENCODINGS[curve].encode(np.float64(0.04), float(limit))) * scale
        assert abs(number - round(number)) < 2e-4 * scale, f"{code.name}: {number}"


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (
            ["--bytes", "8"],
            "8 bytes are too few: the attributes need 96 bits, and the smallest layout under these rules has 12 bytes. "
            "A layout fits without motion (not measured)",
        ),
        (
            ["--bytes", "12", "--hold", "normal,base_color,roughness,metallic,ao,emissive,motion"],
            "A layout fits with emissive in the light buffer (emissive:light)",
        ),
        (["--hold", "normal,base_color,roughness,metallic,f0,ao,id:17"], "takes 2 to 16 bits"),
        (["--read-alone", "normal,colour"], "--read-alone colour: not in --hold"),
        (["--formats", "rgba16", "--limit", "webgpu"], "--limit and --no-integers allow none of these"),
        (
            ["--formats", "rgba8"],
            "no target of these formats can hold motion (linear in halves); allow other --formats",
        ),
        (["--targets", "8"], "--targets"),
        (["--bytes", "0"], "--bytes"),
        (["--hold", "base_color,roughness"], "--hold: normal is missing; name for example normal,roughness"),
        (["--classes", "shiny"], "shiny"),
        (["--hold", "id:4,id:8"], "--hold: shading_model is named twice"),
        (["--hold", "colour"], f"--hold colour: unknown; known: {', '.join(KNOWN)}"),
        (["--hold", "id:65"], "--hold shading_model:65: shading_model takes 1 to 64 bits"),
        (["--blend", "tangent"], "--blend tangent: not in --hold"),
        (["--formats", "rgba7"], "rgba7"),
        (["--limit", "tile:17"], "--limit tile:17"),
        (
            ["--hold", f"{','.join(held.SEEN)},shading_model:stencil", "--readers", "shading_model"],
            "stored in the stencil, whose bytes",
        ),
        (["--limit", "webgpu", "--light", "rgba32f"], "WebGPU does not render to this format"),
        (["--scene", "room"], "room: no metallic-roughness materials"),
        (["--threshold", "7"], "--threshold"),
        (
            ["--size", "32x24"],
            "--size: no class of surfaces (mirror, glossy, rough, emissive) has at least 256 pixels in ramps",
        ),
    ],
)
@pytest.mark.usefixtures("gl")
def test_invalid_request_is_an_error_message(run, asked, said):
    usual = {"--scene": "ramps", "--size": "64x48"} | dict(zip(asked[::2], asked[1::2], strict=True))
    status, _, err = run("budget", *itertools.chain.from_iterable(usual.items()))
    assert status != 0 and said in err and "Traceback" not in err, err


def test_a_run_measures_a_budget_unless_it_names_scenes():
    """The default limits are 12 and 16 bytes. If scenes are named, the budget is measured only on request."""
    (usual,) = options_of(TABLE, {"count": 4096})
    assert TABLE in chosen_tables(("all",), {"count": 4096}) and usual.bytes == ("12", "16")
    assert TABLE not in chosen_tables(("all",), {"scene": ("room",)})
    assert chosen_tables(("budget",), {"scene": ("studio",)}) == [TABLE]


def test_the_chart_of_a_layout_has_all_bits_of_its_targets():
    text = (
        "rgba8: normal.x:10 normal.y:10 square_root(roughness):6 metallic:3 linear:0.09(f0):3; rg16f: motion.x motion.y"
    )
    row = TABLE.empty([]) | {"kind": "proposal", "targets": text, "layout": "budget_8", "contract_bytes": 8}
    (chart,) = charts([row])
    assert [(field["attribute"], field["x"], field["x2"]) for field in chart.rows] == [
        *(("normal", 0, 10), ("normal", 10, 20), ("roughness", 20, 26), ("metallic", 26, 29), ("f0", 29, 32)),
        *(("motion", 0, 16), ("motion", 16, 32)),
    ]
    assert chart.title == "8 bytes: motion 32 bits, normal 20 bits, roughness 6 bits, metallic 3 bits, f0 3 bits"
    assert list(charts([row | {"targets": "rgba8: of_another_version"}])) == []


def test_a_change_that_gains_nothing_is_not_suggested():
    """A layout with nearly the proposal's errors gets no suggestion; with a worse normal only the normal is named."""
    best = solved(problem(USUAL))
    assert best is not None
    errors = falling()
    mine = {part.code.attribute: errors[part.code.attribute, part.code.name] for part in best.placed if part.code.trip}

    def said(given):
        return changes.said(given, best, lambda *key: errors.get(key, {}), ["class 0", "class 1"])

    nearly = {name: {k: e * 1.001 for k, e in loss.items()} for name, loss in mine.items()}
    assert said(nearly).startswith("no encoding of a proposal"), said(nearly)
    worse = {name: {k: e * (64 if name == "normal" else 1.001) for k, e in loss.items()} for name, loss in mine.items()}
    assert "normal as" in said(worse) and "; then" not in said(worse), said(worse)
