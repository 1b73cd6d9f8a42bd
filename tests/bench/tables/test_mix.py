"""`normalbench mix`: the effect of filters, mip levels, resolves and blending on stored codes."""

import numpy as np
import pytest
from typed import codecs_named

from normalbench.bench.run.measuring import Nothing, asked, measured
from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS
from normalbench.bench.tables.mix import reference, worst
from normalbench.bench.tables.mix.measure import MixCase, Modelled, measure
from normalbench.bench.tables.mix.model import MODEL, Texels, Way
from normalbench.bench.tables.mix.patches import TEXELS, mixes_of, patches_of
from normalbench.bench.tables.mix.table import MOST_ADDED, OPERATIONS
from normalbench.bench.tables.mix.verdict import judged
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.codecs.mixing.passes import MixPasses, bands

COUNT, SAMPLES = 512, 4


def codec(name: str):
    (named_codec,) = codecs_named(*name.split("/"), "nearest")
    return named_codec


def mixes(normals: str = "axes", angle: float = 5.0, count: int = COUNT):
    (patches,) = patches_of(NORMAL_SETS[normals](count, 0), (angle,), count, 0)
    return mixes_of(patches, SAMPLES)


def rows_of(name: str, backend: str = "jax", operations=tuple(OPERATIONS), **given):
    return {row["operation"]: row for row in measure(MixCase(codec(name), mixes(**given), backend, operations, 64.0))}


def angle_deg(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)))


@pytest.fixture(scope="module")
def rows(gl):  # noqa: ARG001 # it skips where there is no device
    """Rows of every operation on three encodings near the axes, from both backends."""
    table = TABLES["mix"]
    options = {"encoding": "octahedral,spherical,xyz_renormalised", "normals": "axes", "angle": "5", "edge": "none"}
    options |= {"count": COUNT}
    return measured(asked(table, table.options(**options), table.outputs()), Nothing()).rows


@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_unquantised_xyz_interpolates_with_the_error_of_geometry(backend, request):
    """Normals theta apart give atan2(t sin theta, 1 - t + t cos theta), and the length of `lerp_length`."""
    given, exact = mixes("sphere", 20.0), codec("xyz/rgba32f")
    if backend == "jax":
        model = Modelled(exact, given)
        mixed = model.decoded(model.mixed("blend", model.given(model.texels()), MODEL))
    else:
        with MixPasses(request.getfixturevalue("gl"), exact, given.meetings(), SAMPLES) as passes:
            mixed = passes.blended(given.meetings().seconds).normals.reshape(-1, 3)
    first, second = given.patches.normals[:2]
    theta, t = np.radians(angle_deg(first, second)), given.alphas
    apart = np.radians(angle_deg(first, mixed)) - reference.lerp_angle(theta, t)
    longer = np.linalg.norm(mixed, axis=1) - reference.lerp_length(theta, t)
    assert np.abs(apart).max() < 1e-4 and np.abs(longer).max() < 1e-4, (np.abs(apart).max(), np.abs(longer).max())
    # It is not slerp, from which it differs by about t (1 - t) (1 - 2 t) theta^3 / 6.
    slerp = np.degrees(np.abs(reference.lerp_angle(theta, t) - t * theta))
    expected = np.degrees(np.abs(t * (1 - t) * (1 - 2 * t)) * theta**3 / 6)
    assert slerp == pytest.approx(expected, rel=0.05, abs=1e-9) and slerp.max() > 0.03, slerp.max()


def test_reoriented_normal_mapping_rotates_the_detail_with_the_base():
    """A flat detail gives the base, a flat base gives the detail, and a partly tilted detail is on the arc."""
    random = np.random.default_rng(0)
    base = reference.unit_rows(random.normal(size=(1000, 3)))
    tilt, turn, alpha = random.uniform(0, 1, 1000), random.uniform(0, 6, 1000), random.uniform(0, 1, 1000)
    flat, detail = np.broadcast_to([0.0, 0.0, 1.0], base.shape), reference.tilted(tilt, turn)
    assert np.abs(reference.reoriented(base, flat) - base).max() < 1e-9
    assert np.abs(reference.reoriented(flat, detail) - detail).max() < 1e-12
    whole, part = (reference.reoriented(base, reference.tilted(a * tilt, turn)) for a in (np.ones(1000), alpha))
    sines = (np.sin((1 - alpha) * tilt) / np.sin(tilt), np.sin(alpha * tilt) / np.sin(tilt))
    slerp = base * sines[0][:, None] + whole * sines[1][:, None]
    assert np.abs(part - slerp).max() < 1e-9, np.abs(part - slerp).max()
    behind = reference.reoriented(np.array([[0.0, 0.0, -1.0]]), detail[:1])
    assert angle_deg(behind, np.array([[0.0, 0.0, -1.0]]))[0] == pytest.approx(np.degrees(tilt[0]))


def test_specular_power_matches_toksvigs_formula():
    """s' = f s with f = |n| / (|n| + s (1 - |n|)), by hand: 32 / 32.5 for s = 64 and a mean of length one half."""
    lengths = np.array([1.0, 1.001, 0.5, 0.0])
    assert reference.toksvig_power(lengths, 64.0) == pytest.approx([64, 64, 64 * 0.5 / (0.5 + 32), 0])


def test_decoding_first_never_mixes_across_a_seam(rows):
    for row in rows:
        if row["operation"] in ("resolve_decoded", "blend_decoded", "upsample"):
            assert row["garbage_percent"] == 0 and row["angle_max_deg"] < 2 * row["alone_max_deg"] + 0.1, row


def test_a_fixed_point_filter_matches_the_float_filter_to_two_steps():
    """In the model, 8-bit fractions and rounded steps move a UNORM8 number by at most two steps."""
    given, model = mixes(), Modelled(codec("octahedral/rg8"), mixes())
    mixed = [model.mixed("filter", model.given(model.texels()), way) for way in (MODEL, Way(True, 8))]
    steps = np.abs(mixed[0] - mixed[1]).max() * 255 / 2
    assert 0.4 < steps < 2.0 and given.shares.max() < 1, steps


@pytest.mark.parametrize("name", [name for name, storage in STORAGES.items() if storage.channels < 4])
def test_texels_of_a_storage_round_trip(name):
    """This also holds for numbers that span channels."""
    chosen = codec(f"octahedral/{name}")
    model = Modelled(chosen, mixes("sphere", 5.0))
    stored = model.texels()
    texels = Texels(chosen)
    again = texels.code(texels.of(stored))
    assert np.abs(again - stored).max() < 1e-6, np.abs(again - stored).max()


def test_blends_of_1_and_0_are_the_source_and_the_base():
    """Both ways to mix agree to within a hundredth of a step."""
    texels, shape = Texels(codec("octahedral/rg8")), (2, 64)
    base, source = (np.random.default_rng(i).integers(0, 256, shape).astype(np.float32) / 255 for i in (0, 1))
    for way in (MODEL, Way(is_fixed=True, rounds_source=True)):
        for alpha, expected in ((1.0, source), (0.0, base)):
            got = texels.blended(base, source, np.full(64, alpha), way)
            assert np.abs(got - expected).max() * 255 < 0.01, (way, alpha)


def test_neighbours_in_a_patch_have_the_requested_angle():
    """Neighbours along the direction are `angle` apart; curvature brings other neighbours closer by its square."""
    given = mixes("sphere", 5.0).patches
    assert given.normals.shape == (TEXELS, 512, 3)
    across = angle_deg(given.normals[0], given.normals[1])
    assert across.min() > 4.9 and across.max() < 5.0001, (across.min(), across.max())


def test_hemisphere_encodings_are_mixed_on_their_hemisphere():
    row = rows_of("hemi_octahedral/rg16", normals="sphere")["filter"]
    assert 100 < row["count"] < COUNT and row["garbage_percent"] == 0, row["count"]


def test_rows_with_the_same_alpha_form_one_band():
    assert list(bands(np.array([0.1, 0.1, 0.2, 0.9]))) == [(0.1, 0, 2), (0.2, 2, 1), (0.9, 3, 1)]


def test_a_verdict_follows_from_the_thresholds():
    """Garbage, or an added error above the allowed share of the reach, means no. Missing operations do not count."""
    base = {"encoding": "e", "storage": "s", "backend": "jax", "normals": "sphere", "angle_deg": 5.0}
    base |= {f"worst_{name}": "(0, 0, 1)" for name in ("first", "second", "result")}
    base |= {
        "alone_max_deg": 0.5,
        "angle_max_deg": 1.0,
        "geometry_max_deg": 0.0,
        "reach_max_deg": 4.0,
        "edge_deg": None,
    }
    fine = [base | {"operation": name, "garbage_percent": 0.0} for name in ("blend", "detail", "resolve")]
    assert {(row["filterable"], row["blendable"], row["resolvable"]) for row in judged(fine)} == {(None, "yes", "yes")}
    garbage = [row | {"garbage_percent": 0.1} if row["operation"] == "blend" else row for row in fine]
    assert {(row["blendable"], row["resolvable"]) for row in judged(garbage)} == {("no", "yes")}
    for added, verdict in ((MOST_ADDED * 4 - 0.01, "yes"), (MOST_ADDED * 4 + 0.01, "no")):
        moved = [row | {"angle_max_deg": 1.0 + added} for row in fine]
        assert {row["resolvable"] for row in judged(moved)} == {verdict}
    wide = [row | {"angle_deg": 20.0, "garbage_percent": 9.0} for row in fine]
    assert {row["resolvable"] for row in judged(wide)} == {None}, "neighbours 20 degrees apart do not decide"
    across = [*fine, *(row | {"edge_deg": 60.0, "garbage_percent": 9.0} for row in fine)]
    assert {(row["resolvable"], row["resolvable_across"]) for row in judged(across)} == {("yes", "no")}
    own = [row | {"alone_max_deg": 6.0, "angle_max_deg": 12.0} for row in fine]
    assert {row["resolvable"] for row in judged(own)} == {"no"}, "a code's own error excuses nothing above 1 degree"


def test_an_edge_runs_through_the_mix_of_every_patch():
    """The first and second texels are on opposite sides, rotated apart by the angle about a tangent."""
    _, edges = patches_of(NORMAL_SETS["sphere"](COUNT, 0), (1.0,), COUNT, 0, (60.0,))
    first, second = edges.normals[:2]
    apart = angle_deg(first, second)
    assert edges.edge_deg == 60.0 and apart.min() > 58.9 and apart.max() < 61.1, (apart.min(), apart.max())


def test_the_page_has_a_chart_and_the_summary_has_the_verdicts(rows):
    work = TABLES["mix"].work
    (chart,) = work.charts(rows)
    assert list(chart.x.names) == [name.replace("_", " ") for name in OPERATIONS]
    assert len(chart.rows) == 3 * len(OPERATIONS)
    assert sum("%" in cell["said"] for cell in chart.rows) >= 8
    assert "of 3 codecs give no garbage" in chart.title
    (sheet,) = work.summary(rows)
    assert {line["encoding"]: line["filterable"] for line in sheet.rows}["octahedral"] == "no"
    assert any("octahedral/rgba8: normals 5 degrees apart on axes" in note for note in sheet.notes)


def test_a_gate_checks_the_share_of_garbage(run, tmp_path):
    gate = '[[gate]]\ntable = "mix"\nencoding = "{}"\nstorage = "rg16"\noperation = "resolve"\nnormals = "axes"\n'
    gate += 'angle = "5"\nedge = "none"\nbackend = "jax"\ncount = 256\ngarbage_percent = "at most 0"\n'
    path = tmp_path / "gates.toml"
    for name, expected in (("hemi_octahedral", 0), ("octahedral", 1)):
        path.write_text(gate.format(name))
        status, out, err = run("check", str(path))
        assert status == expected, out + err


def test_a_detail_at_another_alpha_is_on_the_arc():
    """The result equals reoriented normal mapping with the scaled tilt."""
    given = mixes("sphere", 5.0, 64)
    details = worst._between(given.patches.normals[0], given.decals, given.alphas)
    assert np.abs(details - given.details).max() < 1e-6


def test_only_weights_change_if_the_normals_are_given():
    """An axis stays in the first four texels of each patch of `axes`."""
    given = mixes("axes", 5.0, 64)
    moved = worst._moved(given, np.full(len(given.alphas), 5.0), np.random.default_rng(0))
    assert np.allclose(moved.patches.normals, given.patches.normals, atol=1e-7)
    assert not np.allclose(moved.shares, given.shares)
    given = mixes("sphere", 5.0, 64)
    moved = worst._moved(given, np.full(len(given.alphas), 5.0), np.random.default_rng(0))
    a, b = given.patches.normals, moved.patches.normals
    assert np.allclose(np.sum(a[0] * a[15], axis=1), np.sum(b[0] * b[15], axis=1), atol=1e-6), "as far apart as before"
    assert np.abs(a - b).max() > 0.05


def test_rows_have_the_columns_of_the_table(rows):
    assert all(tuple(row) == tuple(TABLES["mix"].empty()) for row in rows)
    assert len(rows) == 3 * 2 * len(OPERATIONS) and len({TABLES["mix"].name_of(row) for row in rows}) == len(rows)


@pytest.mark.parametrize(
    "words, said",
    [
        (("--angle", "0"), "--angle 0: expected numbers from 0.01 to 60"),
        (("--angle", "5,far"), "--angle 5,far: expected numbers from 0.01 to 60"),
        (("--samples", "1"), "--samples 1: out of range; use 2 to 64"),
        (("--count", "0"), "--count 0: out of range; use 1 to 65536"),
        (("--power", "0"), "--power 0: out of range; use 1 to 65536"),
        (("--operation", "blur"), "unknown operation 'blur'; known: all, filter"),
        (("--backend", "cuda"), "unknown backend 'cuda'"),
        (("--normals", "cube"), "unknown normal set 'cube'"),
        (("--encoding", "xyz", "--storage", "rg8"), "xyz/rg8: 3 components, but RG8 has 2 channels"),
        (("--plot", "mix.txt"), "mix.txt: unsupported plot format; use one of .png, .svg, .pdf"),
    ],
)
def test_bad_input_is_a_one_line_error(run, words, said):
    status, out, err = run("mix", *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err


def test_unknown_use_is_a_one_line_error_in_pick(run):
    status, out, err = run("pick", "--needs", "swim")
    assert (status, out) == (2, "") and "unknown use 'swim'; known: all, filter, blend, resolve, upsample" in err, err


def test_an_image_without_a_covered_square_is_an_error(run, tmp_path):
    """An image of 3 x 3 pixels is too small for a patch."""
    flat = np.zeros((3, 3, 3), np.float32)
    flat[..., 2] = 1.0
    np.save(tmp_path / "small.npy", flat)
    status, out, err = run("mix", "--normals", str(tmp_path / "small.npy"), "--backend", "jax")
    assert (status, out) == (2, "") and "no square of 4 x 4 pixels is covered" in err, err


def test_a_set_of_few_normals_is_mixed_evenly_and_with_every_alpha():
    """Each of the six axes gets about the same number of patches, and every alpha of a blend."""
    given = mixes("axes", 1.0, 1024)
    centre = given.patches.normals[:4].mean(axis=0)
    axis = np.argmax(np.concatenate([centre, -centre], axis=1), axis=1)
    counts = np.bincount(axis, minlength=6)
    assert counts.min() >= 160 and counts.max() <= 180, counts
    assert all(len(set(given.alphas[axis == side])) == 9 for side in range(6))
