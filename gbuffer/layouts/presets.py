"""The layouts there are: from the articles, and from shipped engines."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ...encodings.catalogue import ENCODINGS
from .layout import Layout, Target

MATERIAL = (
    Target("rgba8", "albedo.r albedo.g albedo.b kind"),
    Target("rgba8", "specular.r specular.g specular.b power"),
)
# An engine keeps other things beside its normal than this renderer's materials need.
ENGINE = " (its normal; what lies beside it is this renderer's)"

_PRESETS = (
    Layout(
        "fp32",
        "everything in 32-bit floats: the reference",
        (
            Target("rgba32f", "normal.x normal.y normal.z depth"),
            Target("rgba32f", "albedo.r albedo.g albedo.b kind"),
            Target("rgba32f", "specular.r specular.g specular.b power"),
            Target("rgba32f", "instance motion.x motion.y"),
        ),
        ENCODINGS["xyz"],
        "this project",
    ),
    Layout(
        "hybrid",
        "RT0 albedo and Deferred ID, RT1 normal, RT2 specular and power; RT3 is the light buffer",
        (MATERIAL[0], Target("rg16f", "normal.x normal.y"), MATERIAL[1]),
        ENCODINGS["spherical"],
        "Jo Kyeong-jun, Advanced Rendering with Vision Engine",
    ),
    Layout(
        "normal_depth",
        "one RGBA8: normal 8:8, linear depth 16 in 8:8",
        (Target("rgba8", "normal.x normal.y depth:16"),),
        ENCODINGS["spheremap"],
        "M. Drobot, Architektury Deferred, Light Pre Pass buffer layout",
    ),
    Layout(
        "normal_depth_material",
        "two RGBA8: normal 16:16; linear depth 24, specular power",
        (Target("rgba8", "normal.x:16 normal.y:16"), Target("rgba8", "depth:24 power")),
        ENCODINGS["spheremap"],
        "M. Drobot, Architektury Deferred, Light Pre Pass buffer layout",
    ),
    Layout(
        "normal_motion",
        "two RGBA8: normal 8:8, motion 8:8; linear depth 24, specular power",
        (Target("rgba8", "normal.x normal.y motion.x motion.y"), Target("rgba8", "depth:24 power")),
        ENCODINGS["spheremap"],
        "M. Drobot, Architektury Deferred, Light Pre Pass buffer layout",
    ),
    Layout(
        "inferred",
        "two RGBA8: normal 16:16; linear depth 16, instance, specular power",
        (Target("rgba8", "normal.x:16 normal.y:16"), Target("rgba8", "depth:16 instance power")),
        ENCODINGS["spheremap"],
        "Kircher and Lawrance 2009: normal, depth and an ID for the discontinuity-sensitive filter",
    ),
    Layout(
        "xy_depth_sign",
        "normal xy in RG16F, linear depth in R32F with the sign of the normal's z",
        (Target("rg16f", "normal.x normal.y"), Target("r32f", "depth"), *MATERIAL),
        ENCODINGS["xy_sign"],
        "ozlael, 2010",
    ),
    Layout(
        "killzone2",
        "view-space xy, two half floats",
        (Target("rg16f", "normal.x normal.y"), *MATERIAL),
        ENCODINGS["xy"],
        "Valient, Deferred Rendering in Killzone 2, 2007" + ENGINE,
    ),
    Layout(
        "cryengine3",
        "world-space best-fit normal in RGB8, specular power in A",
        (
            Target("rgba8", "normal.x normal.y normal.z power"),
            MATERIAL[0],
            Target("rgba8", "specular.r specular.g specular.b"),
        ),
        ENCODINGS["best_fit"],
        "Kaplanyan, CryENGINE 3: Reaching the Speed of Light, 2010 (Crysis 2)" + ENGINE,
        space="world",
    ),
    Layout(
        "godot4",
        "view-space best-fit normal in RGB8, specular power in A",
        (
            Target("rgba8", "normal.x normal.y normal.z power"),
            MATERIAL[0],
            Target("rgba8", "specular.r specular.g specular.b"),
        ),
        ENCODINGS["best_fit"],
        "Godot 4" + ENGINE,
    ),
    Layout(
        "unreal4",
        "world-space xyz in RGB10A2",
        (Target("rgb10a2", "normal.x normal.y normal.z"), *MATERIAL),
        ENCODINGS["xyz_renormalised"],
        "Unreal Engine 4 (2012), GBufferA" + ENGINE,
        space="world",
    ),
    Layout(
        "unreal5_substrate_22",
        "world-space octahedral, 11:11 bits",
        (
            Target("rgba8", "normal.x:11 normal.y:11 power:10"),
            *MATERIAL[:1],
            Target("rgba8", "specular.r specular.g specular.b"),
        ),
        ENCODINGS["octahedral"],
        "Unreal Engine 5, Substrate" + ENGINE,
        space="world",
    ),
    Layout(
        "unreal5_substrate_32",
        "world-space octahedral, 16:16 bits",
        (Target("rgba8", "normal.x:16 normal.y:16"), *MATERIAL),
        ENCODINGS["octahedral"],
        "Unreal Engine 5, Substrate" + ENGINE,
        space="world",
    ),
    Layout(
        "unity_builtin",
        "world-space xyz in RGB10A2",
        (*MATERIAL, Target("rgb10a2", "normal.x normal.y normal.z")),
        ENCODINGS["xyz_renormalised"],
        "Unity, built-in deferred path" + ENGINE,
        space="world",
    ),
    Layout(
        "unity_urp",
        "world-space xyz in RGBA8 signed",
        (*MATERIAL, Target("rgba8_snorm", "normal.x normal.y normal.z")),
        ENCODINGS["xyz_renormalised"],
        "Unity, Universal Render Pipeline" + ENGINE,
        space="world",
    ),
    Layout(
        "unity_urp_accurate",
        "world-space octahedral, 12:12 in RGB8 by floor(x 4095.5)",
        (*MATERIAL, Target("rgba8", "normal.x:12 normal.y:12")),
        ENCODINGS["octahedral"],
        "Unity, Universal Render Pipeline, accurate G-buffer normals" + ENGINE,
        space="world",
        packing="truncate_half",
    ),
    Layout(
        "unity_hdrp",
        "world-space octahedral, 12:12 in RGB8",
        (*MATERIAL, Target("rgba8", "normal.x:12 normal.y:12")),
        ENCODINGS["octahedral"],
        "Unity, High Definition Render Pipeline, less its step that keeps z off 0" + ENGINE,
        space="world",
        packing="truncate_half",
    ),
    Layout(
        "bevy",
        "world-space octahedral, 12:12, rounded",
        (Target("rgba8", "normal.x:12 normal.y:12"), *MATERIAL),
        ENCODINGS["octahedral"],
        "Bevy, deferred path, newer releases" + ENGINE,
        space="world",
    ),
    Layout(
        "bevy_truncated",
        "world-space octahedral, 12:12, truncated",
        (Target("rgba8", "normal.x:12 normal.y:12"), *MATERIAL),
        ENCODINGS["octahedral"],
        "Bevy, deferred path, older releases" + ENGINE,
        space="world",
        packing="truncate",
    ),
    Layout(
        "granite",
        "world-space xyz in RGB10A2",
        (Target("rgb10a2", "normal.x normal.y normal.z"), *MATERIAL),
        ENCODINGS["xyz_renormalised"],
        "Granite (Arntzen)" + ENGINE,
        space="world",
    ),
    Layout(
        "kajiya",
        "world-space xyz, 11:10:11 bits, truncated",
        (Target("rgba8", "normal.x:11 normal.y:10 normal.z:11"), *MATERIAL),
        ENCODINGS["xyz_renormalised"],
        "kajiya (Embark Studios)" + ENGINE,
        space="world",
        packing="truncate",
    ),
)

LAYOUTS: Mapping[str, Layout] = MappingProxyType({layout.name: layout for layout in _PRESETS})
