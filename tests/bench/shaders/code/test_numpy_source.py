"""A codec's file of NumPy computes the integers that the catalogue's own Python computes."""

import numpy as np
import pytest
from directions import hard_directions, random_directions, view_positions

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.numpy_source import numpy_source, words_of
from normalbench.bench.shaders.code.run import runner
from normalbench.bench.shaders.code.run.interface import Interface, Ran
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.variants import settings_in, variant
from normalbench.encodings.storages.storage import ROUNDINGS, STORAGES, storage_of
from normalbench.encodings.storages.words import words
from normalbench.encodings.vec import Vec3, from_array

COUNT = 2**16
FAST = [
    *(("octahedral", storage, "nearest") for storage in ("rgb10a2", "rgba16_snorm", "rg16f", "r11g11b10f", "rgba32f")),
    *(("octahedral", "rgb10a2", rounding) for rounding in ROUNDINGS[1:]),
    ("spherical:bias=0.1:scale=0.5", "rgb8_12_12", "nearest"),
    ("stereographic:scale=1.3", "rg16", "nearest"),
    ("octahedral:axis=y:sign=-1", "rgb8_12_12_snorm", "truncate"),
    ("octahedral_precise", "rg8", "nearest"),
    ("xy_sign", "rg16f", "truncate"),
    ("per_pixel_view", "rg16_snorm", "nearest"),
    ("spherical_lut", "rg8", "nearest"),
    ("best_fit", "rgba8", "nearest"),
    ("cube", "rgb8_10_10_3", "truncate_half"),
    ("xyz", "r11g11b10f", "truncate"),
]


def normals() -> tuple[np.ndarray, np.ndarray]:
    """COUNT unit normals, the hard ones first, and as many views; both of shape (COUNT, 3)."""
    return np.concatenate([hard_directions(), random_directions(COUNT)])[:COUNT], view_positions(COUNT)


def codec_of(name: str, storage: str, rounding: str = "nearest") -> Codec:
    known, settings = settings_in(name)
    encoding = ENCODINGS[known]
    found = storage_of(storage)
    assert found
    return Codec(variant(encoding, settings) if settings else encoding, found, rounding)


def ran(codec: Codec, folder, n, view) -> Ran:
    """What the file of a codec gives; its tables lie next to it."""
    encoding, tables = codec.encoding, codec.encoding.tables()
    path = folder / "code.py"
    path.write_text(numpy_source(codec, "code"))
    for name, table in tables.items():
        np.save(folder / f"code_{name}.npy", table)
    size, sign = encoding.components + encoding.sign_bits, encoding.sign_bits
    interface = Interface("code", size, sign, words_of(codec.storage), encoding.domain == "view", tables)
    return runner("python").run(path, interface, n, view, np.zeros((len(n), 4), np.float32))


def stored(codec: Codec, n, view) -> tuple[np.ndarray, np.ndarray]:
    """The texels and the codes by JAX, one step after another."""
    code = codec.stored(from_array(n), Vec3(*view.T))
    numbers = [np.asarray(c) for c in code]
    texels = np.zeros((len(n), words_of(codec.storage)), np.uint32)
    bits = codec.storage.bits
    for channel in range(codec.encoding.components):
        whole, first = words(numbers[channel], codec.storage, channel), sum(bits[:channel])
        if codec.storage.is_packed:
            texels[:, 0] |= (whole << np.uint32(32 - bits[channel] - first)).byteswap()
        else:
            texels[:, first // 32] |= whole << np.uint32(first % 32)
    return texels, np.stack(numbers, axis=1)


def check(codec: Codec, folder) -> None:
    n, view = normals()
    found = ran(codec, folder, n, view)
    texels, codes = stored(codec, n, view)
    differ = np.flatnonzero((texels != found.words).any(axis=1))
    if codec.encoding.searches and len(differ):
        check_as_good(codec, n[differ], view[differ], found.codes[differ])
        return
    first = (n[differ[0]], texels[differ[0]], found.words[differ[0]]) if len(differ) else ()
    assert not len(differ), f"{codec.name}: {len(differ)} of {len(n)} texels differ, the first {first}"
    worst = np.abs(codes - found.unpacked).max()
    assert worst == 0, f"{codec.name}: an unpacked number differs by {worst}"


def check_as_good(codec: Codec, n, view, codes) -> None:
    """XLA fuses products and sums of the loop that searches: of two codes that are as good before they are stored it
    may take the other one, by as much as float32 rounds the misfit."""
    rays, encoding = Vec3(*view.T), codec.encoding
    made = encoding.encode(from_array(n), rays)
    decoded = (np.stack(encoding.decode(code, rays), axis=1) for code in (made, type(made)(*codes.T)))
    sines = [np.linalg.norm(np.cross(n.astype(float), d), axis=1) / np.linalg.norm(d, axis=1) for d in decoded]
    worst = np.abs(sines[0] - sines[1]).max()
    assert len(n) < COUNT / 1000, f"{codec.name}: {len(n)} of {COUNT} texels differ"
    assert worst < 2.0**-20, f"{codec.name}: of the two codes one is better, by {worst} radians"


@pytest.mark.parametrize(("name", "storage", "rounding"), FAST)
def test_the_file_has_the_integers_of_the_catalogue(name, storage, rounding, tmp_path):
    """Texels of 2^16 hard and random normals are those of the catalogue's Python, bit for bit."""
    check(codec_of(name, storage, rounding), tmp_path)


def test_a_division_by_a_parameter_differs_by_a_step_at_most(tmp_path):
    """XLA multiplies by the rounded reciprocal of a scalar, NumPy divides: few numbers land on the other side of a
    tie, one step away."""
    codec = codec_of("spherical:bias=0.1:scale=0.9", "rg16")
    n, view = normals()
    found, (texels, _) = ran(codec, tmp_path, n, view).words[:, 0].astype(np.int64), stored(codec, n, view)
    steps = np.abs((found >> 16) - (texels[:, 0].astype(np.int64) >> 16))
    assert np.array_equal(found & 0xFFFF, texels[:, 0] & 0xFFFF), "the angle is not divided"
    assert steps.max() == 1 and np.count_nonzero(steps) < 100, f"{np.count_nonzero(steps)} differ, by {steps.max()}"


@pytest.mark.nightly("bench/shaders/code/test_numpy_source.py::test_the_file_has_the_integers_of_the_catalogue")
@pytest.mark.parametrize("name", ENCODINGS)
def test_every_codec_has_the_integers_of_the_catalogue(name, tmp_path):
    """Every storage that holds an encoding: the same texels, bit for bit. The text that rounds is a storage's, whatever
    the encoding, so encodings take the roundings in turn; of one that tries several codes, rounding is a part."""
    encoding, turn = ENCODINGS[name], list(ENCODINGS).index(name)
    whole = encoding.is_precise or encoding.searches
    codecs = [
        Codec(encoding, storage, rounding)
        for at, storage in enumerate(STORAGES.values(), turn)
        for rounding in (ROUNDINGS if whole else ROUNDINGS[at % len(ROUNDINGS) :][:1])
    ]
    for codec in filter(lambda codec: codec.fits, codecs):
        check(codec, tmp_path)


def test_the_file_is_plain_numpy():
    """It has a head as comments, imports NumPy and the standard library alone, and is formatted as text of ASCII."""
    text = numpy_source(codec_of("octahedral", "rgb10a2"), "mine", "Made by hand.\nTwice.")
    assert text.startswith("# Made by hand.\n# Twice.\n")
    assert "jax" not in text and "jnp" not in text and "normalbench" not in text


@pytest.mark.parametrize(("name", "said"), [("octahedral:arithmetic=half", "half arithmetic"), ("xyz", "3 components")])
def test_what_cannot_be_written_is_refused_in_a_line(name, said):
    """Half arithmetic, and a storage with too few channels."""
    with pytest.raises(UsageError, match=said):
        numpy_source(codec_of(name, "rg8"), "mine")


def test_a_chain_is_refused_in_a_line():
    """Two codecs, one after the other."""
    chained = ENCODINGS["xyz"].behind(codec_of("octahedral", "rg8"))
    with pytest.raises(UsageError, match="chain"):
        numpy_source(Codec(chained, STORAGES["rgba8"]), "mine")
