"""The laboratory's window in a browser: presets, camera control, readers' files, addresses and images."""

import numpy as np
import pytest
import test_see_slow


def test_wobble_runs_once_with_reduced_motion(laboratory):
    """The page is opened with reduced motion."""
    page = laboratory.page
    before = laboratory.picture()
    page.locator("[data-see=wobble]").click()
    page.wait_for_timeout(700)
    assert page.locator("[data-see=wobble]").get_attribute("aria-pressed") == "true"
    assert laboratory.picture().shape != before.shape or (laboratory.picture() != before).any()
    page.evaluate("() => { live.see.wobbled = 0.999; }")
    page.wait_for_selector("[data-see=wobble][aria-pressed=false]")
    laboratory.settle()
    assert (laboratory.picture() == before).all(), "it comes back to where it was"


@pytest.mark.parametrize(("packing", "kind"), [("ZIPS", np.float16), ("ZIP", np.float16)])
def test_an_exr_of_half_float_normals_is_read_to_its_last_bit(laboratory, packing, kind):
    test_see_slow.test_an_exr_of_normals_is_read_to_its_last_bit(laboratory, packing, kind)


def test_surroundings_from_an_uncompressed_hdr_file_are_reflected(laboratory):
    test_see_slow.test_surroundings_from_a_file_are_reflected(laboratory, "plain hdr")
