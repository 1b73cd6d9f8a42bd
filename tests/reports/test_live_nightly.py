"""The laboratory of a page in a browser with WebGL 2: controls, pixels, encoders and recovery from faults."""

import numpy as np
import pytest
import test_live_slow
from browsing import PHONE, Laboratory
from test_live_slow import apart


def test_the_turntable_turns_until_it_is_stopped(laboratory):
    assert laboratory.page.locator("[data-see=turn]").get_attribute("aria-pressed") == "false", "nothing moves at first"
    before = laboratory.picture()
    laboratory.press("[data-see=turn]", "Space")
    laboratory.page.wait_for_timeout(600)
    laboratory.press("[data-see=turn]", "Space")
    still = laboratory.picture()
    assert apart(still, before) > 0.05
    laboratory.page.wait_for_timeout(300)
    assert (laboratory.picture() == still).all()


def test_narrow_windows_and_dense_screens_are_drawn(gl_browser, report, laboratory):
    wide = laboratory.picture().shape
    laboratory.page.set_viewport_size({"width": 500, "height": 700})
    laboratory.page.wait_for_timeout(200)
    laboratory.settle()
    assert laboratory.picture().shape[1] < wide[1]
    assert apart(laboratory.picture(), np.zeros(3, int)) > 0.8
    dense = Laboratory(gl_browser, report, PHONE, scale=3, theme="dark")
    assert dense.picture().shape[1] == 3 * PHONE[0], "three pixels for one"
    assert apart(dense.picture(), np.zeros(3, int)) > 0.8
    assert dense.page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "nothing is wider than a phone"
    dense.context.close()


def test_a_reset_laboratory_matches_a_newly_opened_one(gl_browser, report, laboratory):
    """The tests here share a page, but no test may see what another has done."""
    fresh = Laboratory(gl_browser, report)
    expected, picture = fresh.state(), fresh.picture()
    fresh.context.close()
    began = laboratory.page.evaluate("performance.timeOrigin")
    assert laboratory.state() == expected
    laboratory.choose(left="xy rgba8", right="spherical rgba8", subject="0", shown="code")
    laboratory.press("[data-see=power]", "PageDown")
    laboratory.press("[data-see=divider]", "End")
    laboratory.press("[data-see=turn]", "Space")
    laboratory.page.set_viewport_size({"width": 500, "height": 700})
    laboratory.page.locator("[data-own=text]").fill("no encoder")
    laboratory.says("[data-own=said]", "There is no encoder")
    laboratory.page.locator("[data-own=storage]").select_option("rg16")
    laboratory.page.locator("[data-inspect=x]").fill("7")
    laboratory.page.locator("#measure-times").dispatch_event("click")
    laboratory.page.evaluate("live.measuring.codecs = live.measuring.codecs.slice(0, 1)")
    laboratory.page.locator("[data-measure]").click()
    laboratory.page.wait_for_selector("[data-save]")
    assert laboratory.state() != expected
    laboratory.reset()
    assert laboratory.state() == expected and (laboratory.picture() == picture).all()
    assert laboratory.page.evaluate("performance.timeOrigin") == began, "not loaded anew"
    laboratory.page.evaluate("live.data.checks.sums.sphere[0] ^= 1")
    laboratory.reset()
    assert laboratory.state() == expected
    assert laboratory.page.evaluate("performance.timeOrigin") != began, "loaded anew"


@pytest.mark.parametrize("encoding", ["spherical", "xy"])
def test_bits_of_a_pixel_match_the_emulation_for_more_encodings(laboratory, encoding):
    test_live_slow.test_bits_of_a_pixel_match_the_emulation(laboratory, encoding)
