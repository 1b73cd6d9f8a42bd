"""`normalbench quality --rounding dithered`: the cost of noise, the same noise in both languages, and refused
requests."""

from dataclasses import replace

import pytest

from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.variants import in_half
from normalbench.encodings.storages.storage import STORAGES

COUNT = 2**16


def case(
    encoding: str, storage: str, rounding: str, backend: str = "jax", normals: str = "sphere"
) -> quality.QualityCase:
    codec = Codec(ENCODINGS[encoding], STORAGES[storage], rounding)
    assert codec.misfit is None
    return quality.QualityCase(codec, NORMAL_SETS[normals](COUNT, 0), backend)


@pytest.mark.parametrize("encoding, storage", [("octahedral", "rg8"), ("cube", "rgba8"), ("octahedral", "rg16_snorm")])
def test_noise_costs_a_bit(encoding, storage):
    """The squared error is a sixth of a squared step instead of a twelfth. The RMS angle grows by the root of 2, for
    which half a bit more in each of two numbers compensates."""
    dithered, nearest = (quality.measure(case(encoding, storage, rounding)) for rounding in ("dithered", "nearest"))
    assert dithered["angle_rms_deg"] / nearest["angle_rms_deg"] == pytest.approx(2**0.5, rel=0.01)
    assert nearest["effective_bits"] - dithered["effective_bits"] == pytest.approx(1, abs=0.03)
    assert dithered["angle_max_deg"] < 2.1 * nearest["angle_max_deg"]
    assert (dithered["rounding"], dithered["below_limit"]) == ("dithered", "")


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    "encoding, storage", [("octahedral", "rg8"), ("xy_sign", "rg8_snorm"), ("cube", "rgb8_10_10_3")]
)
def test_both_languages_add_the_same_noise(encoding, storage):
    rows = [quality.measure(case(encoding, storage, "dithered", backend)) for backend in ("jax", "glsl")]
    for name in ("angle_mean_deg", "angle_rms_deg", "psnr_db"):
        assert rows[0][name] == pytest.approx(rows[1][name], rel=1e-4), name
    jax, glsl = (
        quality.image_round_trip(case(encoding, storage, "dithered", backend, "playground"))
        for backend in ("jax", "glsl")
    )
    apart = abs(jax.encoded - glsl.encoded)[jax.covered]
    # A number on a tie goes either way.
    assert (apart > 1e-6).mean() < 1e-3 and apart.max() < 1.01 * STORAGES[storage].step(0)


def test_codecs_without_uniform_steps_of_their_own_are_not_dithered():
    octahedral, rg8 = ENCODINGS["octahedral"], STORAGES["rg8"]
    misfits = {
        "an index": Codec(ENCODINGS["spherical_fibonacci"], rg8, "dithered"),
        "float steps": Codec(octahedral, STORAGES["rg16f"], "dithered"),
        "only with rounding to nearest": Codec(ENCODINGS["octahedral_precise"], rg8, "dithered"),
        "float32": Codec(in_half(octahedral), rg8, "dithered"),
        "its code is an integer": Codec(replace(octahedral, packed_bits=32), rg8, "dithered"),
        "only to a single encoding in float32": Codec(
            replace(octahedral, before=Codec(octahedral, rg8)), rg8, "dithered"
        ),
    }
    for reason, codec in misfits.items():
        assert reason in str(codec.misfit) and "\n" not in str(codec.misfit), codec.misfit


@pytest.mark.parametrize(
    "asked, said",
    [
        (["--worst-case"], "--worst-case cannot be used with --rounding dithered"),
        (["--codes"], "--codes cannot be used with --rounding dithered"),
        (["--backend", "wgsl"], "--backend jax,glsl"),
        (["--storage", "rg16f", "--backend", "jax"], "use noise only with fixed point"),
    ],
)
def test_dithering_that_cannot_apply_is_a_one_line_error(run, asked, said):
    status, out, err = run("quality", "--encoding", "octahedral", "--rounding", "dithered", *asked)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err
