"""Engine layouts: their encodings have the errors measured for them elsewhere, and all layouts render."""

from dataclasses import replace
from itertools import accumulate

import numpy as np
import pytest

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.tables.quality.measure import round_trip
from normalbench.encodings.catalogue import ENCODINGS, LIGHT_BUFFERS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.rules import storage_of
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.layouts.layout import Layout
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import LayoutError, Target, least_carried, spelt_out
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import check, rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

ENGINES = [name for name, layout in LAYOUTS.items() if layout.engine]


GLOSS = SCENES["gloss"].make(Setting(lights=4))


# Mean, RMS and largest angle on 2 M uniform directions and the error of the six axes, in degrees, measured outside of
# this project with NumPy in float64. Of the axes of nrd 0.028 was given: UNORM has no code for 0, so +z is 1/1023 off
# of a radian, whichever way its two numbers round.
FIGURES = {
    "nrd": ("signed_octahedral", "rgb10a2", "nearest", 0.0596, 0.0652, 0.1361, 0.056),
    "nrd_rgba8": ("xyz_largest", "rgba8", "nearest", 0.1320, 0.1432, 0.3153, 0.318),
    "nrd_rgba8_snorm": ("xyz_largest", "rgba8_snorm", "nearest", 0.1326, 0.1438, 0.3176, 0.0),
    "nrd_rgba16": ("xyz_largest", "rgba16", "nearest", 0.0005, 0.0006, 0.0012, 0.0012),
    "nrd_rgba16_snorm": ("xyz_largest", "rgba16_snorm", "nearest", 0.0005, 0.0006, 0.0012, 0.0),
    "wicked": ("octahedral", "r11g11b10f", "nearest", 0.4728, 0.5577, 1.8728, 0.0),
    "wicked_truncated": ("octahedral", "r11g11b10f", "truncate", 0.9673, 1.1538, 3.7666, 0.0),
    "wicked_particles": ("xyz_renormalised", "rgba8", "truncate", 0.3389, 0.3668, 0.7685, 0.318),
    "skyrim_community": ("octahedral", "rgb10a2", "nearest", 0.0836, 0.0921, 0.2362, 0.079),
    "donut": ("xyz_renormalised", "rgba16_snorm", "nearest", 0.0007, 0.0007, 0.0015, 0.0),
    "remix": ("octahedral", "rg16_snorm", "nearest", 0.0013, 0.0014, 0.0037, 0.0),
    "capsaicin": ("xyz_renormalised", "rgba8", "nearest", 0.1697, None, 0.3838, 0.318),
    "capsaicin_rays": ("xyz_renormalised", "rgba8_10_10_10_snorm", "nearest", 0.0423, 0.0458, 0.0961, 0.0),
    "eevee_next": ("octahedral", "rg16", "nearest", 0.0013, 0.0014, 0.0037, 0.0012),
    "o3de": ("signed_octahedral", "rgb10a2", "nearest", 0.0596, 0.0652, 0.1365, 0.056),
    "xegtao": ("xyz_renormalised", "rgba8_11_11_10", "nearest", 0.0294, 0.0323, 0.0677, 0.063),
    "bevy_prepass": ("xyz_renormalised", "rgb10a2", "nearest", 0.0422, None, 0.0966, 0.079),
    "timberdoodle": ("octahedral", "rgb8_12_12", "nearest", 0.0209, None, None, 0.020),
}


# Bytes a pixel of the targets, and with the light buffer where that was read; what says how much a surface reflects.
# From each engine's source, counted by hand. r3d takes three bytes less where three numbers are not padded.
BASE, SPECULAR, F0 = "base colour, metallic", "base colour, metallic, F0", "diffuse colour, F0"


WHOLE = {
    "unreal4": (16, 24, SPECULAR),
    "unreal5_mobile": (12, 16, SPECULAR),
    "unreal5_substrate": (12, 20, F0),
    "unity_hdrp": (12, 16, F0),
    "unity_urp": (12, 16, BASE),
    "unity_urp_accurate": (12, 16, BASE),
    "bevy": (17, None, SPECULAR),
    "flax": (12, 16, SPECULAR),
    "donut": (28, None, F0),
    "granite": (10, 14, BASE),
    "kajiya": (28, None, BASE),
    "kajiya_truncated": (28, None, BASE),
    "dagor": (20, None, SPECULAR),
    "spartan": (24, None, BASE),
    "second_life": (16, None, BASE),
    "r3d": (26, None, SPECULAR),
    "o3de": (20, None, BASE),
    "fidelityfx": (20, None, BASE),
    "cocos": (24, None, BASE),
    "hybrid_rendering": (20, None, BASE),
    "remix": (21, None, F0),
}


def plan(layout: Layout, **changes) -> Plan:
    return replace(Plan((96, 72), 1, layout, LIGHT_BUFFERS["rgba16f"], 2, True, 1.0), **changes)


def test_at_least_forty_presets_name_their_engine_and_source():
    assert len(LAYOUTS) >= 40 and len(ENGINES) >= 40
    assert all(LAYOUTS[name].source for name in ENGINES)


@pytest.mark.parametrize("name", FIGURES)
def test_the_encoding_of_a_preset_has_the_axis_error_measured_elsewhere(name):
    """The largest error of the six axis directions."""
    encoding, storage, rounding, *_, wanted = FIGURES[name]
    codec = Codec(ENCODINGS[encoding], storage_of(storage) or STORAGES[storage], rounding)
    n = np.concatenate([np.eye(3), -np.eye(3)]).astype(np.float32)
    got = angles_deg(n, round_trip(codec, n, n)).max()
    assert abs(got - wanted) <= max(0.01 * wanted, 0.6e-3), f"{got:.5f}, {wanted} outside"


def test_a_complete_layout_has_the_bytes_of_its_engine():
    """The layout also stores reflectance as its engine does."""
    figures = {
        name: (layout.bytes_per_pixel, layout.bytes_with_light, layout.reflects_by)
        for name, layout in LAYOUTS.items()
        if layout.is_whole
    }
    assert figures == WHOLE


def test_refusal_of_an_unsuitable_pipeline_names_a_suitable_pipeline(gl):
    granite = plan(LAYOUTS["granite"])
    message = r"^hybrid needs shading_model, which layout granite does not store; --pipeline deferred does not need it$"
    with pytest.raises(LayoutError, match=message):
        check(gl, PIPELINES["hybrid"], granite, is_metal_rough=True)


def test_the_title_of_a_normal_only_layout_says_so():
    others = [LAYOUTS[name] for name in ENGINES if not LAYOUTS[name].is_whole]
    assert len(others) > 20 and all(layout.title.startswith(f"the normal of {layout.engine}: ") for layout in others)


@pytest.mark.parametrize("name", LAYOUTS)
def test_a_presets_fields_take_all_bits_of_their_formats(name):
    """The layout specifies all bits of a texel; unused bits are marked as free."""
    for target in LAYOUTS[name].targets:
        bits, taken = target.storage.bits, 0
        ends = list(accumulate(bits))
        for word in spelt_out(name, target):
            size = word.rpartition(")")[2].rpartition(":")[2]
            taken += int(size) if size.isdecimal() else bits[ends.index(taken) + 1 if taken else 0]
        assert taken == sum(bits), f"{name}, {target.format}: {target.holds}"


@pytest.mark.parametrize(
    "format", ["rgba8", "rgba8_snorm", "rgb10a2", "rgba16", "rgba16f", "r11g11b10f", "r16f", "r32f"]
)
@pytest.mark.parametrize("quantity", ["roughness", "power"])
def test_a_quantity_can_store_the_sign_of_the_normal(gl, format, quantity):
    """Every normal keeps its side, even with a quantity of 0, in every format that can store a sign this way."""
    word = f"{quantity}*normal.z"
    carried, plain = (
        Layout("mine", "", (Target("rgba16", "normal.x normal.y" + own), home), ENCODINGS["signed_octahedral"], "")
        for own, home in (("", Target(format, word)), (" normal.z", Target("rgba32f", quantity)))
    )
    normals = []
    for layout in (carried, plain):
        with rendering(gl, PIPELINES["prepass"], GLOSS, plan(layout)) as drawing:
            drawing.draw()
            normals.append(drawing.gbuffer()[1][..., :3])
    assert np.array_equal(*normals), f"{np.mean(normals[0] != normals[1]):.3%} of the numbers differ"
    storage = carried.targets[1].storage
    least = least_carried(storage, storage.bits[0])
    assert 0 < least < 0.05 and len(np.unique(np.sign(normals[1][..., 2]))) > 1
