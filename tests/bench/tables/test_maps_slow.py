"""`normalbench maps`: what block compression loses of normal maps, and what it refuses."""

import numpy as np
import pytest
import texture2ddecoder
from PIL import Image
from test_maps import case

from normalbench.bench.tables.maps.encoders import Texels
from normalbench.bench.tables.maps.measure import bands, code_texels, measure
from normalbench.bench.tables.maps.sets import MAPS, SIZE

# Each format with the swizzle that suits two numbers, and what an independent tool decodes its blocks by.
TOOLS = {
    "bc5": ("rg", texture2ddecoder.decode_bc5),
    "bc7": ("rrrg", texture2ddecoder.decode_bc7),
    "eac_rg11": ("rg", texture2ddecoder.decode_eacrg),
    "astc_4x4": ("rrrg", lambda blocks, width, height: texture2ddecoder.decode_astc(blocks, width, height, 4, 4)),
}


def psnr_db(numbers, given):
    return 10 * np.log10(1 / np.mean((numbers.astype(np.float64) - given / 255) ** 2))


@pytest.mark.parametrize("name", MAPS)
@pytest.mark.parametrize("block", TOOLS)
def test_the_psnr_of_the_channels_is_what_another_tool_gives(block, name):
    """The same blocks by texture2ddecoder, which gives 8 bits: the same of BC7. EAC has 11 bits, BC5 is exact between
    its ends and ASTC is in 16-bit floats: on noise 8 bits hardly matter, on the smooth map they are 0.2 and 0.7 dB."""
    swizzle, tool = TOOLS[block]
    one = case(MAPS[name](), block, swizzle)
    (band,) = bands(one.normal_set)
    given = code_texels(one.codec, band)
    texels = Texels(one.swizzle.texels(given).tobytes(), (SIZE, SIZE), one.swizzle.read)
    blocks = one.block.encoder.encoded(texels)
    theirs = np.frombuffer(tool(blocks, SIZE, SIZE), np.uint8).reshape(SIZE, SIZE, 4)[..., [2, 1, 0, 3]]
    ours = one.swizzle.numbers(one.block.by_specification(blocks, (SIZE, SIZE)))
    (row,) = measure(one)
    assert row["code_psnr_db"] == pytest.approx(psnr_db(ours, given), abs=1e-9)
    apart = row["code_psnr_db"] - psnr_db(one.swizzle.numbers(theirs) / 255, given)
    most = {"bc7": 1e-4}.get(block, 0.1 if name == "grain" else {"astc_4x4": 0.7, "bc5": 0.2}.get(block, 0.1))
    assert abs(apart) < most, f"{apart} dB"
    if block == "bc5":
        cut = np.floor(ours.astype(np.float64) * 255 + 1e-3) / 255
        assert psnr_db(cut, given) == pytest.approx(psnr_db(one.swizzle.numbers(theirs) / 255, given), abs=1e-6)


def test_pictures_and_the_plot_show_something(run, tmp_path):
    words = ("--normals", "bumps", "--encoding", "xy", "--block", "bc5,bc7", "--images", str(tmp_path / "p"))
    status, *_ = run("maps", *words, "--plot", str(tmp_path / "plot.png"))
    found = sorted(path.name for path in (tmp_path / "p").iterdir())
    assert status == 0 and len(found) == 6 and "bumps-xy-bc7-rrrg-model-error.png" in found
    for path in [*(tmp_path / "p").iterdir(), tmp_path / "plot.png"]:
        pixels = np.asarray(Image.open(path).convert("RGB"))
        assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50 and pixels.mean() > 5, path.name
