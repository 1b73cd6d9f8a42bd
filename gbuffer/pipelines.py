"""The pipelines: each an ordered list of passes."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .frame.contract import Pipeline
from .frame.resources import BY_KIND, COLOURS, TERMS
from .passes.forward import ambient, forward
from .passes.forward_lights import forward_lights
from .passes.geometry import geometry
from .passes.lights import lights
from .passes.linear_depth import linear_depth
from .passes.material import material
from .passes.screen import screen
from .passes.shadow_map import shadow_map
from .passes.transparent import transparent

_ALL = (
    Pipeline(
        "forward",
        "draws every surface once, with all lights",
        "Jo Kyeong-jun, Forward Rendering, Single Pass",
        (shadow_map(), forward(), transparent()),
    ),
    Pipeline(
        "forward_multipass",
        "draws every surface once for each light that reaches it",
        "Jo Kyeong-jun, Forward Rendering, Multi Pass",
        (shadow_map(), ambient(), forward_lights(), transparent()),
    ),
    Pipeline(
        "deferred",
        "deferred shading: lights shade the G-buffer",
        "Hargreaves and Harris 2004; Jo Kyeong-jun, Deferred Shading",
        (
            shadow_map(),
            geometry(COLOURS),
            linear_depth(),
            lights(COLOURS),
            screen(),
            transparent(),
        ),
    ),
    Pipeline(
        "prepass",
        "light pre-pass: lighting from normal and depth, then every surface again",
        "Engel 2008; M. Drobot, Architektury Deferred",
        (shadow_map(), geometry(TERMS), linear_depth(), lights(TERMS), material("opaque"), transparent()),
        usual_layout="normal_depth_material",
    ),
    Pipeline(
        "inferred",
        "light pre-pass with a G-buffer and a light buffer of a separate size; stippled transparent surfaces",
        "Kircher and Lawrance 2009; Jo Kyeong-jun, Inferred Rendering",
        (
            shadow_map(),
            geometry(TERMS, stipple=True),
            linear_depth(),
            lights(TERMS),
            material("opaque", filters=True),
            material("transparent", filters=True),
        ),
        usual_layout="inferred",
    ),
    Pipeline(
        "hybrid",
        "deferred shading for general materials, light pre-pass for special materials, by the Deferred ID",
        "Jo Kyeong-jun, Hybrid Deferred Rendering",
        (
            shadow_map(),
            geometry(BY_KIND),
            linear_depth(),
            lights(BY_KIND),
            screen(),
            material("special"),
            transparent(),
        ),
    ),
)

PIPELINES: Mapping[str, Pipeline] = MappingProxyType({pipeline.name: pipeline for pipeline in _ALL})
