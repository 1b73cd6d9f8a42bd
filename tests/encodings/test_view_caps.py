"""Encodings of normals up to an angle from the line of sight: the gain, and the normals outside."""

import jax
import numpy as np
import pytest

from normalbench.bench.subjects.normals.domains import view_angles
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.shared.view_frame import view_frame
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec3, dot, to_array

NAMES = ("view_octahedral", "view_equal_area")
COUNT = 2**17


def directions(seed: int) -> np.ndarray:
    v = np.random.default_rng(seed).normal(size=(COUNT, 3))
    return (v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32)


N, VIEW = directions(1), directions(2)
ANGLES = view_angles(N.astype(np.float64), VIEW.astype(np.float64))


def planes(v: np.ndarray) -> Vec3:
    return Vec3(*v.T)


def decoded(trip) -> np.ndarray:
    d = np.asarray(to_array(jax.jit(trip)(planes(N), planes(VIEW))), np.float64)
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def unrounded(encoding) -> np.ndarray:
    return decoded(lambda n, view: encoding.decode(encoding.encode(n, view), view))


def rms_deg(encoding, held: np.ndarray) -> float:
    apart = np.linalg.norm(decoded(Codec(encoding, STORAGES["rg8"]).round_trip) - N, axis=1)[held]
    return float(np.degrees(np.sqrt(np.mean((2 * np.arcsin(apart / 2)) ** 2))))


@pytest.mark.parametrize("cap", [90.0, 100.0, 150.0])
@pytest.mark.parametrize("name", NAMES)
def test_normals_inside_the_cap_round_trip_and_others_go_to_its_rim(name, cap):
    encoding = ENCODINGS[name].with_parameters({"cap": cap})
    back, held = unrounded(encoding), cap >= ANGLES
    assert np.abs(back - N)[held].max() < 1e-5
    # The foot of the pyramid is a square, whose corners lie on the rim.
    rim = view_angles(back[~held], VIEW[~held].astype(np.float64))
    assert np.all(rim > cap - 0.01), rim.min()
    if name == "view_equal_area":
        assert np.abs(rim - cap).max() < 0.01


def test_a_90_degree_cap_is_hemi_octahedral_in_the_per_pixel_frame():
    encoding = ENCODINGS["view_octahedral"].with_parameters({"cap": 90.0})
    facing = ANGLES < 90.0
    x, y, z = view_frame(planes(VIEW))
    n = planes(N)
    turned = ENCODINGS["hemi_octahedral"].encode(Vec3(dot(x, n), dot(y, n), dot(z, n)), planes(VIEW))
    code = encoding.encode(n, planes(VIEW))
    assert np.abs(np.asarray(to_array(code)) - np.asarray(to_array(turned)))[facing].max() < 1e-6


def test_a_cap_has_codes_in_proportion_to_its_area():
    """Uniform normals on a cap are uniform on the square, whose steps gain 10 log10(2 / (1 - cos c)) less their
    stretch."""
    whole = rms_deg(ENCODINGS["equal_area_octahedral"], ANGLES <= 180.0)
    for cap in (90.0, 100.0):
        encoding, held = ENCODINGS["view_equal_area"].with_parameters({"cap": cap}), cap >= ANGLES
        code = np.asarray(to_array(encoding.encode(planes(N), planes(VIEW))))[held]
        cells, _, _ = np.histogram2d(*code.T, bins=16, range=((-1, 1), (-1, 1)))
        mean = held.sum() / cells.size
        assert np.abs(cells - mean).max() < 5 * np.sqrt(mean)
        gain, area = 20 * np.log10(whole / rms_deg(encoding, held)), 10 * np.log10(2 / (1 - np.cos(np.radians(cap))))
        assert area - 0.3 < gain < area + 0.05, cap
