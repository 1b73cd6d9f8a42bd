"""Encodings with another axis or sign: the same encoding about other axes, in both languages."""

import numpy as np
import pytest

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.codecs.tuned_names import tuned
from normalbench.bench.tables.quality.measure import round_trip
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.variants import variant
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import from_array

TURNS = [{"axis": "x"}, {"axis": "y"}, {"sign": "-1"}, {"axis": "y", "sign": "-1"}]


CAN_TURN = [name for name, encoding in ENCODINGS.items() if encoding.can_turn and not encoding.is_precise]


# The pole, where the square's centre is.
POLES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}


def directions(count: int = 4096) -> np.ndarray:
    n = np.random.default_rng(3).normal(size=(count, 3))
    return (n / np.linalg.norm(n, axis=1, keepdims=True)).astype(np.float32)


@pytest.mark.parametrize("values", TURNS, ids=str)
@pytest.mark.parametrize("name", ["octahedral", "spheremap"])
def test_the_pole_of_the_encoding_is_the_requested_axis(name, values):
    """The code 0, 0 is the axis, or its opposite."""
    pole = np.array(POLES[values.get("axis", "z")], np.float32) * float(values.get("sign", "1"))
    encoding = variant(ENCODINGS[name], values)
    code = encoding.encode(from_array(pole[None]), from_array(pole[None]))
    assert np.abs(np.stack(code)).max() < 1e-6, f"the code of {pole} is {code}"


@pytest.mark.parametrize("name", CAN_TURN)
def test_a_turned_encoding_is_equally_accurate_on_the_sphere(name):
    """Except for sampling, the error of uniform directions does not depend on the axis."""
    n = directions(2**15)
    rms = []
    for encoding in (ENCODINGS[name], variant(ENCODINGS[name], {"axis": "x", "sign": "-1"})):
        storage = STORAGES["rgba8"] if encoding.components == 3 else STORAGES["rg8"]
        codec = Codec(encoding, storage)
        if codec.misfit:
            codec = Codec(encoding, STORAGES["rgb8_10_10_2"])
        rms.append(float(np.sqrt(np.mean(angles_deg(n, round_trip(codec, n, n)) ** 2))))
    assert rms[1] == pytest.approx(rms[0], rel=0.03), f"{rms[1]:.4f} degrees, {rms[0]:.4f} where it is not turned"


def test_a_turned_encoding_has_its_own_fingerprint():
    turned = variant(ENCODINGS["octahedral"], {"axis": "y"})
    assert turned.fingerprint != ENCODINGS["octahedral"].fingerprint and turned.name == "octahedral:axis=y"


@pytest.mark.parametrize(
    "word, said",
    [
        ("octahedral:axis=w", "axis is x, y or z, not 'w'"),
        ("octahedral:sign=2", "sign is 1 or -1, not '2'"),
        ("octahedral:axis", "give each parameter once after octahedral, such as octahedral:axis=y"),
        ("octahedral:axis=x:axis=y", "give each parameter once after octahedral"),
        ("hemi_octahedral:axis=y", "has no parameter 'axis'; known: arithmetic"),
        ("per_pixel_view:sign=-1", "has no parameter 'sign'"),
        ("xy_sign:axis=x", "has no parameter 'axis'"),
    ],
)
def test_invalid_axis_is_a_one_line_error(word, said):
    with pytest.raises(UsageError) as caught:
        tuned(word)
    assert said in str(caught.value) and "\n" not in str(caught.value)
