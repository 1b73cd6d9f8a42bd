"""The built-in layouts: from articles, and from shipped engines."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from ...encodings.catalogue import ENCODINGS
from . import engines
from .engines import ENGINES
from .layout import Layout
from .whole import WHOLE_ENGINES
from .words import Target, targets_of

MATERIAL = targets_of(engines.MATERIAL)

_ARTICLES = (
    Layout(
        "fp32",
        "everything in 32-bit floats: the reference",
        (
            Target("rgba32f", "normal.x normal.y normal.z depth"),
            Target("rgba32f", "diffuse_color shading_model"),
            Target("rgba32f", "f0.rgb power"),
            Target("rgba32f", "instance motion.x motion.y ao"),
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
        "metal_rough",
        "base colour, AO; normal; roughness, metallic, f0, Deferred ID; emissive in the light buffer",
        targets_of("srgb8_a8: base_color ao; rg16: normal.x normal.y; rgba8: roughness metallic f0 shading_model"),
        ENCODINGS["octahedral"],
        "this project: the usual attributes of engines with metallic-roughness materials",
        space="world",
    ),
    Layout(
        "xy_depth_sign",
        "normal xy in RG16F, linear depth in R32F with the sign of the normal's z",
        (Target("rg16f", "normal.x normal.y"), Target("r32f", "depth"), *MATERIAL),
        ENCODINGS["xy_sign"],
        "ozlael, 2010",
    ),
)

LAYOUTS: Mapping[str, Layout] = MappingProxyType(
    {layout.name: layout for layout in (*_ARTICLES, *WHOLE_ENGINES, *ENGINES)}
)
