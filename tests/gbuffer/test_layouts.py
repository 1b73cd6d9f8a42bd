"""Layouts: field positions, conflicts, and presets that return every value to within the precision of its bits."""

from dataclasses import replace
from functools import cache

import jax.numpy as jnp
import numpy as np
import pytest

from normalbench.encodings.catalogue import DEPTH_ENCODINGS, ENCODINGS, LIGHT_BUFFERS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.depth_codec import DepthCodec
from normalbench.encodings.shared.position import Camera
from normalbench.encodings.storages.depth_storage import DEPTH_STORAGES
from normalbench.encodings.storages.storage import FORMS, STORAGES
from normalbench.encodings.vec import Vec3, from_array, to_array
from normalbench.gbuffer.display import displayed
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.frame.resources import GBUFFER
from normalbench.gbuffer.gl.device import device
from normalbench.gbuffer.layouts.layout import Layout, read_layout
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import PACKINGS, SIGNED, LayoutError, Target, placed
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import check, rendering
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.scene import KINDS
from normalbench.gbuffer.scenes.setting import Setting

ROOM = SCENES["room"].make(Setting(lights=2))


HAIR = KINDS.index("hair")


def plan(layout: Layout, **changes) -> Plan:
    return replace(Plan((160, 120), 1, layout, LIGHT_BUFFERS["rgba32f"], 2, False, 1.0), **changes)


@cache
def kept(name: str) -> list[np.ndarray]:
    """Return the decoded G-buffer of a layout in the room: position, direction, albedo and power, specular."""
    with rendering(device(), PIPELINES["prepass"], ROOM, plan(LAYOUTS[name])) as drawing:
        drawing.draw()
        return drawing.gbuffer()


def layout(*targets: Target, encoding: str = "octahedral", **more) -> Layout:
    return Layout("mine", "mine", targets, ENCODINGS[encoding], "a test", **more)


@pytest.mark.parametrize("name", LAYOUTS)
def test_a_preset_has_a_title_and_a_source(name):
    preset = LAYOUTS[name]
    assert preset.name == name and preset.title and preset.source
    assert 4 <= preset.bytes_per_pixel <= 64 and preset.normal_bits >= 16


def test_words_fill_a_target_in_order_from_the_most_significant_bit():
    """11:10:11 in RGBA8: y starts at bit 11, z at bit 21."""
    words = {w.component: (w.target, w.first, w.bits) for w in LAYOUTS["kajiya"].words}
    assert words["normal.x"] == (1, 0, 11) and words["normal.y"] == (1, 11, 10) and words["normal.z"] == (1, 21, 11)
    assert words["base_color.g"] == (0, 1, 0), "a word without bits counts channels"


def test_a_sign_in_the_depth_counts_as_one_bit_of_the_normal():
    assert LAYOUTS["xy_depth_sign"].normal_bits == 2 * 16 + 1


@pytest.mark.parametrize(
    "targets, more, said",
    [
        ([("rgba8", "normal.x normal.y normal.x")], {}, "normal.x is stored twice"),
        ([("rgba8", "normal.x normal.y depth:24")], {}, "more than its 32 bits"),
        ([("rg8", "normal.x normal.y power")], {}, "more than its 16 bits"),
        ([("rgba8", "normal.x depth")], {}, "octahedral needs exactly normal.x, normal.y"),
        ([("rgba8", "normal.x normal.y normal.z")], {}, "octahedral needs exactly normal.x, normal.y"),
        ([("rgba8", "normal.x:12 normal.y:12 colour")], {}, "unknown component 'colour'"),
        ([("rgba8", "normal.x:12 normal.y power:8")], {}, "starts within a channel"),
        ([("rgba16f", "normal.x:12 normal.y:12")], {}, "UNORM or integer channels"),
        ([("rgba8", "normal.x:30")], {}, "up to 24 bits"),
        ([("rgba8", "normal.x:0 normal.y:12")], {}, "at least 1 bit"),
        ([("rgba8", "normal.x:99999 normal.y:12")], {}, "unknown component"),
        ([("rgba8", "normal.x:12 normal.y:12 kind:1")], {}, "shading_model needs 2 bits, not 1"),
        ([("rgba8", "normal.x:12 normal.y:12 instance:4")], {}, "instance needs 8 bits, not 4"),
        ([("rgba8", "normal.x:12 normal.y:12 depth:1")], {"encoding": "xy_sign"}, "depth needs 2 bits, not 1"),
        ([("rgba16f", "normal.x normal.y")], {"encoding": "octahedral_precise"}, "only precise rounding"),
        ([("rgba8", "normal.x:8 normal.y:8 normal.z:1")], {"encoding": "tetrahedral"}, "normal.z has 4 values"),
        (
            [("rg8", "normal.x normal.y"), ("r11g11b10f", "depth")],
            {"encoding": "xy_sign"},
            "cannot store the sign that depth needs",
        ),
        ([("rgb555", "normal.x normal.y")], {}, "unknown format 'rgb555'; known: rgba8"),
        ([("rgba8", "normal.x normal.y kind*normal.z")], {}, "only depth, power, roughness can store a sign"),
        ([("rgba8", "normal.x roughness*normal.y")], {}, "normal.y of octahedral is not a sign"),
        (
            [("rgba8", "normal.x normal.y normal.z roughness*normal.z")],
            {"encoding": "signed_octahedral"},
            "signed_octahedral needs exactly normal.x, normal.y, normal.z",
        ),
        (
            [("rgba8", "normal.x normal.y roughness*normal.z power*normal.z")],
            {"encoding": "signed_octahedral"},
            "a layout can have only one quantity with a sign",
        ),
        ([("srgb8_a8", "normal.x normal.y")], {}, "the first three channels of sRGB8 A8 can hold only colours"),
        ([("srgb8_a8", "albedo.r:8 normal.y")], {}, "UNORM or integer channels"),
        ([("rg8", "normal.x normal.y"), ("rgba8", "other:40")], {}, "more than its 32 bits"),
        ([("rg16f", "normal.x normal.y")], {"encoding": "xy_sign"}, "has no depth"),
        ([("rg16f", "normal.x normal.y")], {"space": "tangent"}, "unknown space 'tangent'; known: view, world"),
        ([("rg16f", "normal.x normal.y")], {"rounding": "up"}, "unknown rounding 'up'"),
        ([("rg16f", "normal.x normal.y")], {"packing": "up"}, "unknown packing 'up'"),
        ([("rg16f", "normal.x normal.y")], {"rounding": "dithered"}, "float steps are uneven"),
        ([("rgba8", "normal.x:12 normal.y:12 -")], {"rounding": "dithered"}, "one channel per component"),
        (
            [("rg16f", "normal.x normal.y"), ("r32f", "depth")],
            {"depth": DEPTH_ENCODINGS["linear_sign"]},
            "cannot be used with octahedral",
        ),
        (
            [("rg16f", "normal.x normal.y"), ("r32f", "depth")],
            {"encoding": "xy_sign", "depth": DEPTH_ENCODINGS["logarithmic"]},
            "cannot be used with xy_sign; use linear_sign",
        ),
    ],
)
def test_conflicting_layout_is_a_one_line_error(targets, more, said):
    with pytest.raises(LayoutError) as caught:
        layout(*(Target(*target) for target in targets), **more)
    assert said in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text, said",
    [
        ("title = 'x", "this is not TOML"),
        ("title = " + "9" * 5000, "a number has too many digits"),
        ("targets = " + "[" * 100_000, "nested too deep"),
        ("encoding = 'octahedral'", "targets must be a list of tables"),
        ("encoding = 'octahedral'\n[[targets]]\nformat = 'rg8'", "targets must be a list of tables"),
        ("encoding = 'octahedral'\n[[targets]]\nformat = 'rg8'\nholds = 3", "targets must be a list of tables"),
        ("[[targets]]\nformat = 'rg8'\nholds = 'normal.x normal.y'", "encoding must be given"),
        ("encoding = 'octahedral'\ncolour = 3\n[[targets]]\nformat = 'rg8'\nholds = 'normal.x normal.y'", "'colour'"),
        ("encoding = 'octahedral'\n[[targets]]\nformat = 'rg8'\nholds = 'normal.x'", "octahedral needs"),
        (
            "encoding = 'octahedral:axis=w'\n[[targets]]\nformat = 'rg8'\nholds = 'normal.x'",
            "axis is x, y or z, not 'w'",
        ),
        ("encoding = 'octahedral:axis'\n[[targets]]\nformat = 'rg8'\nholds = 'normal.x'", "'axis' is not a setting"),
        ("encoding = 'cubemap'\n[[targets]]\nformat = 'rg8'\nholds = 'normal.x'", "unknown encoding 'cubemap'; known"),
        (
            "encoding = 'xy'\ndepth = 'deep'\n[[targets]]\nformat = 'rg8'\nholds = 'normal.x normal.y'",
            "unknown depth 'deep'; known: linear",
        ),
    ],
)
def test_invalid_layout_file_is_a_one_line_error(tmp_path, text, said):
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(LayoutError) as caught:
        read_layout(path)
    assert said in str(caught.value) and "\n" not in str(caught.value)


def test_a_layout_is_read_from_a_file(tmp_path):
    path = tmp_path / "mine.toml"
    targets = "[[targets]]\nformat = 'rgba8'\nholds = 'normal.x:12 normal.y:12 power'\n"
    path.write_text(f"encoding = 'octahedral'\nspace = 'world'\npacking = 'truncate'\ndepth = 'logarithmic'\n{targets}")
    read = read_layout(path)
    assert (read.name, read.space, read.packing, read.normal_bits) == ("mine", "world", "truncate", 24)
    assert read.depth is DEPTH_ENCODINGS["logarithmic"] and "logarithmic depth" in read.summary
    assert read.normal_storage == "rgba8 12:12"


def test_a_codec_replaces_the_normal_of_a_layout():
    """The normal moves to its own target; the other fields of its old target stay in their channels."""
    changed = LAYOUTS["normal_depth"].with_codec(Codec(ENCODINGS["octahedral"], STORAGES["rg16_snorm"]))
    assert [t.holds for t in changed.targets] == ["- - depth:16", "normal.x normal.y"]
    assert changed.codec.name == "octahedral/rg16_snorm" and changed.components == LAYOUTS["normal_depth"].components
    moved = LAYOUTS["unreal5_substrate_32"].with_codec(Codec(ENCODINGS["octahedral"], STORAGES["rg16"]))
    assert len(moved.targets) == 3 and moved.bytes_per_pixel == LAYOUTS["unreal5_substrate_32"].bytes_per_pixel
    beside = LAYOUTS["unreal5_substrate_22"].with_codec(Codec(ENCODINGS["octahedral"], STORAGES["rg16"]))
    assert beside.targets[0].holds == "-:11 -:11 power:10", "free bits stay as many"
    with pytest.raises(LayoutError, match="has no depth"):
        LAYOUTS["hybrid"].with_codec(Codec(ENCODINGS["xy_sign"], STORAGES["rg8"]))


def test_more_targets_than_the_device_has_are_refused(gl, monkeypatch):
    monkeypatch.setattr(gl, "max_targets", 3)
    with pytest.raises(LayoutError, match=r"fp32 has 4 targets, plus a light buffer; .* supports 3"):
        check(gl, PIPELINES["deferred"], plan(LAYOUTS["fp32"], light_targets=1))
    check(gl, PIPELINES["forward"], plan(LAYOUTS["fp32"]))
    monkeypatch.setattr(gl, "max_targets", 4)
    check(gl, PIPELINES["prepass"], plan(LAYOUTS["fp32"]))


def test_components_missing_from_a_layout_are_reported(gl):
    with pytest.raises(LayoutError, match=r"deferred needs base_color.b, .*, which layout normal_depth does not store"):
        check(gl, PIPELINES["deferred"], plan(LAYOUTS["normal_depth"], light_targets=1))
    with pytest.raises(LayoutError, match="one light target needs an alpha channel"):
        light = LIGHT_BUFFERS["r11g11b10f"]
        check(gl, PIPELINES["prepass"], plan(LAYOUTS["fp32"], light_targets=1, light_buffer=light))


def covered() -> np.ndarray:
    return kept("fp32")[0][..., 2] != 0


# The largest error of a number that is rounded to a word's bits, in steps.
HALF = 0.5 + 1e-3


def steps(name: str, component: str) -> float | None:
    """Return the distance between a component's codes, for a range of 1; None if it is stored in floats."""
    preset = LAYOUTS[name]
    word = next(w for w in preset.words if w.component == component)
    storage = preset.targets[word.target].storage
    bits = word.bits or storage.bits[word.first]
    return None if storage.kind == "float" else 1 / (2**bits - 1)


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.usefixtures("gl")
def test_depth_round_trips_to_within_half_a_code(name):
    """The bound is half a code of linear depth in n bits up to the far plane, or half a unit of a float; native depth
    is accurate to the precision of float32 there."""
    exact, got = (kept(n)[0][..., 2][covered()].astype(np.float64) for n in ("fp32", name))
    stored = "depth" in LAYOUTS[name].components
    step = (steps(name, "depth") if stored else None) or 0.0
    # Native depth: a unit in the last place of z/w near 1 is z^2 / near times as much of z.
    native = 0 if stored else exact**2 / ROOM.view.near * 2.0**-23
    words = [word for word in LAYOUTS[name].words if word.component == "depth"]
    storages = [LAYOUTS[name].targets[word.target].storage for word in words]
    half = sum(2.0**-11 for storage in storages if storage.kind == "float" and storage.bits[0] == 16)
    bound = HALF * step * ROOM.view.far + native + abs(exact) * (2.0**-20 + half)
    worst = np.max(abs(got - exact) / bound)
    assert worst <= 1, f"{worst:.3f} times the bound"


@pytest.mark.parametrize("holds", ["depth:16 power", "depth:24", "depth"])
@pytest.mark.parametrize("name", DEPTH_ENCODINGS)
def test_every_depth_encoding_round_trips_within_its_bound(gl, name, holds):
    """The layout names its depth encoding: packed in 16 and 24 bits, and in a separate float."""
    normal = "xy_sign" if DEPTH_ENCODINGS[name].signed else "octahedral"
    home = Target("r32f" if holds == "depth" else "rgba8", holds)
    mine = layout(Target("rgba16f", "normal.x normal.y"), home, encoding=normal, depth=DEPTH_ENCODINGS[name])
    storage = {"depth:16 power": "packed16", "depth:24": "packed24", "depth": "r32f"}[holds]
    exact = -kept("fp32")[0][..., 2][covered()].astype(np.float64)
    with rendering(gl, PIPELINES["prepass"], ROOM, plan(mine)) as drawing:
        drawing.draw()
        got = -drawing.gbuffer()[0][..., 2][covered()].astype(np.float64)
    camera = Camera(ROOM.view.near, ROOM.view.far, ROOM.view.fov, 4 / 3)
    bounds = DepthCodec(DEPTH_ENCODINGS[name], DEPTH_STORAGES[storage]).furthest(exact, camera)
    worst = int(np.argmax(abs(got - exact) / bounds))
    assert abs(got - exact)[worst] <= bounds[worst], f"{exact[worst]} came back as {got[worst]}, bound {bounds[worst]}"


def test_the_depth_encoding_of_a_layout_suits_its_normal():
    assert LAYOUTS["normal_depth"].depth_encoding.name == "linear"
    assert LAYOUTS["xy_depth_sign"].depth_encoding.name == "linear_sign"


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.usefixtures("gl")
def test_materials_round_trip_to_within_half_a_code(name):
    """Colours, logarithms of powers and roughness are within half a code; material kinds are exact."""
    exact, got = ([image[covered()].astype(np.float64) for image in kept(n)] for n in ("fp32", name))
    for image, channel, component in [(2, c, f"albedo.{'rgb'[c]}") for c in range(3)] + [(3, 0, "specular.r")]:
        if component in LAYOUTS[name].components:
            check_kept(name, component, exact[image][:, channel], got[image][:, channel])
    words = {word.component for word in LAYOUTS[name].words}
    powers = exact[2][:, 3], got[2][:, 3]
    if "power" in words:
        check_kept(name, "power", *(np.log2(power) / 11 for power in powers))
    if "roughness" in words:
        check_kept(name, "roughness", *((2 / (power + 2)) ** 0.25 for power in powers))
    if "kind" in LAYOUTS[name].components:
        assert np.array_equal(got[1][:, 3], exact[1][:, 3]) and set(exact[1][:, 3]) == set(range(len(KINDS)))


def check_kept(name: str, component: str, exact: np.ndarray, got: np.ndarray) -> None:
    """Check that numbers in [0, 1] are within half a code; a sign stored with them takes one bit, as in SNORM."""
    preset = LAYOUTS[name]
    word = next(w for w in preset.words if w.component == component)
    storage = preset.targets[word.target].storage
    if storage.curved:
        exact, got = displayed(exact), displayed(got)
    whole = 2 if word.sign or storage.kind == "snorm" else 1
    step = steps(name, component)
    # A float's rounding is a share of the number; what cuts off is off by twice as much.
    cut = 1 if preset.rounding == "truncate" else 2
    if word.kept:
        curve, limit = word.kept.encoding, word.kept.range
        number = curve.encode(exact, limit)
        ends = [curve.decode(np.clip(number + side * HALF * whole * step, 0, 1), limit) for side in (-1, 1)]
        slack = curve.inverse_error + 1e-6
        outside = np.max(np.maximum(np.minimum(*ends) - slack - got, got - np.maximum(*ends) - slack))
        assert outside <= 0, f"{component}: {outside:.3g} beyond half a code of {curve.name}"
        return
    half = HALF * whole * step if step else exact * 2.0 ** -FORMS[storage.bits[word.first]].mantissa / cut + 2e-6
    worst = np.max(abs(got - exact) / half)
    assert worst <= 1, f"{component}: {worst:.3f} times half a code"


def test_only_the_normal_is_packed_as_the_layout_says(gl):
    """10-bit powers are rounded to nearest in a layout that truncates its normal."""
    mine = replace(LAYOUTS["unreal5_substrate_22"], packing="truncate")
    materials = tuple(replace(m, power=10.0 + 7.3 * number) for number, m in enumerate(ROOM.materials))
    powers = []
    for layout in (mine, LAYOUTS["fp32"]):
        with rendering(gl, PIPELINES["prepass"], replace(ROOM, materials=materials), plan(layout)) as drawing:
            drawing.draw()
            powers.append(np.log2(drawing.gbuffer()[2][covered()][:, 3].astype(np.float64)))
    apart = abs(powers[0] - powers[1]) / 11 * (2**10 - 1)
    assert 0.3 < apart.max() <= HALF, f"{apart.max():.3f} steps off"


def expected_directions(name: str, n: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return directions after a layout's codec, encoded and decoded in JAX and packed in NumPy, (count, 3)."""
    preset = LAYOUTS[name]
    axes = np.linalg.inv(ROOM.view.matrix())[:3, :3] if preset.space == "world" else np.eye(3)
    n, view = (from_array((a @ axes.T).astype(np.float32)) for a in (n, position))
    encoding, codec = preset.encoding, preset.codec
    code = encoding.encode(n, view)
    bits_of = {word.component: word.bits for word in preset.words}
    # A sign that a quantity carries comes back as it was.
    bits = [bits_of.get(f"normal.{axis}", 0) for axis in "xyz"[: encoding.components]]
    if not any(bits):
        stored = codec.store(code)
    elif preset.packing == SIGNED:
        ones = [2.0 ** (count - 1) - 1 for count in bits]
        stored = type(code)(*(jnp.round(c * most) / most for c, most in zip(code, ones, strict=True)))
    else:
        widen, bias = PACKINGS[preset.packing]
        numbers = []
        for c, count in zip(code, bits, strict=True):
            scale = 2.0**count - 1
            unit = np.asarray(c, np.float64) * 0.5 + 0.5
            integer = np.minimum(np.floor(unit * (scale + widen) + bias), scale)
            numbers.append(jnp.asarray(integer / scale * 2 - 1, jnp.float32))
        stored = type(code)(*numbers)
    decoded = to_array(Vec3(*encoding.decode(stored, view)))
    return np.asarray(decoded, np.float64) @ axes


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.usefixtures("gl")
def test_directions_in_the_gbuffer_match_the_codec(name):
    """The G-buffer's normal is that of the JAX codec for the exact normal; a code near a tie may be off by one."""
    here = covered() & (kept("fp32")[1][..., 3] != HAIR)
    position, exact, got = kept("fp32")[0][here][:, :3], kept("fp32")[1][here][:, :3], kept(name)[1][here][:, :3]
    expected = expected_directions(name, exact, position)
    # Along a world axis a number is 0, which lies on a tie between two codes: a unit in the last place decides.
    world = exact @ np.linalg.inv(ROOM.view.matrix())[:3, :3].T
    apart = np.degrees(np.linalg.norm(got - expected, axis=1))[abs(world).min(axis=1) > 1e-4]
    assert len(apart) > 1500
    same = np.mean(apart < 2e-3)
    assert same > 0.985, f"{same:.4%} the same; worst {apart.max():.4f} degrees"


def test_motion_is_from_the_previous_camera_to_the_current_one(gl):
    """Motion is in screens, from the previous frame to this one, and matches the matrices of the two cameras."""
    x, y, z = ROOM.view.eye
    scene = replace(ROOM, previous=replace(ROOM.view, eye=(x + 0.3, y - 0.1, z + 0.2)))
    mine = layout(Target("rgba32f", "normal.x normal.y motion.x motion.y"))
    with rendering(gl, PIPELINES["prepass"], scene, plan(mine)) as drawing:
        drawing.draw()
        got = drawing.read(GBUFFER)[0][covered()][:, 2:].astype(np.float64)
    seen = np.append(kept("fp32")[0][covered()][:, :3], np.ones((covered().sum(), 1)), axis=1)
    to_world, projection = np.linalg.inv(scene.view.matrix()), scene.view.projection(4 / 3)
    now, then = (seen @ matrix.T for matrix in (projection, projection @ scene.previous.matrix() @ to_world))
    expected = (now[:, :2] / now[:, 3:] - then[:, :2] / then[:, 3:]) / 2
    worst = abs(got - expected).max()
    assert abs(expected).max() > 0.02 and worst < 1e-4, f"{worst} of a screen off"


@pytest.mark.parametrize(
    ("typed", "components", "curve"),
    [
        ("albedo", "base_color.r base_color.g base_color.b", None),
        ("diffuse_color.g", "base_color.g", None),
        ("metalness", "metallic", None),
        ("ambient_occlusion:6", "ao", None),
        ("kind:4", "shading_model", None),
        ("velocity.x", "motion.x", None),
        ("specular.r", "f0.r", None),
        ("square_root(albedo.r):7", "base_color.r", ("square_root", 1.0)),
        # roughness = 1 - x; f0 = 0.08 x, 0.16 x^2 and 0.04 x.
        ("smoothness", "roughness", ("inverted", 1.0)),
        ("unreal_specular:5", "f0", ("linear", 0.08)),
        ("reflectance", "f0", ("square_root", 0.16)),
        ("gltf_specular", "f0", ("linear", 0.04)),
    ],
)
def test_attribute_names_from_engines_are_understood_with_their_curves(typed, components, curve):
    words = list(placed("mine", 0, Target("rgba8", typed)))
    assert [word.component for word in words] == components.split()
    kept = words[0].kept
    assert (kept and (kept.encoding.name, kept.range)) == curve


@pytest.mark.parametrize(
    ("typed", "why"),
    [
        ("alpha", "is the square of the roughness in most engines"),
        ("linear_roughness", r"write squared\(roughness\)"),
        ("specular", "is f0.rgb, or unreal_specular"),
        ("squared(smoothness)", r"has its own curve, inverted\(roughness\); inside another curve write roughness"),
    ],
)
def test_error_for_an_ambiguous_word_says_what_to_write(typed, why):
    with pytest.raises(LayoutError, match=why):
        list(placed("mine", 0, Target("rgba8", typed)))


FIELDS = (
    "normal.x:11 normal.y:11 roughness:10",
    "metallic:4 ao:5 f0:7 base_color.r:5 base_color.g:6 base_color.b:5",
)


# In the bits of RGB10A2 whose channels are of one size.
FEWER_FIELDS = tuple(field.replace("roughness:10", "roughness:8").replace("f0:7", "f0:5") for field in FIELDS)


@pytest.mark.parametrize(
    ("targets", "samples"),
    [
        (("rgb10a2", "rgb10a2"), 1),
        (("rg16", "rg16"), 1),
        (("rgba16",), 1),
        (("r32_uint", "r32_uint"), 4),
        (("rg32_uint",), 1),
        (("rgba16_uint",), 1),
        (("rgba8_uint", "rg16_uint"), 1),
        (("rgba8", "r32_uint"), 1),
        (("rgba32_uint",), 1),
    ],
)
def test_fields_can_be_in_targets_of_any_size(gl, targets, samples):
    """The same fields in whole numbers of any size, or across channels of any size, give the same image to the bit."""
    images, fields = [], FEWER_FIELDS if "rgb10a2" in targets else FIELDS
    for formats in (("rgba8", "rgba8"), targets):
        held = fields if len(formats) == 2 else (" ".join(fields),)
        asked = plan(layout(*map(Target, formats, held)), samples=samples, size=(64, 48))
        with rendering(gl, PIPELINES["prepass"], ROOM, asked) as drawing:
            drawing.draw()
            images.append(drawing.image())
    assert images[0].max() > 0.1 and np.array_equal(*images), f"{np.abs(images[0] - images[1]).max():.3g} apart"


@pytest.mark.parametrize(
    ("target", "what"),
    [
        (("r32_uint", "normal.x:16 normal.y:17"), "needs more than its 32 bits"),
        (("r32_uint", "normal.x"), "up to 24 bits"),
        (("rg32_uint", "normal.x:25 normal.y:25"), "up to 24 bits"),
        (("rgb10a2", "normal.x:15 normal.y:16"), "fields must be in the first 30 bits"),
        (("rg8_snorm", "normal.x:8 normal.y:8"), "UNORM or integer channels"),
        (("r64_uint", "normal.x:16 normal.y:16"), "unknown format 'r64_uint'"),
    ],
)
def test_targets_that_cannot_hold_fields_are_refused_with_the_reason(target, what):
    with pytest.raises(LayoutError, match=what):
        layout(Target(*target)).words  # noqa: B018 # asked for, not used


@pytest.mark.usefixtures("gl")
def test_world_space_is_not_view_space():
    """The room's walls are parallel to the world's axes: RGB10A2 has no 0, and tilts them all by the same angle."""
    n = kept("fp32")[1][covered()][:, :3].astype(np.float64)
    world = n @ np.linalg.inv(ROOM.view.matrix())[:3, :3].T
    walls = abs(world).max(axis=1) > 1 - 1e-6
    error = np.linalg.norm(kept("unreal4")[1][covered()][:, :3] - n, axis=1)[walls]
    # 0 becomes 1/1023 to either side, in two components: sqrt(2)/1023 of a radian.
    same = np.mean(abs(error - np.sqrt(2) / 1023) < 2e-6)
    assert walls.sum() > 2000 and same > 0.99, f"{same:.4%} of {walls.sum()}"
