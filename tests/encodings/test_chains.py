"""Chains: an encoding of the decoded result of another codec."""

import numpy as np
import pytest
from typed import codecs_named

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.quality.measure import round_trip
from normalbench.gbuffer.codecs.codec_passes import CodecPasses, encoding_defines
from normalbench.gbuffer.gl.shader import ShaderError

CHAIN = "octahedral/rgb8_12_12+xyz_renormalised"


def directions(count: int) -> np.ndarray:
    n = np.random.default_rng(7).normal(size=(count, 3))
    return (n / np.linalg.norm(n, axis=1, keepdims=True)).astype(np.float32)


def codec(name: str, storage: str = "rgba16f"):
    (named_codec,) = codecs_named(name, storage, "nearest")
    return named_codec


def test_a_chain_is_less_accurate_than_either_codec():
    """RTX Remix and Bevy pass octahedral 12:12 to a denoiser in half floats: the mean square errors add up."""
    n = directions(2**16)
    rms = [
        float(np.sqrt(np.mean(angles_deg(n, round_trip(one_codec, n, n)) ** 2)))
        for one_codec in (codec("octahedral", "rgb8_12_12"), codec("xyz_renormalised"), codec(CHAIN))
    ]
    assert rms[2] == pytest.approx(np.hypot(*rms[:2]), rel=0.02), rms


def test_both_languages_agree_on_a_chain(gl):
    n = directions(64 * 64)
    four = np.concatenate([n, np.zeros((len(n), 1), np.float32)], axis=1).reshape(64, 64, 4)
    chain = codec("octahedral/rg8+signed_octahedral", "rgb10a2")
    with CodecPasses(gl, chain) as passes:
        by_gl = passes.round_trip(four, four).normals.reshape(-1, 3)
    apart = angles_deg(by_gl, round_trip(chain, n, n))
    # A GPU's quotients are not rounded to nearest: a code in two hundred is the next one.
    assert np.mean(apart < 1e-3) > (0.995 if gl.is_software else 0.99), f"{np.mean(apart < 1e-3):.3%} the same"


def test_a_chain_cannot_be_drawn_into_a_gbuffer():
    with pytest.raises(ShaderError, match="a chain of codecs cannot be drawn into a G-buffer"):
        encoding_defines(codec(CHAIN).encoding)


@pytest.mark.parametrize(
    "word, said",
    [
        ("octahedral+xyz", "a chain is ENCODING/STORAGE+ENCODING"),
        ("octahedral/rg8+", "a chain is ENCODING/STORAGE+ENCODING"),
        ("octahedral/rg9+xyz", "unknown storage 'rg9'"),
        ("octahedron/rg8+xyz", "unknown encoding 'octahedron'"),
        ("octahedral/rg8+xyzw", "unknown encoding 'xyzw'"),
        ("xy_sign/rg8+xyz", "cannot be chained"),
        ("octahedral/rg8+per_pixel_view", "cannot be chained"),
        ("octahedral/all+xyz", "a chain has one codec and one encoding"),
    ],
)
def test_impossible_chain_is_a_one_line_error(word, said):
    with pytest.raises(UsageError) as caught:
        codecs_named(word, "rgba16f", "nearest")
    assert said in str(caught.value) and "\n" not in str(caught.value)


def test_the_first_codec_of_a_chain_must_fit():
    assert "RG8 has 2 channels" in (codec("xyz/rg8+octahedral").misfit or "")
