"""`import normalbench`: tables as functions, and codecs on arrays, compared bit for bit with what GLSL stores."""

import jax
import numpy as np
import pandas as pd
import pytest
from manual import ROOT
from test_python import UNIT, directions
from typed import codecs_named

import normalbench as nb
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.registry import TABLES
from normalbench.gbuffer.codecs.codec_passes import CodecPasses

CODECS = (
    *("octahedral/rg8", "octahedral_precise/rg8", "spheremap/rgba8", "stereographic/rgb10a2", "xyz/rgba8_snorm"),
    *("octahedral/rg16", "cube/rgb10a2", "xyz_renormalised/rgba8", "octahedral/rgb8_12_12", "spherical/rg8_7_9"),
)


@pytest.mark.parametrize("name", CODECS)
def test_stored_values_match_glsl(gl, name):
    """Every number in the texel matches for 2^20 normals, except for a few next to a rounding tie."""
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


def test_integers_match_the_format():
    """UNORM by its definition, SNORM in two's complement, floats as bits."""
    up = np.array([[0.0, 0.0, 1.0]], np.float32)
    assert np.asarray(nb.encode("xyz/rgba8", up).integers).tolist() == [[128, 128, 255]]
    assert np.asarray(nb.encode("xyz/rgba8_snorm", -up).integers).tolist() == [[0, 0, 2**32 - 127]]
    assert np.asarray(nb.encode("xyz/rgba16f", up).integers).tolist() == [[0, 0, 0x3C00]]
    assert np.asarray(nb.encode("xyz/rgba32f", up).integers).tolist() == [[0, 0, 0x3F800000]]


@pytest.mark.usefixtures("gl", "slang")
def test_a_shader_file_without_a_twin_runs_in_opengl():
    """The path contains slashes; codes and normals match the same encoding of the catalogue."""
    n = directions(60).reshape(20, 3, 3)
    mine = str(ROOT / "tests" / "inputs" / "encoders" / "mine.ush")
    for storage in ("rgb10a2", "rg8_snorm/truncate"):
        codes, known = nb.encode(f"{mine}/{storage}", n), nb.encode(f"octahedral/{storage}", n)
        assert codes.values.shape == known.values.shape == (20, 3, 2)
        assert np.abs(codes.integers.astype(int) - known.integers.astype(int)).max() <= 1
        assert np.allclose(nb.decode(f"{mine}/{storage}", known), nb.decode(f"octahedral/{storage}", known), atol=1e-5)


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


@pytest.mark.usefixtures("gl")
def test_a_size_may_be_two_numbers():
    rows = nb.render(size=(64, 48), lights=2, repeats=1, layout="fp32")
    assert list(rows["size"]) == ["64x48"]


def test_integers_are_not_decoded():
    codes = nb.encode("octahedral/rg8", UNIT)
    with pytest.raises(UsageError, match="decode takes the result of encode, or its values"):
        nb.decode("octahedral/rg8", codes.integers)
    assert np.array_equal(nb.decode("octahedral/rg8", codes), nb.decode("octahedral/rg8", codes.values))
