"""`normalbench maps`: the errors that block compression causes in normal maps, and refused requests."""

import json

import numpy as np
import pytest
import texture2ddecoder
from PIL import Image
from test_maps import case, small
from written import png_bytes

from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS, from_arrays
from normalbench.bench.tables.maps import encoders
from normalbench.bench.tables.maps.encoders import Texels
from normalbench.bench.tables.maps.formats import FORMATS
from normalbench.bench.tables.maps.measure import Clock, bands, code_texels, measure, through
from normalbench.bench.tables.maps.sets import MAPS, SIZE
from normalbench.bench.tables.quality import measure as quality
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.gl.device import device


@pytest.mark.parametrize(("encoding", "swizzle", "storage"), [("octahedral", "rg", "rg8"), ("xyz", "rgb", "rgba8")])
def test_uncompressed_rows_match_the_quality_table(encoding, swizzle, storage):
    """The figures agree to a relative difference of 1e-4."""
    normals = NORMAL_SETS["playground"](0, 0)
    (row,) = measure(case(normals, "none", swizzle, encoding))
    same = quality.measure(quality.QualityCase(Codec(ENCODINGS[encoding], STORAGES[storage]), normals, "jax"))
    for column in ("psnr_db", "angle_mean_deg", "angle_rms_deg", "angle_p99_deg", "angle_max_deg", "count"):
        assert row[column] == pytest.approx(same[column], rel=1e-4), column
    assert row["bits_per_texel"] == same["bits"] + (8 if encoding == "xyz" else 0)


def test_angles_match_the_decoded_normals():
    map_case = case(MAPS["bumps"]())
    (band,) = bands(map_case.normal_set)
    decoded = through(map_case, band, Clock()).astype(np.float64)
    n = band.n.astype(np.float64)
    cosines = np.sum(n * decoded, axis=-1) / np.linalg.norm(decoded, axis=-1) / np.linalg.norm(n, axis=-1)
    angles = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    (row,) = measure(map_case)
    figures = [row[f"angle_{name}_deg"] for name in ("mean", "rms", "p99", "max")]
    expected = [angles.mean(), np.sqrt(np.mean(angles**2)), np.percentile(angles, 99), angles.max()]
    assert figures == pytest.approx(expected, rel=2e-3)


def test_a_large_image_is_compressed_in_bands_of_whole_blocks():
    parts = list(bands(from_arrays("large", "", *[np.ones((601, 1001, 3), np.float32)] * 2, np.ones((601, 1001), bool),
                                   (601, 1001))))  # fmt: skip
    assert len(parts) == 3 and sum(band.real[0] for band in parts) == 601
    assert all(band.n.shape[0] % 4 == band.n.shape[1] % 4 == 0 and band.n.size <= 3 * 2**18 for band in parts)


@pytest.mark.usefixtures("gl")
def test_the_device_decodes_bc7_like_the_model():
    model, decoded = (measure(case(MAPS["bumps"](), "bc7", decoder=name))[0] for name in ("model", "device"))
    for column in ("psnr_db", "angle_mean_deg", "angle_max_deg", "code_psnr_db"):
        assert decoded[column] == pytest.approx(model[column], rel=1e-6), column
    assert decoded["device"] == device().renderer and model["device"] == "NumPy, exact"


def test_the_command_measures_a_file_and_names_its_rows(run, tmp_path):
    n = quality.image_of(small(30, 22))[0]
    (tmp_path / "map.png").write_bytes(png_bytes(np.rint((n * 0.5 + 0.5) * 65535).astype(np.uint16)))
    words = ("--normals", str(tmp_path / "map.png"), "--encoding", "xy,xyz")
    status, out, err = run("maps", *words, "--format", "json")
    rows = json.loads(out)
    assert (status, err.count("left out")) == (0, 0), "of all formats, those with room are meant"
    assert all(tuple(row) == tuple(TABLES["maps"].empty()) for row in rows)
    assert len(rows) == 12 == len({TABLES["maps"].name_of(row) for row in rows})
    rms = [row["angle_rms_deg"] for row in rows]
    assert rms == sorted(rms) and {row["count"] for row in rows} == {660}
    (bc5,) = [row for row in rows if row["block"] == "bc5"]
    assert bc5["encoder"].startswith("quicktex 0.") and bc5["encode_ms_per_megatexel"] > 0


def test_a_missing_encoder_is_reported(run, monkeypatch):
    """The exit status is 3 if the encoder's format is requested; with all formats, the other formats are measured."""
    there = encoders.import_module

    def import_module(name):
        if name.startswith("quicktex"):
            raise ImportError("No module named 'quicktex'")
        return there(name)

    monkeypatch.setattr(encoders, "import_module", import_module)
    status, out, err = run("maps", "--block", "bc5")
    assert (status, out, err.count("\n")) == (3, "", 1) and "pip install quicktex" in err
    status, out, err = run("maps", "--encoding", "xy", "--normals", "bumps", "--format", "json")
    assert status == 0 and "bc5: requires quicktex" in err
    assert {row["block"] for row in json.loads(out)} == set(FORMATS) - {"bc3", "bc5"}
    monkeypatch.setattr(encoders, "import_module", lambda name: there("no_such_module_as_" + name))
    assert "pip install normalbench[maps]" in TABLES["maps"].work.missing()


# Each format with the swizzle that suits two numbers, and what an independent tool decodes its blocks by.
TOOLS = {
    "bc3": ("dxt5nm", texture2ddecoder.decode_bc3),
    "bc5": ("rg", texture2ddecoder.decode_bc5),
    "bc7": ("rrrg", texture2ddecoder.decode_bc7),
    "eac_rg11": ("rg", texture2ddecoder.decode_eacrg),
    "astc_4x4": ("rrrg", lambda blocks, width, height: texture2ddecoder.decode_astc(blocks, width, height, 4, 4)),
}


def psnr_db(numbers, given):
    return 10 * np.log10(1 / np.mean((numbers.astype(np.float64) - given / 255) ** 2))


@pytest.mark.parametrize("name", MAPS)
@pytest.mark.parametrize("block", TOOLS)
def test_the_channel_psnr_agrees_with_another_tool(block, name):
    """texture2ddecoder decodes the same blocks to 8 bits, which is exact for BC7. EAC has 11 bits, BC5 is exact
    between its ends and ASTC uses 16-bit floats: 8 bits change the PSNR by at most 0.1 dB on noise, and by at most
    0.2 dB (BC5) and 0.7 dB (ASTC) on the smooth map."""
    swizzle, tool = TOOLS[block]
    map_case = case(MAPS[name](), block, swizzle)
    (band,) = bands(map_case.normal_set)
    given = code_texels(map_case.codec, band)
    texels = Texels(map_case.swizzle.texels(given).tobytes(), (SIZE, SIZE), map_case.swizzle.read)
    blocks = map_case.block.encoder.encoded(texels)
    theirs = np.frombuffer(tool(blocks, SIZE, SIZE), np.uint8).reshape(SIZE, SIZE, 4)[..., [2, 1, 0, 3]]
    ours = map_case.swizzle.numbers(map_case.block.by_specification(blocks, (SIZE, SIZE)))
    (row,) = measure(map_case)
    assert row["code_psnr_db"] == pytest.approx(psnr_db(ours, given), abs=1e-9)
    apart = row["code_psnr_db"] - psnr_db(map_case.swizzle.numbers(theirs) / 255, given)
    most = {"bc7": 1e-4}.get(block, 0.1 if name == "grain" else {"astc_4x4": 0.7, "bc5": 0.2}.get(block, 0.1))
    assert abs(apart) < most, f"{apart} dB"
    if block == "bc5":
        cut = np.floor(ours.astype(np.float64) * 255 + 1e-3) / 255
        assert psnr_db(cut, given) == pytest.approx(psnr_db(map_case.swizzle.numbers(theirs) / 255, given), abs=1e-6)


def test_pictures_and_the_plot_show_something(run, tmp_path):
    words = ("--normals", "bumps", "--encoding", "xy", "--block", "bc5,bc7", "--images", str(tmp_path / "p"))
    status, *_ = run("maps", *words, "--plot", str(tmp_path / "plot.png"))
    names = sorted(path.name for path in (tmp_path / "p").iterdir())
    assert status == 0 and len(names) == 6 and "bumps-xy-bc7-rrrg-model-error.png" in names
    for path in [*(tmp_path / "p").iterdir(), tmp_path / "plot.png"]:
        pixels = np.asarray(Image.open(path).convert("RGB"))
        assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50 and pixels.mean() > 5, path.name
