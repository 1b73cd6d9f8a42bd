"""All kinds of encodings: the same rules, and the same interface of their codecs."""

import inspect
import re
from pathlib import Path
from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest

from normalbench.encodings import catalogue
from normalbench.encodings.catalogue import BY_KIND, LIGHT_BUFFERS, PRECISE
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.curve_codec import CurveCodec
from normalbench.encodings.codecs.depth_codec import DepthCodec
from normalbench.encodings.codecs.files import CatalogueError
from normalbench.encodings.codecs.frame_codec import FrameCodec
from normalbench.encodings.codecs.light_codec import LightCodec
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.kinds import CURVE, DEPTH, FRAME, KINDS, LIGHT, MOTION, NORMAL
from normalbench.encodings.rotation import frame_of
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES
from normalbench.encodings.storages.storage import (
    CURVE_STORAGES,
    FRAME_STORAGES,
    LIGHT_STORAGES,
    MOTION_STORAGES,
    STORAGES,
)
from normalbench.encodings.vec import Vec2, Vec3, Vec4

ROOT = Path(__file__).parents[2]
EVERY = [pytest.param(e, id=f"{kind.name} {e.name}") for kind, named in BY_KIND.items() for e in named.values()]
USUAL = {
    DEPTH: (DepthCodec, DEPTH_STORAGES),
    FRAME: (FrameCodec, FRAME_STORAGES),
    LIGHT: (LightCodec, LIGHT_STORAGES),
    MOTION: (MotionCodec, MOTION_STORAGES),
    CURVE: (CurveCodec, CURVE_STORAGES),
}


def number(x: float):
    return jnp.full(1, x, jnp.float32)


FORWARD, RIGHT = Vec3(number(0), number(0), number(1)), Vec3(number(1), number(0), number(0))
# A codec of each kind, what it is asked to store, and how many bits and codes it has.
CODECS = {
    NORMAL: (Codec(BY_KIND[NORMAL]["octahedral"], STORAGES["rg8"]), (FORWARD, RIGHT), 16, 2**16),
    DEPTH: (DepthCodec(BY_KIND[DEPTH]["linear"], DEPTH_STORAGES["packed24"]), (number(5), 1.0, number(9)), 24, 2**24),
    FRAME: (
        FrameCodec(BY_KIND[FRAME]["qtangent"], FRAME_STORAGES["rgba8"]),
        (frame_of(FORWARD, RIGHT, number(1)),),
        32,
        2**32,
    ),
    LIGHT: (LIGHT_BUFFERS["linear"], (Vec4(*[number(1)] * 4),), 32, 2**32),
    # SNORM of n bits has 2^n - 1 codes in [-1, 1].
    MOTION: (
        MotionCodec(BY_KIND[MOTION]["sqrt"], MOTION_STORAGES["rgb10a2_centred"]),
        (Vec2(number(0.1), number(-0.2)), 1.0),
        20,
        1023**2,
    ),
    CURVE: (CurveCodec(BY_KIND[CURVE]["squared"], CURVE_STORAGES["rgb10a2"]), (number(0.3),), 10, 1024),
}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_the_catalogue_and_the_files_are_the_same(kind):
    folder = ROOT / "encodings" / kind.folder
    files = {suffix: {path.stem for path in folder.glob(f"*{suffix}")} for suffix in (".py", ".glsl")}
    assert files[".py"] == files[".glsl"] == set(BY_KIND[kind]) - set(PRECISE)


@pytest.mark.parametrize("encoding", EVERY)
def test_an_encoding_is_complete(encoding):
    assert encoding.title and encoding.citation and encoding.ulps_reason and len(encoding.ulps) == 2
    for function in ("encode", "decode"):
        assert inspect.getdoc(getattr(encoding, function)), f"{function}: shapes and special cases are said"
    text = encoding.glsl.read_text()
    assert [signature for signature in encoding.signatures if signature not in text] == []
    assert f"{encoding.glsl.stem}.py" in text.splitlines()[0], "the twin is named"


@pytest.mark.parametrize("encoding", EVERY)
def test_the_twins_have_the_same_formula(encoding):
    """The formula is above the line in both languages, in the same symbols."""
    python = set(re.findall(r"^    # (.+)$", encoding.glsl.with_suffix(".py").read_text(), re.M))
    assert python == set(re.findall(r"^    // (.+)$", encoding.glsl.read_text(), re.M))


@pytest.mark.parametrize("kind", USUAL, ids=lambda kind: kind.name)
def test_the_usual_storages_of_an_encoding_exist_and_fit_it(kind):
    codec, storages = USUAL[kind]
    for encoding in BY_KIND[kind].values():
        assert [codec(encoding, storages[name]).misfit for name in encoding.storages] == [None] * len(encoding.storages)
        assert encoding.storages, encoding.name


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_codecs_of_every_kind_have_the_same_interface(kind):
    """Storing and a round trip give finite numbers, one per value; nothing here depends on the kind."""
    codec, given, bits, codes = CODECS[kind]
    assert codec.misfit is None and codec.encoding.name in codec.name
    assert (codec.bits, codec.codes) == (bits, codes)
    leaves = [np.asarray(leaf) for tree in (codec.stored(*given), codec.round_trip(*given)) for leaf in planes(tree)]
    assert all(leaf.shape == (1,) and np.isfinite(leaf).all() for leaf in leaves)


def test_a_separate_sign_counts_as_one_bit_of_the_codec():
    """x and y have a byte each, and the sign of z adds one bit."""
    codec = Codec(BY_KIND[NORMAL]["xy_sign"], STORAGES["rg8"])
    assert (codec.bits, codec.codes) == (17, 2**17)


def planes(made) -> list:
    """Return the arrays of a number, a vector or a tangent frame."""
    return [leaf for part in made for leaf in planes(part)] if isinstance(made, tuple) else [made]


def test_an_encoding_that_is_not_named_after_its_file_is_refused(monkeypatch):
    monkeypatch.setattr(catalogue, "import_module", lambda *_: SimpleNamespace(ENCODING=catalogue.ENCODINGS["xyz"]))
    with pytest.raises(CatalogueError, match=r"encodings/normals/xy\.py: ENCODING has the name 'xyz' instead of 'xy'"):
        catalogue._loaded_encoding(NORMAL, "xy")


@pytest.mark.parametrize(
    "folder", sorted({path.parent for path in (ROOT / "encodings").rglob("*.py")}), ids=lambda path: path.name
)
def test_a_folder_holds_at_most_15_encodings(folder):
    """A pair of files counts as one encoding. The folder of normal encodings is exempt."""
    things = {path.stem for path in folder.iterdir() if path.name != "__pycache__"}
    assert len(things) <= 15 or folder.name == NORMAL.folder, f"{folder.name} holds {len(things)} things"
