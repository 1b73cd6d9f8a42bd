"""The options of commands that no gate and no test asks for, each once; see options.py."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from .counts import DEFAULT_COUNT
from .option import (
    Backends,
    Count,
    Encodings,
    LightBuffers,
    Lights,
    LightTargets,
    Names,
    Objects,
    Option,
    Pipelines,
    Repeats,
    Samples,
    Scale,
    SetSeed,
    Shadow,
    Size,
)


@dataclass(frozen=True, kw_only=True)
class SweepOptions:
    """What `sweep` sweeps over: names and counts are comma-separated."""

    pipeline: Pipelines = "prepass,hybrid,deferred,inferred,forward"
    objects: Annotated[str, Option("--objects", "Numbers of objects, comma-separated.")] = "100,200,500,1000,2000"
    shadow: Shadow = "on,off"
    layout: Annotated[
        str | None, Option("--layout", "Layouts. Default: the one that each pipeline is published with.", files=True)
    ] = None
    light_buffer: LightBuffers = "rgba16f"
    light_targets: LightTargets = "2"
    size: Size = "1024x768"
    samples: Samples = 1
    scale: Scale = 0.5
    lights: Lights = 64
    repeats: Repeats = 5
    seed: Annotated[int, Option("--seed", "What the scene is made with.")] = 0


@dataclass(frozen=True, kw_only=True)
class LightsOptions:
    """What `lights` measures: names and numbers are comma-separated."""

    experiment: Annotated[
        str, Option("--experiment", "equal, random, banding, chromaticity, resolve, image; or all.")
    ] = "all"
    light_buffer: LightBuffers = "all"
    light_targets: LightTargets = "all"
    sums: Annotated[str, Option("--sum", "equal: what the lights sum to; random: the least.")] = "1,4"
    counts: Annotated[str, Option("--counts", "equal, random: how many they are.")] = "8,64,256"
    peaks: Annotated[str, Option("--peak", "banding: the light at a lamp's centre.")] = "0.1,1,2,3"
    samples: Annotated[str, Option("--samples", "resolve: samples a pixel.")] = "1,2,4,8"
    pipeline: Pipelines = "prepass"
    scene: Annotated[str, Option("--scene", f"resolve, image: scenes or mesh files, {Names}.", files=True)] = (
        "objects,gloss"
    )
    power: Annotated[str, Option("--power", "image: specular powers.")] = "1,47,256"
    size: Size = "320x240"
    objects: Objects = 200
    lights: Lights = 64
    seed: Annotated[int, Option("--seed", "What lights and scenes are made with.")] = 0


@dataclass(frozen=True, kw_only=True)
class DepthOptions:
    """What `depth` measures: names and numbers are comma-separated; None is what is usual."""

    depth: Annotated[str, Option("--depth", f"Depth codes, {Names}.")] = "all"
    storage: Annotated[
        str | None, Option("--storage", f"Depth storages, {Names}. Default: where each code usually lies.")
    ] = None
    rebuild: Annotated[
        str | None,
        Option("--rebuild", "inverse_projection, eye_ray; comma-separated, or all. Default: each code's usual."),
    ] = None
    near: Annotated[str, Option("--near", "Near planes, comma-separated.")] = "0.1,1"
    far: Annotated[str, Option("--far", "Far planes, comma-separated.")] = "1000"
    distance: Annotated[
        str | None, Option("--distance", "Distances, comma-separated. Default: every power of ten.")
    ] = None
    fov: Annotated[float, Option("--fov", "Vertical field of view in degrees, of a 16:9 image.")] = 60.0
    backend: Backends = "jax,glsl"
    count: Annotated[int, Option("--count", "Points at each distance.")] = 2**14
    seed: Annotated[int, Option("--seed", "What points are made with.")] = 0


@dataclass(frozen=True, kw_only=True)
class FramesOptions:
    """What `frames` measures: names are comma-separated; no storage is what is usual."""

    encoding: Annotated[str, Option("--encoding", f"Tangent frame codes, {Names}.")] = "all"
    storage: Annotated[
        str | None, Option("--storage", f"Frame storages, {Names}. Default: where each code usually lies.")
    ] = None
    frames: Annotated[
        str, Option("--frames", f"Frame sets or mesh files, whose vertices are taken, {Names}.", files=True)
    ] = "rotations"
    backend: Backends = "jax,glsl"
    count: Annotated[int, Option("--count", "Frames in a uniform set.")] = 2**16
    seed: SetSeed = 0


@dataclass(frozen=True, kw_only=True)
class CostOptions:
    """What `cost` measures: names are comma-separated."""

    encoding: Encodings = "all"
    isa: Annotated[bool, Option("--isa", "What compilers make of the GLSL; needs no GPU.")] = False
    time: Annotated[bool, Option("--time", "Nanoseconds a megapixel on the GL device.")] = False
    jax: Annotated[bool, Option("--jax", "Million normals a second in JAX.")] = False
    family: Annotated[
        str, Option("--family", "GPUs: polaris10, vega10, navi10, navi21, navi31; comma-separated, or all.")
    ] = "all"
    stage: Annotated[str, Option("--stage", "fragment, compute; comma-separated, or all.")] = "fragment,compute"
    operation: Annotated[str, Option("--operation", "encode, decode; comma-separated, or all.")] = "encode,decode"
    storage: Annotated[
        str, Option("--storage", "Storages and packings whose own cost is shown, comma-separated, or all.")
    ] = "rgba8,rgba8_snorm,11:11,12:12,16:16,11:10:11,depth16,depth24,depth24_sign"
    size: Annotated[
        str | None,
        Option("--size", "WIDTHxHEIGHT of the target that is timed. Default: 64x64 in software, or 1024x1024."),
    ] = None
    repeats: Annotated[int, Option("--repeats", "Repetitions that medians are taken over.")] = 9
    count: Annotated[int, Option("--count", "Normals, for JAX and in uniform sets.")] = 2**20
    seed: SetSeed = 0
    normals: Annotated[str, Option("--normals", f"--plot: normal sets, {Names}.")] = "playground"
    error: Annotated[str, Option("--error", "--plot: psnr, mean or max, the largest angle.")] = "psnr"


@dataclass(frozen=True, kw_only=True)
class TuneOptions:
    """What `tune` fits, and to what."""

    normals: Annotated[str, Option("--normals", "A normal set or a file of one.", files=True)] = "playground"
    storage: Annotated[str, Option("--storage", "A storage.")] = "rgba8"
    parameter: Annotated[
        str, Option("--parameter", "An encoding's own; bits, table; comma-separated. Default: all there are.")
    ] = "all"
    error: Annotated[str, Option("--error", "psnr, rms, mean or max, the largest angle.")] = "psnr"
    count: Annotated[int, Option("--count", "Normals in a uniform set.")] = 2**20
    seed: Annotated[int, Option("--seed", "What uniform sets and their halves are made with.")] = 0


@dataclass(frozen=True, kw_only=True)
class SuiteOptions:
    """What `run` measures: tables, comma-separated; normals in a uniform set; and a seed."""

    tables: Annotated[
        str, Option("--tables", "quality, render, cost, lights, depth, frames, passes; comma-separated, or all.")
    ] = "all"
    count: Count = DEFAULT_COUNT
    seed: SetSeed = 0
