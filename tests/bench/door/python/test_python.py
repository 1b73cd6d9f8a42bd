"""`import normalbench`: tables as functions, and codecs on arrays, held to what GLSL stores bit for bit."""

import ast
import inspect
import re

import jax
import numpy as np
import pandas as pd
import pytest
from manual import ROOT

import normalbench as nb
from normalbench.bench.door.python import stub
from normalbench.bench.ground.options.option import fields_of
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.codecs.names import codecs_named
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.codecs.codec_passes import CodecPasses

CODECS = (
    *("octahedral/rg8", "octahedral_precise/rg8", "spheremap/rgba8", "stereographic/rgb10a2", "xyz/rgba8_snorm"),
    *("octahedral/rg16", "cube/rgb10a2", "xyz_renormalised/rgba8", "octahedral/rgb8_12_12", "spherical/rg8_7_9"),
)


def directions(count: int) -> np.ndarray:
    n = np.random.default_rng(0).normal(size=(count, 3))
    return (n / np.linalg.norm(n, axis=-1, keepdims=True)).astype(np.float32)


@pytest.mark.parametrize("name", CODECS)
def test_what_is_stored_is_what_glsl_stores(gl, name):
    """Of 2^20 normals every number in the texel, and so every integer; where the two languages' maths agree, all."""
    n = directions(2**20)
    (codec,) = codecs_named(*name.split("/"), "nearest")
    pixels = np.concatenate([n, np.zeros((len(n), 1), np.float32)], axis=-1).reshape(1024, 1024, 4)
    ahead = np.zeros_like(pixels)
    ahead[..., 2] = -1
    with CodecPasses(gl, codec) as passes:
        stored = passes.round_trip(pixels, ahead).codes.reshape(len(n), -1)
    codes = nb.encode(name, n)
    values = np.asarray(codes.values)
    apart = np.any(values != stored[:, : values.shape[-1]], axis=-1)
    # Next to a tie two compilers may round either way: a handful of a million.
    assert apart.mean() < 2e-5, f"{apart.sum()} of {len(n)} normals"
    assert np.asarray(codes.integers).dtype == np.uint32


def test_integers_are_those_of_the_format():
    """UNORM by its definition, SNORM in two's complement, floats by their bits."""
    up = np.array([[0.0, 0.0, 1.0]], np.float32)
    assert np.asarray(nb.encode("xyz/rgba8", up).integers).tolist() == [[128, 128, 255]]
    assert np.asarray(nb.encode("xyz/rgba8_snorm", -up).integers).tolist() == [[0, 0, 2**32 - 127]]
    assert np.asarray(nb.encode("xyz/rgba16f", up).integers).tolist() == [[0, 0, 0x3C00]]
    assert np.asarray(nb.encode("xyz/rgba32f", up).integers).tolist() == [[0, 0, 0x3F800000]]


@pytest.mark.usefixtures("gl", "slang")
def test_a_shader_file_without_a_twin_is_run_by_opengl():
    """A path has slashes of its own; numbers and normals are those of the same code of the catalogue."""
    n = directions(60).reshape(20, 3, 3)
    mine = str(ROOT / "tests" / "inputs" / "encoders" / "mine.ush")
    for storage in ("rgb10a2", "rg8_snorm/truncate"):
        codes, known = nb.encode(f"{mine}/{storage}", n), nb.encode(f"octahedral/{storage}", n)
        assert codes.values.shape == known.values.shape == (20, 3, 2)
        assert np.abs(codes.integers.astype(int) - known.integers.astype(int)).max() <= 1
        assert np.allclose(nb.decode(f"{mine}/{storage}", known), nb.decode(f"octahedral/{storage}", known), atol=1e-5)


def test_any_shape_goes_through_and_back_under_jit():
    n = directions(60).reshape(3, 20, 3)
    codes = jax.jit(lambda n: nb.encode("octahedral/rg16", n))(n)
    decoded = nb.decode("octahedral/rg16", codes)
    assert codes.values.shape == (3, 20, 2) and decoded.shape == n.shape
    assert np.abs(np.asarray(decoded) - n).max() < 1e-4


def test_decoding_is_differentiable():
    slope = jax.jacobian(lambda code: nb.decode("xy/rg8", code))(np.array([0.6, 0.0], np.float32))
    assert np.allclose(slope, [[1, 0], [0, 1], [-0.75, 0]], atol=1e-6)


def test_a_table_is_a_data_frame_with_units():
    rows = nb.quality(encoding="octahedral", storage=["rg8", "rgb10a2"], backend="jax", normals="axes")
    assert isinstance(rows, pd.DataFrame) and list(rows["storage"]) == ["rg8", "rgb10a2"]
    assert list(rows.columns) == list(TABLES["quality"].empty())
    assert rows.attrs["units"]["angle_max_deg"] == "degrees" and "codes" in rows.attrs["definitions"]
    assert type(rows[["storage"]]) is pd.DataFrame and rows["psnr_db"].dtype == float


def test_a_notebook_shows_the_charts():
    rows = nb.quality(encoding="octahedral", storage="rg8", backend="jax", normals="sphere", count=4096)
    assert rows._repr_html_().count("<svg") == 1 and len(rows.charts()) == 1
    assert "<svg" not in nb.cost(encoding="xy", isa=True, family="navi21", storage="rgba8")._repr_html_()


@pytest.mark.parametrize("name", TABLES)
def test_every_table_is_a_function_that_says_its_options(name):
    function = getattr(nb, name)
    assert list(inspect.signature(function).parameters) and "Args:" in inspect.getdoc(function)
    assert name in dir(nb)


@pytest.mark.parametrize(
    "call, said",
    [
        (lambda: nb.encode("octahedral", np.zeros((1, 3))), "name an encoding and a storage"),
        (lambda: nb.encode("octahedral/rg8", np.zeros((3, 2))), r"\(3, 2\); \(..., 3\) is needed"),
        (lambda: nb.encode("xyz/rg8", np.zeros((1, 3))), "3 components"),
        (lambda: nb.decode("octahedral/rg8", np.zeros((1, 3))), r"needs \(..., 2\)"),
        (lambda: nb.quality(encodings="xy"), "unknown option 'encodings'"),
        (lambda: nb.quality(count="many"), "count is 'many'"),
        (lambda: nb.encoding("my own", None, None), "identifier"),
        (lambda: nb.encoding("octahedral", None, None), "encoding 'octahedral': the catalogue has one of this name"),
    ],
)
def test_misuse_is_one_line(call, said):
    with pytest.raises(UsageError, match=said) as error:
        call()
    assert "\n" not in str(error.value)


def test_an_encoding_may_have_the_name_of_its_glsl_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.glsl").write_text("")
    xy = ENCODINGS["xy"]
    mine = nb.encoding("mine", xy.encode, xy.decode, domain="hemisphere")
    rows = nb.quality(encoding=mine, storage="rg8", normals="axes", backend="jax")
    assert list(rows["encoding"]) == ["mine"]


@pytest.mark.usefixtures("gl")
def test_a_size_may_be_two_numbers():
    rows = nb.render(size=(64, 48), lights=2, repeats=1, layout="fp32")
    assert list(rows["size"]) == ["64x48"]


UNIT = np.eye(3, dtype=np.float32)


@pytest.mark.parametrize(
    "name, array, said",
    [
        ("own", 2 * UNIT, "100.0% of own are not unit vectors; divide by their lengths, or unpack them"),
        ("own", UNIT * 0.5 + 0.5, "are not unit vectors"),
        ("own", np.full((4, 3), 200, np.uint8), "own is of uint8; give floats in [-1, 1]"),
        ("own", np.where(UNIT == 1, np.nan, UNIT), "own has numbers that are NaN or infinite"),
        ("own", np.zeros((0, 3)), "an array of normals of shape (count, 3)"),
        ("sphere", UNIT, "sphere is a set of normalbench's own"),
    ],
)
def test_what_are_not_normals_is_refused_as_a_file_of_them_is(name, array, said):
    with pytest.raises(UsageError, match=re.escape(said)) as error:
        nb.quality(encoding="octahedral", storage="rg8", backend="jax", normals={name: array})
    assert "\n" not in str(error.value)


def test_integers_are_not_decoded():
    codes = nb.encode("octahedral/rg8", UNIT)
    with pytest.raises(UsageError, match="decode takes what encode gave, or its values"):
        nb.decode("octahedral/rg8", codes.integers)
    assert np.array_equal(nb.decode("octahedral/rg8", codes), nb.decode("octahedral/rg8", codes.values))


def test_type_checkers_are_told_of_every_table_and_option():
    functions = {node.name: node for node in ast.parse(stub.stub()).body if isinstance(node, ast.FunctionDef)}
    assert set(functions) == set(TABLES)
    for name, function in functions.items():
        assert [argument.arg for argument in function.args.kwonlyargs] == [*fields_of(TABLES[name].options), "on"]


def test_there_is_nothing_else():
    with pytest.raises(AttributeError, match="normalbench has no 'colours'; it has Codec"):
        _ = nb.colours
