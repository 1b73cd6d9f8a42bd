"""Engines' names for the attributes of a layout, and the curves that some of the names imply."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

# By a word in lower case without underscores, what it is called here.
NAMES: Mapping[str, str] = MappingProxyType(
    {
        **dict.fromkeys(("albedo", "basecolour", "basecolor", "diffusecolor", "diffusecolour"), "base_color"),
        **dict.fromkeys(("metalness", "metal", "metallic"), "metallic"),
        **dict.fromkeys(("occlusion", "ambientocclusion"), "ao"),
        "emission": "emissive",
        "perceptualroughness": "roughness",
        **dict.fromkeys(("velocity", "motionvectors"), "motion"),
        **dict.fromkeys(("kind", "model", "id", "shadingmodel"), "shading_model"),
    }
)
# Those of quantities that lie on a curve here.
CURVED: Mapping[str, str] = MappingProxyType(
    {
        # roughness = 1 - x
        **dict.fromkeys(("smoothness", "glossiness"), "inverted(roughness)"),
        # f0 = 0.08 x: Epic Games, Unreal Engine 4, ShadingCommon.ush
        "unrealspecular": "linear:0.08(f0)",
        # f0 = 0.16 x^2: S. Lagarde and C. de Rousiers, Moving Frostbite to PBR, 2014
        "reflectance": "square_root:0.16(f0)",
        # f0 = 0.04 x: Khronos, KHR_materials_specular
        "gltfspecular": "linear:0.04(f0)",
    }
)
# Those that mean several things, and what to write.
_SQUARE = "is the square of the roughness in most engines, the roughness itself in others; write squared(roughness)"
REFUSED: Mapping[str, str] = MappingProxyType(
    {
        "alpha": _SQUARE,
        "linearroughness": _SQUARE,
        "roughnesssquared": _SQUARE,
        "specular": "is f0.rgb, or unreal_specular (f0 = 0.08 x), or gltf_specular (f0 = 0.04 x); write one of these",
    }
)


class RefusedWordError(ValueError):
    """An ambiguous word, or a curve within a curve; the message is one line that says what to write."""


def named(word: str, has_curve: bool = False) -> str:
    """Return the layout's name for an engine's attribute name: `base_color.r` for `albedo.r`, and with the implied
    curve `inverted(roughness)` for `smoothness`. An unknown word is returned unchanged.

    Args:
        has_curve: whether the word is inside a curve's parentheses.

    Raises:
        RefusedWordError: the word is ambiguous, or implies a curve inside another curve.
    """
    base, dot, channel = word.partition(".")
    plain = base.lower().replace("_", "")
    if plain in REFUSED and not (plain == "specular" and dot):
        raise RefusedWordError(f"{word} {REFUSED[plain]}")
    if plain in CURVED and not dot:
        if has_curve:
            quantity = CURVED[plain].partition("(")[2][:-1]
            raise RefusedWordError(f"{word} has its own curve, {CURVED[plain]}; inside another curve write {quantity}")
        return CURVED[plain]
    # The channels of a colour in place of a metallic's number.
    return NAMES.get(plain, "f0" if plain == "specular" else base) + dot + channel
