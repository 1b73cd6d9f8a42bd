"""The path to a display: exposure, tone mapping, clipping and the sRGB curve."""

import numpy as np
import pytest

from normalbench.gbuffer.display import Display, displayed, measured_exposure

LIGHT = np.array([0.0, 0.0031308, 0.18, 0.5, 1.0, 4.0])


@pytest.mark.parametrize(
    "display, expected",
    [
        # Light itself.
        (Display(), LIGHT),
        # Stops are powers of two.
        (Display(-2.0), LIGHT / 4),
        # x / (1 + x)
        (Display(0.0, "reinhard"), [0.0, 0.0031210, 0.1525424, 1 / 3, 0.5, 0.8]),
        (Display(1.0, "reinhard"), [0.0, 0.0062226, 0.2647059, 0.5, 2 / 3, 8 / 9]),
        # Narkowicz' fit: 0.18 is shown as 0.0867240 / 0.3249320 = 0.267, 4 as 40.28 / 41.38.
        (Display(0.0, "aces"), [0.0, 0.0008355, 0.2668989, 0.6163069, 0.8037975, 0.9734171]),
    ],
)
def test_light_is_exposed_and_tone_mapped(display, expected):
    assert display.light(LIGHT) == pytest.approx(expected, abs=2e-7)


def test_the_display_curve_is_srgb():
    """IEC 61966-2-1: 0.18 is 117.6 of 255, half is 187.5; values below 0 and above 1 are clipped."""
    assert displayed(np.array([-1.0, 0.0, 0.18, 0.5, 1.0, 9.0])) * 255 == pytest.approx(
        [0, 0, 117.6, 187.5, 255, 255], abs=0.05
    )
    assert np.isnan(displayed(np.array([np.nan]))).all()


@pytest.mark.parametrize("seed", range(20))
def test_a_measured_exposure_is_the_largest_that_clips_at_most_one_percent(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 3000))
    linear = np.exp(rng.normal(rng.uniform(-8, 8), rng.uniform(0, 3), (count, 3)))
    stops = measured_exposure(linear)
    assert Display(stops).clipped(linear) <= 0.01
    # A hundredth of a stop more: as many pixels as one more than the hundredth lie at the limit.
    most = np.sort(linear.max(axis=-1))[int(np.ceil(0.99 * (count - 1)))]
    assert most * 2.0 ** (stops + 0.01) > 1 >= most * 2.0**stops


def test_dark_and_non_finite_images_have_an_exposure():
    assert measured_exposure(np.zeros((9, 3))) == 0
    assert measured_exposure(np.zeros((0, 3))) == 0
    assert measured_exposure(np.array([[np.inf, 1, 1], [np.nan, 1, 1], [1, 0.5, 0.25]])) == 0
