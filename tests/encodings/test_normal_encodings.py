"""Normal encodings: both backends have the same errors, and every direction comes back."""

import numpy as np
import pytest
from directions import NOT_DIRECTIONS, hard_directions, view_positions
from parity.comparison import planes
from parity.normals import codecs

from normalbench.bench.subjects.normals.normal_sets import playground, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings import vec
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


def params(*given, **named) -> list:
    return [pytest.param(codec, id=codec.name) for codec in codecs(*given, **named)]


@pytest.mark.parametrize("where", ["rgb10a2", "rgba8_snorm", "rgba16f", "rgba16_snorm", "r11g11b10f"])
@pytest.mark.parametrize("name", ["spherical_fibonacci", "signed_octahedral"])
def test_a_number_with_few_values_uses_the_nearest_numbers_of_its_storage(name, where):
    """If two numbers are equally near, the lower is used."""
    codec = Codec(ENCODINGS[name], STORAGES[where])
    few = [i for i in range(codec.encoding.components) if codec.encoding.levels_of(i)]
    assert few
    for component in few:
        every = codec.storage.numbers(component)
        wanted = np.linspace(-1, 1, codec.encoding.levels_of(component))
        expected = [every[np.abs(every - number).argmin()] for number in wanted]
        np.testing.assert_array_equal(codec.numbers(component), expected)


# A storage of each kind, and a rounding other than the usual one; the rest at night.
KINDS = [
    *params(["rgba8", "rg16f", "r11g11b10f", "rgb8_12_12"], names=["octahedral"]),
    *params(["rgba8"], ["truncate"], names=["octahedral"]),
]


@pytest.mark.parametrize("codec", KINDS)
@pytest.mark.usefixtures("gl")
def test_both_backends_give_the_same_psnr(codec):
    for normals in (sphere(2**17), playground()):
        by_jax, by_gl = (
            quality.measure(quality.QualityCase(codec, normals, backend))["psnr_db"] for backend in ("jax", "glsl")
        )
        assert abs(by_jax - by_gl) <= 0.02, f"{codec.name} on {normals.name}: JAX {by_jax} dB, GLSL {by_gl} dB"


@pytest.mark.parametrize("storage", ["rgba8", "rgba32f"])
@pytest.mark.parametrize("name", sorted(ENCODINGS))
def test_every_direction_comes_back_finite(name, storage):
    codec = Codec(ENCODINGS[name], STORAGES[storage])
    n = np.concatenate([hard_directions(), NOT_DIRECTIONS])
    decoded = np.asarray(vec.to_array(codec.round_trip(vec.from_array(n), planes(vec.Vec3, view_positions(len(n))))))
    bad = ~np.isfinite(decoded).all(axis=1)
    assert not bad.any(), f"{codec.name}: {n[bad][0]!r} comes back as {decoded[bad][0]!r}"
