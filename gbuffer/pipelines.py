"""The pipelines: each an ordered list of passes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from .passes.passes import (
    Stage,
    forward,
    forward_lights,
    geometry,
    lights,
    linear_depth,
    material,
    screen,
    shadow_map,
    transparent,
)

SURFACE = frozenset({"albedo.r", "albedo.g", "albedo.b", "specular.r", "specular.g", "specular.b", "power"})


@dataclass(frozen=True)
class Pipeline:
    """An ordered list of passes.

    Attributes:
        name, title, source: what it is called, what it is, where it comes from.
        stages: the passes, in order.
        needs: what of the G-buffer it cannot do without, beside the normal.
        light_targets: how many targets its light buffer may have; empty where it has none.
        scaled: whether G-buffer and light buffer may be smaller than the image.
        starts_light: whether its geometry pass writes the light buffer beside the G-buffer.
        usual_layout: the layout it is published with.
    """

    name: str
    title: str
    source: str
    stages: tuple[Stage, ...]
    needs: frozenset[str] = frozenset()
    light_targets: tuple[int, ...] = ()
    scaled: bool = False
    starts_light: bool = False
    usual_layout: str = "hybrid"

    @property
    def has_gbuffer(self) -> bool:
        """Whether a layout makes a difference to it."""
        return bool(self.light_targets)


_ALL = (
    Pipeline(
        "forward",
        "every surface once, under all lights",
        "seed 004, Forward Rendering, Single Pass",
        (shadow_map(), forward(), transparent()),
    ),
    Pipeline(
        "forward_multipass",
        "every surface once for each light that reaches it",
        "seed 004, Forward Rendering, Multi Pass",
        (shadow_map(), forward(lights=False), forward_lights(), transparent()),
    ),
    Pipeline(
        "deferred",
        "deferred shading: lights shade the G-buffer",
        "Hargreaves and Harris 2004; seed 004, Deferred Shading",
        (
            shadow_map(),
            geometry(emissive="all"),
            linear_depth(),
            lights("colour"),
            screen(special_apart=False),
            transparent(),
        ),
        needs=SURFACE,
        light_targets=(1,),
        starts_light=True,
    ),
    Pipeline(
        "prepass",
        "light pre-pass: lights from normal and depth, then every surface again",
        "Engel 2008; seeds 002 and 004, Light Pre-pass",
        (shadow_map(), geometry(), linear_depth(), lights("light"), material("opaque"), transparent()),
        light_targets=(1, 2),
        usual_layout="normal_depth_material",
    ),
    Pipeline(
        "inferred",
        "light pre-pass with a G-buffer and light buffer of their own size, transparent surfaces by stipple",
        "Kircher and Lawrance 2009; seed 004, Inferred Rendering",
        (
            shadow_map(),
            geometry(stipple=True),
            linear_depth(),
            lights("light"),
            material("opaque", filters=True),
            material("transparent", filters=True, blends=True),
        ),
        light_targets=(1, 2),
        scaled=True,
        usual_layout="inferred",
    ),
    Pipeline(
        "hybrid",
        "deferred shading for general materials, light pre-pass for special ones, by the Deferred ID",
        "seed 004, Hybrid Deferred Rendering",
        (
            shadow_map(),
            geometry(emissive="general"),
            linear_depth(),
            lights("by_id"),
            screen(special_apart=True),
            material("special", adds=True),
            transparent(),
        ),
        needs=SURFACE | {"kind"},
        light_targets=(1, 2),
        starts_light=True,
    ),
)

PIPELINES: Mapping[str, Pipeline] = MappingProxyType({pipeline.name: pipeline for pipeline in _ALL})
