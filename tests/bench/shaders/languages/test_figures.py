"""Engines' encoders, written in HLSL from their definitions and compared with published figures."""

import shutil
from pathlib import Path

import pytest

import normalbench as nb

pytestmark = pytest.mark.usefixtures("gl", "hlsl")


FILES = Path(__file__).parents[3] / "inputs" / "hlsl"


# The catalogue's encoding of the same code, storage and rounding; then mean and largest angle in degrees of two million
# uniform directions, computed by NumPy in float64 from the engines' bit layouts. None: no figure with three digits.
PUBLISHED = {
    "o3de": ("signed_octahedral", "rgb10a2", "nearest", 0.0596, 0.1365),
    "nrd": ("xyz_largest", "rgba8", "nearest", 0.1320, 0.3153),
    "nrd_snorm": ("xyz_largest", "rgba8_snorm", "nearest", 0.1326, 0.3176),
    "wicked": ("octahedral", "r11g11b10f", "nearest", 0.4728, 1.8728),
    "wicked_xyz": ("xyz_renormalised", "rgba8", "truncate", 0.3389, 0.7685),
    "skyrim": ("octahedral:sign=-1", "rgb10a2", "nearest", 0.0836, 0.2362),
    "dbuffer": ("xyz_renormalised", "rgba8", "nearest", 0.1697, 0.3838),
    "xegtao": ("xyz_renormalised", "rgba8_11_11_10", "nearest", 0.0294, 0.0677),
    "hdrp": ("octahedral", "rgb8_12_12", "nearest", 0.0209, None),
    "octahedral": ("octahedral", "rg8", "nearest", 0.3355, 0.95),
    "donut": ("xyz_renormalised", "rgba16_snorm", "nearest", None, None),
    "spheremap": ("spheremap", "rg8", "nearest", None, None),
}


def angles(name: str, count: int, file: Path):
    """Return (mean, largest) angles of a file, and of the catalogue's encoding with the same code."""
    catalogues, storage, rounding, *_ = PUBLISHED[name]
    table = nb.quality(
        encoding=f"{file},{catalogues}",
        storage=storage,
        rounding=rounding,
        normals="sphere",
        backend="glsl",
        arithmetic="float",
        count=count,
    ).set_index("encoding")
    (own,) = set(table.index) - {catalogues}
    return [tuple(table.loc[each, ["angle_mean_deg", "angle_max_deg"]]) for each in (own, catalogues)]


def test_every_file_has_figures():
    assert {path.stem for path in FILES.glob("*.hlsl")} == set(PUBLISHED)


@pytest.mark.parametrize("name", PUBLISHED)
def test_an_engines_encoder_has_its_published_mean(name):
    """The mean and largest angles also agree with the catalogue's encoding."""
    mean = PUBLISHED[name][3]
    own, catalogues = angles(name, 65536, FILES / f"{name}.hlsl")
    assert own == pytest.approx(catalogues, rel=1e-3), f"{name}: {own}, by the catalogue {catalogues}"
    assert mean is None or own[0] == pytest.approx(mean, rel=0.01), f"{name}: {own[0]}, published {mean}"


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("name", ["wicked", "octahedral", "o3de"])
def test_slang_gives_the_same_figures_as_hlsl_for_the_same_text(name, tmp_path):
    """Slang reads HLSL, and integers and halves keep their meaning."""
    copy = Path(shutil.copy(FILES / f"{name}.hlsl", tmp_path / f"{name}.slang"))
    assert angles(name, 65536, copy)[0] == pytest.approx(angles(name, 65536, FILES / f"{name}.hlsl")[0], rel=1e-5)
