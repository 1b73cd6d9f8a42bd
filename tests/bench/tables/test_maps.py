"""`normalbench maps`: the errors that block compression causes in normal maps, and refused requests."""

import json
from dataclasses import replace

import numpy as np
import pytest

from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS, from_arrays
from normalbench.bench.tables.maps.formats import FORMATS, SWIZZLES, swizzles_of
from normalbench.bench.tables.maps.measure import Clock, MapCase, bands, measure, through
from normalbench.bench.tables.maps.sets import MAPS
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS


def case(normals, block="bc5", swizzle="rg", encoding="xy", decoder="model"):
    return MapCase(ENCODINGS[encoding], FORMATS[block], SWIZZLES[swizzle], normals, decoder)


def small(height, width, covered=None):
    """Return the corner of the smooth map as a normal set."""
    n, _ = quality.image_of(MAPS["bumps"]())
    n = n[:height, :width]
    covered = np.ones((height, width), bool) if covered is None else covered
    return from_arrays("corner", "a corner", n, np.broadcast_to(np.float32([0, 0, -1]), n.shape), covered, n.shape[:2])


@pytest.mark.parametrize("block", FORMATS)
def test_only_real_texels_count_and_the_edge_is_repeated(block):
    """7 x 5 texels give the same figures as the real texels of 8 x 8 whose edge is repeated by hand."""
    odd = case(small(7, 5), block)
    (band,) = bands(odd.normal_set)
    assert band.n.shape[:2] == (8, 8) and np.array_equal(band.n[7, :5], band.n[6, :5])
    n = np.pad(quality.image_of(odd.normal_set)[0], [(0, 1), (0, 3), (0, 0)], mode="edge")
    view = np.broadcast_to(np.float32([0, 0, -1]), n.shape)
    even = from_arrays("even", "", n, view, np.ones((8, 8), bool), (8, 8))
    whole = through(replace(odd, normal_set=even), next(bands(even)), Clock())
    clock = Clock()
    assert np.array_equal(through(odd, band, clock), whole[:7, :5])
    assert (clock.texels, clock.numbers) == (64, 7 * 5 * 2) and measure(odd)[0]["count"] == 35


def test_texels_without_a_surface_are_flat_and_do_not_count():
    covered = np.ones((8, 8), bool)
    covered[:, 4:] = False
    map_case = case(small(8, 8, covered))
    (band,) = bands(map_case.normal_set)
    assert (band.n[:, 4:] == [0, 0, 1]).all()
    (row,) = measure(map_case)
    assert (row["count"], row["background"], row["invalid"]) == (32, 32, 0)


def test_swizzles_round_trip():
    numbers = np.random.default_rng(7).integers(0, 256, (4, 4, 3), np.uint8)
    for swizzle in SWIZZLES.values():
        given = numbers[..., : len(swizzle.read)]
        assert np.array_equal(swizzle.numbers(swizzle.texels(given)), given), swizzle.name


def test_two_channel_formats_offer_no_choice_of_swizzle():
    rrrg = [SWIZZLES["rrrg"]]
    assert [s.name for s in swizzles_of(FORMATS["bc5"], 2, rrrg)] == ["rg"]
    assert [s.name for s in swizzles_of(FORMATS["bc7"], 2, rrrg)] == ["rrrg"]
    assert [s.name for s in swizzles_of(FORMATS["bc3"], 2, [])] == ["dxt5nm"]
    assert not swizzles_of(FORMATS["eac_rg11"], 3, rrrg) and not swizzles_of(FORMATS["astc_4x4"], 3, rrrg)


def test_blocks_across_the_octahedral_fold_cause_the_long_tail():
    """In the scene with silhouettes the mean doubles, and the largest angle grows more than tenfold."""
    none, bc5 = (
        measure(case(NORMAL_SETS["playground"](0, 0), block, encoding="octahedral"))[0] for block in ("none", "bc5")
    )
    assert 1.5 < bc5["angle_mean_deg"] / none["angle_mean_deg"] < 2.5, bc5["angle_mean_deg"]
    assert bc5["angle_max_deg"] > 10 * none["angle_max_deg"], bc5["angle_max_deg"]


def test_an_encoding_that_does_not_fit_a_named_format_is_reported(run):
    status, out, err = run("maps", "--normals", "bumps", "--encoding", "xy,xyz", "--block", "bc5", "--format", "json")
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["xy"]
    assert "left out: xyz: 3 components, but BC5 has 2 channels" in err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--normals", "sphere"), "--normals sphere: not an image; use bumps, grain, playground, or an image file"),
        (("--block", "bc6"), "unknown block format 'bc6'"),
        (("--swizzle", "bgr"), "unknown swizzle 'bgr'"),
        (("--decoder", "gpu"), "unknown decoder 'gpu'"),
        (("--encoding", "xy_sign"), "xy_sign: the sign bit has no channel in a normal map"),
        (
            ("--encoding", "spherical_fibonacci"),
            "compression changes numbers slightly, and this encoding needs them exact",
        ),
        (("--encoding", "xyz", "--block", "bc5"), "xyz: 3 components, but BC5 has 2 channels"),
        (("--encoding", "xy", "--block", "bc7", "--swizzle", "rgb"), "xy in BC7: 2 components do not fit in rgb"),
        (("--normals", "none.png"), "none.png: there is no such file"),
    ],
)
def test_bad_input_is_a_one_line_error(run, words, said):
    status, out, err = run("maps", *words)
    assert (status, out, err.count("\n")) == (2, "", 1) and said in err, err


def test_a_gate_can_check_a_row(run, tmp_path):
    gate = '[[gate]]\ntable = "maps"\nencoding = "xy"\nblock = "{}"\nangle_mean_deg = "at most 0.5"\n'
    for block, status in (("bc5", 0), ("eac_rg11", 1)):
        (tmp_path / "gates.toml").write_text(gate.format(block))
        assert run("check", str(tmp_path / "gates.toml"))[0] == status, block
