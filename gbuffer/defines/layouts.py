"""Macros that describe a layout to `words.glsl` and `gbuffer.glsl`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ...encodings.catalogue import CURVE_ENCODINGS
from ...encodings.codecs.light_encoding import LightEncoding
from ...encodings.codecs.motion_codec import MotionEncoding
from ...encodings.storages.storage import Storage
from ..codecs.codec_passes import levels_of, storage_kind
from ..codecs.curve.curve_passes import curve_constants
from ..gl.shader import glsl_value
from ..layouts.layout import Layout
from ..layouts.words import COMPONENTS, PACKINGS, SIGNED, least_carried

# The samplers of the G-buffer's targets, and of those that are of whole numbers.
SAMPLERS, WORD_SAMPLERS = "gbuffer", "gbuffer_words"
SRGB = CURVE_ENCODINGS["srgb"]
# What stands for 1 in a channel of 8 bits.
SRGB_ONE = "255.0"


def layout_defines(layout: Layout, rounds: tuple[int, ...], is_metal_rough: bool = False) -> dict[str, object]:
    """Return the macros that adapt `gbuffer.glsl` to a layout.

    Args:
        rounds: result of `shader_roundings`.
        is_metal_rough: whether the layout stores surfaces of metallic-roughness materials.
    """
    words = layout.words
    storages = [target.storage for target in layout.targets]
    first = {"DEPTH": "depth", "ALBEDO": "base_color.r", "SPECULAR": "f0.r", "MOTION": "motion.x"}
    first |= {"EMISSION": "emissive.r"}
    first |= {"METALNESS": "metallic", "REFLECTANCE": "f0", "OCCLUSION": "ao", "KIND": "shading_model"}
    first |= {name.upper(): name for name in ("power", "roughness", "instance")}
    widen, bias = PACKINGS[layout.packing]
    return {
        **{name: COMPONENTS.index(component) for name, component in first.items()},
        "NUMBERS": len(COMPONENTS),
        "WORDS": len(words),
        "WORD_COMPONENT": tuple(COMPONENTS.index(word.component) for word in words),
        "WORD_TARGET": tuple(word.target for word in words),
        "WORD_FIRST": tuple(word.first for word in words),
        "WORD_BITS": tuple(word.bits for word in words),
        "TARGETS": len(storages),
        "TARGET_KIND": tuple(storage_kind(storage) for storage in storages),
        "TARGET_SCALE": tuple(float(s.scale(i % s.channels)) for s in storages for i in range(4)),
        "TARGET_PART": tuple(s.bits[0] for s in storages),
        "TARGET_BITS": tuple(s.bits[i % s.channels] for s in storages for i in range(4)),
        "TARGET_ROUNDS": rounds,
        **_integer_defines(storages),
        "NORMAL_LEVELS": levels_of(layout.encoding),
        "NORMAL_SCALE": layout.normal_scales,
        "NORMAL_BIASED": int(layout.codec.storage.is_biased),
        "NORMAL_UNIT": int(layout.encoding.is_unit),
        "PACK_WIDEN": widen,
        "PACK_BIAS": bias,
        "PACK_SIGNED": int(layout.packing == SIGNED),
        "HAS_DEPTH": int("depth" in layout.components),
        "HAS_POWER": int("power" in layout.components),
        "HAS_ROUGHNESS": int("roughness" in layout.components),
        "HAS_EMISSION": int("emissive.r" in layout.components),
        "METAL_ROUGH": int(is_metal_rough),
        "BY_METALNESS": int(is_metal_rough and "metallic" in layout.components),
        **_sign_defines(layout),
        "HAS_KIND": int("shading_model" in layout.components),
        "HAS_INSTANCE": int("instance" in layout.components),
        "WORLD_SPACE": int(layout.space == "world"),
    }


def curve_files(layout: Layout) -> tuple[Path, ...]:
    """Return the paths of the GLSL files of the encodings in `layout.kept`, and of the sRGB curve if a target's
    format applies it; each path once."""
    files = [kept.encoding.glsl for kept in layout.kept.values()]
    return tuple(dict.fromkeys((*files, *([SRGB.glsl] if _curved_components(layout) else []))))


def _curved_components(layout: Layout) -> list[str]:
    """Return the components in channels to which the format itself applies the sRGB curve."""
    targets = [target.storage.curved for target in layout.targets]
    return [word.component for word in layout.words if word.first < targets[word.target]]


def curve_defines(layout: Layout) -> dict[str, object]:
    """Return the macros that apply a layout's curves to the array `numbers` and undo them, and the files' constants.

    Raises:
        ShaderError: a curve's GLSL file cannot be read or lacks one of its functions.
    """
    defines: dict[str, object] = {}
    lines: dict[str, list[str]] = {"encode": [], "decode": []}
    prefix = ""
    for component, kept in layout.kept.items():
        if isinstance(kept.encoding, LightEncoding):
            prefix = kept.encoding.prefix
            defines |= kept.encoding.constants
            continue
        if isinstance(kept.encoding, MotionEncoding):
            defines |= kept.encoding.constants
            if component == FIRST_OF_MOTION:
                for way, statements in lines.items():
                    statements.append(_motion_line(kept.encoding, way, kept.range))
            continue
        defines |= curve_constants(kept.encoding)
        place = f"numbers[{COMPONENTS.index(component)}]"
        for way, statements in lines.items():
            statements.append(f"{place} = {kept.encoding.name}_{way}_curve({place}, {glsl_value(kept.range)});")
    for component in _curved_components(layout):
        defines |= curve_constants(SRGB)
        # Devices only come near the curve, Direct3D 11 within 0.6 of a step, on both ways. A colour that is a code
        # already stays that code.
        place = f"numbers[{COMPONENTS.index(component)}]"
        code = f"floor(srgb_encode_curve(clamp({place}, 0.0, 1.0), 1.0) * {SRGB_ONE} + 0.5)"
        for statements in lines.values():
            statements.append(f"{place} = srgb_decode_curve({code} / {SRGB_ONE}, 1.0);")
    return defines | {
        "TO_CURVES": " ".join(lines["encode"]),
        "FROM_CURVES": " ".join(lines["decode"]),
        "EMISSION_CODED": int(bool(prefix)),
        "EMISSION_ENCODE": f"{prefix}_encode",
        "EMISSION_DECODE": f"{prefix}_decode",
    }


def _integer_defines(storages: Sequence[Storage]) -> dict[str, object]:
    """Return the macros of integer targets: the outputs of a fragment shader and the reads of a pixel. If no target
    is an integer, only HAS_WORDS is returned, as 0."""
    defines: dict[str, object] = {"HAS_WORDS": int(any(storage.is_integer for storage in storages))}
    if not defines["HAS_WORDS"]:
        return defines
    outputs, writes, reads = [], [], []
    counts = {False: 0, True: 0}
    for index, storage in enumerate(storages):
        kind, held = ("uvec4", "target_words") if storage.is_integer else ("vec4", "texels")
        sampler = WORD_SAMPLERS if storage.is_integer else SAMPLERS
        outputs.append(f"layout(location = {index}) out {kind} made_{index};")
        writes.append(f"made_{index} = {held}[{index}];")
        reads.append(f"{held}[{index}] = texelFetch({sampler}[{counts[storage.is_integer]}], pixel, SAMPLE);")
        counts[storage.is_integer] += 1
    defines |= {"TEXEL_OUTPUTS": " ".join(outputs), "TEXEL_WRITES": " ".join(writes), "TEXEL_READS": " ".join(reads)}
    defines |= {"PLAIN_TARGETS": counts[False], "WORD_TARGETS": counts[True]}
    return defines | {"TARGET_INTEGER": tuple(int(storage.is_integer) for storage in storages)}


FIRST_OF_MOTION = "motion.x"


def _motion_line(encoding: MotionEncoding, way: str, largest: float) -> str:
    """Return the GLSL statement that encodes or decodes, depending on `way`, a motion's two numbers in `numbers`."""
    x, y = (f"numbers[{COMPONENTS.index(f'motion.{axis}')}]" for axis in "xy")
    code = f"vec2 code_of_motion = {encoding.prefix}_{way}_motion(vec2({x}, {y}), {glsl_value(largest)});"
    return f"{{ {code} {x} = code_of_motion.x; {y} = code_of_motion.y; }}"


def _sign_defines(layout: Layout) -> dict[str, object]:
    """Return the macros for the number of the normal's code that is stored in the sign of another quantity."""
    word = layout.carrier
    is_depth = word is not None and word.component == "depth"
    beside = word if word and not is_depth else None
    storage = layout.targets[beside.target].storage if beside else None
    bits = (beside.bits or storage.bits[beside.first]) if beside and storage else 0
    return {
        "SIGN_NUMBER": COMPONENTS.index(layout.carried) if layout.carried else layout.encoding.components,
        "SIGN_IN_DEPTH": int(layout.has_signed_depth),
        "SIGN_CARRIER": COMPONENTS.index(beside.component) if beside else -1,
        "LEAST_CARRIED": least_carried(storage, bits) if storage else 0.0,
    }
