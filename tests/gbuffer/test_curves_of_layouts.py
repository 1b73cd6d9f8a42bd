"""Material attributes on a curve or in a light encoding: their effect on the image, and errors for bad requests."""

from dataclasses import replace

import numpy as np
import pytest
from drawing import SIZE, apart, draw
from test_metal_rough import LIT

from normalbench.encodings.catalogue import CURVE_ENCODINGS, ENCODINGS, LIGHT_BUFFERS
from normalbench.encodings.light import rgbm
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.kept import WHOLE
from normalbench.gbuffer.layouts.layout import Layout, read_layout
from normalbench.gbuffer.layouts.words import LayoutError, targets_of
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering

NORMAL = "rgba32f: normal.x normal.y shading_model"


def layout_of(targets: str) -> Layout:
    return Layout("kept", "kept", targets_of(f"{NORMAL}; {targets}"), ENCODINGS["octahedral"], "test")


def image(gl, targets: str, pipeline: str = "hybrid") -> np.ndarray:
    return draw(gl, pipeline, LIT, layout_of(targets)).image


@pytest.fixture(scope="module")
def exact(gl) -> np.ndarray:
    return image(gl, "rgba32f: base_color metallic; rgba32f: roughness f0 ao; rgba32f: emissive")


@pytest.mark.parametrize("name", CURVE_ENCODINGS)
def test_a_curve_in_floats_does_not_change_the_image(gl, exact, name):
    """With every quantity on the curve: above 75 dB. The fast curve is not exactly undone: 55 to 75 dB. `ray_bits`
    has only nine values: 10 to 55 dB."""
    on = {q: f"{name}({q})" for q in ("base_color", "metallic", "roughness", "f0", "ao", "emissive")}
    targets = "rgba32f: {base_color} {metallic}; rgba32f: {roughness} {f0} {ao}; rgba32f: {emissive}"
    decibels = apart(image(gl, targets.format(**on)), exact)
    off = CURVE_ENCODINGS[name].inverse_error
    least, most = (75, np.inf) if not off else (55, 75) if off < 0.01 else (10, 55)
    assert least < decibels <= most, f"{decibels:.1f} dB"


@pytest.mark.parametrize("pipeline", ["deferred", "hybrid"])
@pytest.mark.parametrize("name", WHOLE)
def test_a_layout_can_store_emissive_light_in_a_light_encoding(gl, exact, pipeline, name):
    """The image is above 40 dB, as with the light buffer, but not exact."""
    others = "rgba32f: base_color metallic; rgba32f: roughness f0 ao"
    decibels = apart(image(gl, f"{others}; rgba8: {name}(emissive)", pipeline), exact)
    assert 40 < decibels < 90, f"{decibels:.1f} dB"


def test_two_ranges_of_one_light_encoding_are_refused(gl):
    """The shader files have only one range, so the light buffer would use the range of the emissive attribute."""
    layout = layout_of("rgba32f: base_color metallic; rgba32f: roughness f0 ao; rgba8: rgbm(emissive)")
    buffer = replace(LIGHT_BUFFERS["rgbm"], encoding=rgbm.ranged(8.0))
    plan = Plan(SIZE, 1, layout, buffer, 2, False, 1.0)
    with pytest.raises(LayoutError, match="emissive and the light buffer rgbm:8 have different ranges"):
        rendering(gl, PIPELINES["hybrid"], LIT, plan).__enter__()


@pytest.mark.parametrize(
    "targets, message",
    [
        ("rgba8: gamma(roughness)", "unknown curve 'gamma'; known: linear, squared, square_root"),
        (
            "rgba8: squared(shading_model)",
            "only base_color, f0.rgb, emissive, roughness, metallic, f0, ao, motion can use a curve",
        ),
        ("rgba8: squared:0(roughness)", "a range must be 0.001 to 65504, not 0"),
        ("rgba8: squared:e(roughness)", "a range must be 0.001 to 65504, not e"),
        ("rgba8: squared:nan(roughness)", "a range must be 0.001 to 65504, not nan"),
        ("rgba8: squared:(roughness)", "a range must be 0.001 to 65504, not "),
        ("rgba8: squared(square_root(roughness))", "write a curve as"),
        ("rgba8: squared(roughness", r"squared\(roughness: write a curve as squared\(roughness\)"),
        ("srgb8_a8: square_root(base_color)", "sRGB8 A8 already applies its own curve to colours"),
        ("rgba8: srgb(base_color.r) base_color.g base_color.b", "all channels of base_color must use the same curve"),
        ("rgba8: rgb9e5(base_color)", r"rgb9e5 stores light in a whole texel; write rgb9e5\(emissive\)"),
        ("rgba8: metallic; rgba16f: rgb9e5(emissive)", r"rgb9e5\(emissive\) must be alone in its target, of format"),
        ("rgba8: emissive.r emissive.g emissive.b emissive.a", "an encoding of light has four components"),
        ("rgba8: rgb9e5(emissive.r) metallic", r"write rgb9e5\(emissive\), which uses the whole target"),
        ("rgba8: rgb9e5(emissive):8", "each component of rgb9e5 needs its own channel"),
    ],
)
def test_invalid_curve_is_refused_with_the_reason(targets, message):
    with pytest.raises(LayoutError, match=message):
        layout_of(targets)


def test_a_layout_file_names_curves_like_presets(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(
        'encoding = "octahedral"\n[[targets]]\nformat = "rg16"\nholds = "normal.x normal.y"\n'
        '[[targets]]\nformat = "rgba8"\nholds = "square_root(base_color) inverted(roughness)"\n'
    )
    kept = read_layout(path).kept
    assert {name: (how.encoding.name, how.range) for name, how in kept.items()} == {
        **{f"base_color.{channel}": ("square_root", 1.0) for channel in "rgb"},
        "roughness": ("inverted", 1.0),
    }
