"""Angular errors of published and independently computed encodings are reproduced."""

import math

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.spatial import cKDTree

from normalbench.bench.subjects.normals.normal_sets import from_arrays, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.normals.tetrahedral import SIDE, UP
from normalbench.encodings.storages.rules import by_rule
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec2, Vec3, to_array

pytestmark = pytest.mark.usefixtures("rows_are_shared")


COUNT = 1_000_000


# Mean, RMS and supremum of the angle in degrees, uniform directions, computed in float64 with a search for the worst
# case. Octahedral 8:8 and xyz SNORM8 also stand in Cigolle et al., JCGT 3(2), 2014 (0.33709 and 0.17015).
FIGURES = [
    ("octahedral", "rg8_snorm", "nearest", "sphere", 0.336890, 0.371170, 0.956992),
    ("octahedral", "rg8", "nearest", "sphere", 0.335610, 0.369824, 0.953181),
    ("octahedral", "rg8", "truncate", "sphere", 0.671067, 0.739498, 1.906265),
    ("spherical", "rg8", "nearest", "sphere", 0.372156, 0.461192, 5.075859),
    ("spheremap", "rg8", "nearest", "hemisphere", 0.352483, 0.379227, 0.899604),
    # In float32 only the n / p form keeps to the supremum near -z; the Lambert form has a test of its own.
    ("spheremap_classic", "rg8", "nearest", "sphere", 0.492355, 0.719445, 11.918),
    ("stereographic", "rg8", "nearest", "hemisphere", 0.458578, 0.498289, 1.129611),
    ("xy", "rg8", "nearest", "hemisphere", 0.467529, 0.778805, 5.959707),
    ("xyz_renormalised", "rgba8_snorm", "nearest", "sphere", 0.170119, 0.184113, 0.390376),
    # With the table of 1024 x 1024; the nearest of all codes has 0.027989 and 0.034788. The axes are the worst.
    ("best_fit", "rgba8", "nearest", "sphere", 0.031262, 0.038016, 0.317755),
    ("octahedral", "rgb8_12_12_snorm", "nearest", "sphere", 0.020896, 0.023026, 0.059374),
    ("octahedral", "rg16_snorm", "nearest", "sphere", 0.001306, 0.001439, 0.003709),
    ("octahedral", "rg16f", "nearest", "sphere", 0.014993, 0.017636, 0.059345),
]


@pytest.mark.parametrize("encoding, storage, rounding, normals, mean, rms, sup", FIGURES[:4])
def test_the_reference_figures_are_reproduced(normalbench, encoding, storage, rounding, normals, mean, rms, sup):
    """Means within 0.2%, RMS within 0.5%, suprema within 0.1%; the largest of a million samples is slightly below the
    supremum."""
    how = {"encoding": encoding, "storage": storage, "rounding": rounding, "normals": normals}
    row = normalbench.quality(**how, count=COUNT, worst_case=True)
    assert row["count"] == COUNT
    at_least = {"angle_mean_deg": mean * 0.998, "angle_rms_deg": rms * 0.995, "angle_sup_deg": sup * 0.999}
    at_least["angle_max_deg"] = sup * 0.9
    at_most = {"angle_mean_deg": mean * 1.002, "angle_rms_deg": rms * 1.005, "angle_sup_deg": sup * 1.001}
    # At 16 bits float32's own rounding of input and decode adds up to 1e-5 degrees.
    at_most["angle_max_deg"] = row["angle_sup_deg"] * 1.0001 + 1e-5
    row.assert_that(**{column: f"at least {least}" for column, least in at_least.items()})
    row.assert_that(**{column: f"at most {most}" for column, most in at_most.items()})


def test_the_lambert_spheremap_loses_the_far_pole_in_float32(normalbench):
    """As published, 8 z + 8 cancels: mean and RMS stay, but normals 3e-4 rad from -z turn by tens of degrees."""
    row = normalbench.quality(encoding="spheremap", storage="rg8", normals="sphere", count=COUNT)
    assert row["angle_mean_deg"] == pytest.approx(0.492355, rel=0.005)
    assert row["angle_rms_deg"] == pytest.approx(0.719445, rel=0.01)
    around = np.linspace(0, 2 * np.pi, 1000)
    n = np.stack([3e-4 * np.cos(around), 3e-4 * np.sin(around), np.full(1000, -math.sqrt(1 - 9e-8))], axis=1)
    near_pole = from_arrays("", "", n, n, np.ones(1000, bool))
    largest = {
        name: quality.measure(quality.QualityCase(Codec(ENCODINGS[name], STORAGES["rgba32f"]), near_pole, "jax"))[
            "angle_max_deg"
        ]
        for name in ("spheremap", "spheremap_classic", "cryengine3")
    }
    assert 10 < largest["spheremap"] < 100 and max(largest["spheremap_classic"], largest["cryengine3"]) < 0.2, largest


def test_the_theoretical_bound_has_all_effective_bits():
    """65536 codes at the hexagonal bound, RMS 0.31773 degrees, are worth 16 bits."""
    from normalbench.bench.measures.metrics.code_limits import effective_bits

    assert effective_bits(0.31773, 4 * math.pi) == pytest.approx(16, abs=1e-4)


def test_unorm8_cannot_hold_an_axis_and_snorm8_can(normalbench):
    """For floors and walls octahedral UNORM8 is 0.32 degrees off, and SNORM8 is at most 1e-4 degrees off."""
    largest = {storage: normalbench.quality(storage=storage, normals="axes") for storage in ("rg8", "rg8_snorm")}
    # The nearest code to the centre is (1/255, 1/255), which is the direction (1, 1, 253) / 255.
    assert largest["rg8"]["angle_max_deg"] == pytest.approx(math.degrees(math.atan(math.sqrt(2) / 253)), abs=1e-4)
    largest["rg8_snorm"].assert_that(angle_max_deg="at most 1e-4")


def test_lattices_are_as_accurate_as_published(normalbench):
    """2^16 codes: the Fibonacci lattice's mean; the rings' largest error, which is their covering radius."""
    fibonacci, rings = (
        normalbench.quality(encoding=name, storage="rg8", normals="sphere", backend="jax", count=COUNT)
        for name in ("spherical_fibonacci", "optimised_rings")
    )
    fibonacci.assert_that(angle_mean_deg="at most 0.3042")
    fibonacci.assert_that(angle_mean_deg="at least 0.3017")
    rings.assert_that(angle_max_deg="at most 0.5625")
    rings.assert_that(angle_max_deg="at least 0.5596")


def test_the_fibonacci_lattice_finds_the_nearest_point():
    """A tree of all 2^16 points finds no nearer point for 2^16 directions, beyond float32's rounding."""
    encoding = ENCODINGS["spherical_fibonacci"]
    index = jnp.arange(2**16, dtype=jnp.float32)
    codes = Vec2(*(number * (2 / 255) - 1 for number in (jnp.floor(index / 256), index % 256)))
    n = jax.tree.map(lambda plane: plane[: 2**16], sphere(2**16).chunk(0).n)
    decoded = jax.jit(lambda n: encoding.decode(encoding.encode(n, n), n))(n)
    lattice, given, nearest = (np.asarray(to_array(v), np.float64) for v in (encoding.decode(codes, n), n, decoded))
    nearer = np.linalg.norm(nearest - given, axis=1) - cKDTree(lattice).query(given)[0]
    assert nearer.max() < 1e-6, f"{given[nearer.argmax()]} has a point nearer by {nearer.max():.2g}"


def test_the_faces_of_a_tetrahedron_are_as_far_apart_as_possible():
    """Any two of the face normals, (+-SIDE, 0, UP) and (0, +-SIDE, -UP), have the cosine -1/3."""
    faces = np.array([(SIDE, 0, UP), (-SIDE, 0, UP), (0, SIDE, -UP), (0, -SIDE, -UP)])
    np.testing.assert_allclose(faces @ faces.T, np.full((4, 4), -1 / 3) + np.eye(4) * 4 / 3, atol=1e-15)


def test_no_normal_is_farther_from_its_tetrahedrons_face_than_a_corner():
    """The angle between a face and its corners has the cosine 1/3: a disk of radius sqrt(8)/3."""
    n = sphere(2**16).chunk(0).n
    code = ENCODINGS["tetrahedral"].encode(n, n)
    assert np.hypot(code.x, code.y).max() == pytest.approx(math.sqrt(8) / 3, abs=1e-3)


def test_twelve_truncated_bits_match_figures_computed_by_hand(normalbench):
    """floor(f 4095) doubles the mean error of octahedral 12:12; floor(f 4095.5) raises it by 39%."""
    mean = {
        rounding: normalbench.quality(
            encoding="octahedral", storage="rgb8_12_12", rounding=rounding, normals="sphere", backend="jax", count=2**20
        )["angle_mean_deg"]
        for rounding in ("nearest", "truncate", "truncate_half")
    }
    assert mean["truncate"] / mean["nearest"] == pytest.approx(2, rel=0.005), mean
    assert mean["truncate_half"] / mean["nearest"] == pytest.approx(1.39, rel=0.01), mean


@pytest.mark.parametrize("kind", ["unorm", "snorm"])
@pytest.mark.parametrize("bits", range(2, 17))
def test_octahedral_at_any_bit_count_is_as_accurate_as_in_float64(kind, bits):
    """The mean angle over 2^16 normals is within half a percent of that of a separate NumPy version in float64."""
    n = np.random.default_rng(0).normal(size=(2**16, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    scale = 2 ** (bits - (kind == "snorm")) - 1
    flat = n[:, :2] / np.abs(n).sum(axis=1, keepdims=True)
    folded = np.where(n[:, 2:] < 0, (1 - np.abs(flat[:, ::-1])) * np.where(flat < 0, -1, 1), flat)
    code = np.round(folded * scale) / scale if kind == "snorm" else np.round((folded / 2 + 0.5) * scale) / scale * 2 - 1
    z = 1 - np.abs(code).sum(axis=1)
    xy = np.where(z[:, None] < 0, (1 - np.abs(code[:, ::-1])) * np.where(code < 0, -1, 1), code)
    back = np.concatenate([xy, z[:, None]], axis=1)
    right = np.arctan2(np.linalg.norm(np.cross(n, back), axis=1), np.sum(n * back, axis=1)).mean()
    codec = Codec(ENCODINGS["octahedral"], by_rule(kind, (bits, bits)))
    planes = Vec3(*(np.float32(n[:, axis]) for axis in range(3)))
    decoded = np.stack([np.asarray(c, np.float64) for c in codec.round_trip(planes, planes)], axis=1)
    angle = np.arctan2(np.linalg.norm(np.cross(n, decoded), axis=1), np.sum(n * decoded, axis=1)).mean()
    assert angle == pytest.approx(right, rel=0.005), f"{np.degrees(angle):.5f} degrees, not {np.degrees(right):.5f}"
