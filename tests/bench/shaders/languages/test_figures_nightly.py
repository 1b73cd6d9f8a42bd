"""Engines' encoders, written in HLSL from their definitions and compared with published figures."""

import pytest
from test_figures import FILES, PUBLISHED, angles

pytestmark = pytest.mark.usefixtures("gl", "hlsl")


@pytest.mark.parametrize("name", [name for name, row in PUBLISHED.items() if row[4]])
def test_an_engines_encoder_has_its_published_largest_angle(name):
    """The angle is measured on two million directions, as published."""
    *_, mean, most = PUBLISHED[name]
    own, _ = angles(name, 2_000_000, FILES / f"{name}.hlsl")
    assert own == pytest.approx((mean, most), rel=0.01), f"{name}: {own}, published {mean} and {most}"
