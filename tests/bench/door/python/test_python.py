"""`import normalbench`: tables as functions, and codecs on arrays, compared bit for bit with what GLSL stores."""

import ast
import inspect
import re

import jax
import numpy as np
import pytest

import normalbench as nb
from normalbench.bench.door.python import stub
from normalbench.bench.ground.options.option import fields_of
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS


def directions(count: int) -> np.ndarray:
    n = np.random.default_rng(0).normal(size=(count, 3))
    return (n / np.linalg.norm(n, axis=-1, keepdims=True)).astype(np.float32)


def test_arrays_of_any_shape_round_trip_under_jit():
    n = directions(60).reshape(3, 20, 3)
    codes = jax.jit(lambda n: nb.encode("octahedral/rg16", n))(n)
    decoded = nb.decode("octahedral/rg16", codes)
    assert codes.values.shape == (3, 20, 2) and decoded.shape == n.shape
    assert np.abs(np.asarray(decoded) - n).max() < 1e-4


@pytest.mark.parametrize("name", TABLES)
def test_every_table_is_a_function_that_documents_its_options(name):
    function = getattr(nb, name)
    assert list(inspect.signature(function).parameters) and "Args:" in inspect.getdoc(function)
    assert name in dir(nb)


@pytest.mark.parametrize(
    "call, said",
    [
        (lambda: nb.encode("octahedral", np.zeros((1, 3))), "name an encoding and a storage"),
        (lambda: nb.encode("octahedral/rg8", np.zeros((3, 2))), r"\(3, 2\); expected \(..., 3\)"),
        (lambda: nb.encode("xyz/rg8", np.zeros((1, 3))), "3 components"),
        (lambda: nb.decode("octahedral/rg8", np.zeros((1, 3))), r"requires \(..., 2\)"),
        (lambda: nb.quality(encodings="xy"), "unknown option 'encodings'"),
        (lambda: nb.quality(count="many"), "count is 'many'"),
        (lambda: nb.encoding("my own", None, None), "identifier"),
        (lambda: nb.encoding("octahedral", None, None), "encoding 'octahedral' already exists in the catalogue"),
    ],
)
def test_misuse_is_a_one_line_error(call, said):
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


UNIT = np.eye(3, dtype=np.float32)


@pytest.mark.parametrize(
    "name, array, said",
    [
        ("own", 2 * UNIT, "100.0% of own are not unit vectors; normalise or unpack them"),
        ("own", UNIT * 0.5 + 0.5, "are not unit vectors"),
        ("own", np.full((4, 3), 200, np.uint8), "own has type uint8; give floats in [-1, 1]"),
        ("own", np.where(UNIT == 1, np.nan, UNIT), "own contains NaN or infinity"),
        ("own", np.zeros((0, 3)), "an array of normals of shape (count, 3)"),
        ("sphere", UNIT, "sphere is a built-in set"),
    ],
)
def test_arrays_that_are_not_normals_are_refused(name, array, said):
    with pytest.raises(UsageError, match=re.escape(said)) as error:
        nb.quality(encoding="octahedral", storage="rg8", backend="jax", normals={name: array})
    assert "\n" not in str(error.value)


def test_the_type_stub_has_every_table_and_option():
    functions = {node.name: node for node in ast.parse(stub.stub()).body if isinstance(node, ast.FunctionDef)}
    assert set(functions) == set(TABLES)
    for name, function in functions.items():
        assert [argument.arg for argument in function.args.kwonlyargs] == [*fields_of(TABLES[name].options), "on"]


def test_an_unknown_attribute_lists_the_known_ones():
    with pytest.raises(AttributeError, match="normalbench has no 'colours'; available: Codec"):
        _ = nb.colours
