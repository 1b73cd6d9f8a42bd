"""`normalbench mix`: what filters, mip levels, resolves and blending make of stored codes."""

from ast import literal_eval

import numpy as np
import pytest
import test_mix
from test_mix import angle_deg, on_sphere


@pytest.mark.parametrize("storage", ["rg16", "rg16f", "rgba32f", "rgb8_12_12"])
@pytest.mark.usefixtures("gl")
def test_device_and_model_agree_or_the_row_says_how_the_device_mixes_in_wider_storages(storage):
    test_mix.test_device_and_model_agree_or_the_row_says_how_the_device_mixes(storage)


@pytest.mark.usefixtures("gl", "radv")
def test_pick_leaves_out_what_does_not_survive(run):
    words = ("pick", "--encoding", "octahedral,xy_sign", "--storage", "rg8", "--count", "4096")
    status, out, _ = run(*words)
    assert status == 0 and "take octahedral" in out and "cannot be" not in out
    status, out, _ = run(*words, "--needs", "filter")
    text = " ".join(out.split())
    assert status == 1 and "no code qualifies (that survives filter)" in text, text
    assert "(cannot be filtered; octahedral: normals 1 degree apart on axes" in text, text
    status, out, _ = run(*words, "--needs", "filter", "--domain", "hemisphere")
    assert status == 0 and "take octahedral" in out
    status, out, _ = run(*words, "--needs", "upsample")
    assert status == 0 and "take octahedral" in out and "no code minds" in " ".join(out.split())


def check_the_worst_mixes(*operations):
    """Means of octahedral codes on opposite corners of the square, which are -z, are +z: 180 degrees off. A code
    without a seam in its domain stays within what its texels alone and its kinks explain."""
    for name, least, most in (("octahedral/rg8", 179.0, 180.0), ("hemi_octahedral/rg8", 1.0, 3.5)):
        for row in on_sphere(name, operations, worst_case=True):
            assert row["angle_max_deg"] <= row["angle_worst_deg"] and least <= row["angle_worst_deg"] <= most, row
            right, result = (np.array(literal_eval(row[f"worst_{which}"])) for which in ("right", "result"))
            assert angle_deg(right, result / np.linalg.norm(result)) == pytest.approx(row["angle_worst_deg"], abs=0.2)


def test_the_worst_mix_is_searched_for_and_named():
    check_the_worst_mixes("filter", "blend")
    (row,) = on_sphere("octahedral/rg8", ("filter",))
    assert row["angle_worst_deg"] is None and row["angle_max_deg"] < 179, "a sample misses it"
