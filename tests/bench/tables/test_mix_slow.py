"""`normalbench mix`: what filters, mip levels, resolves and blending make of stored codes."""

import pytest
import test_mix


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
