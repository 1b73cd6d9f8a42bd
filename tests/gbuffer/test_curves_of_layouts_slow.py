"""Material attributes on a curve or in a light encoding: their effect on the image, and errors for bad requests."""

from dataclasses import replace

import pytest
from drawing import apart, draw
from test_curves_of_layouts import layout_of
from test_metal_rough import LIT

# Colours as dark as soil and rubber, where linear steps are coarsest.
DARK = replace(
    LIT, materials=tuple(replace(m, base=(0.03, 0.02, 0.04), metalness=0.0, normal_map=None) for m in LIT.materials)
)


@pytest.mark.parametrize(
    "scene, better, worse",
    [
        (DARK, "srgb(base_color):5", "base_color:5"),
        (DARK, "square_root(base_color):5", "base_color:5"),
        (LIT, "roughness:4", "squared(roughness):4"),
        (LIT, "linear:0.08(f0):4", "f0:4"),
    ],
    ids=["sRGB", "square root", "square", "range"],
)
def test_the_right_curve_gains_at_least_3_db_in_few_bits(gl, scene, better, worse):
    """Colours need a gamma, roughness needs equal steps, and an f0 of 0.04 needs its own range."""
    floats = {"base_color", "metallic", "roughness", "f0", "ao"} - {worse.rstrip("):45").split("(")[-1]}
    targets = "; ".join(f"rgba32f: {quantity}" for quantity in sorted(floats))
    right = draw(gl, "hybrid", scene).image
    decibels = [
        apart(draw(gl, "hybrid", scene, layout_of(f"rgba8: {w}; {targets}")).image, right) for w in (better, worse)
    ]
    assert 15 < decibels[1] < decibels[0] - 3 and decibels[0] < 75, f"{decibels[0]:.1f} and {decibels[1]:.1f} dB"
