"""The default suite: what `run` measures, a step at a time."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

from ...encodings.catalogue import ENCODINGS, LIGHT_BUFFERS
from ...encodings.codecs.codec import Codec
from ...encodings.codecs.light_codec import LightCodec
from ...encodings.storages.storage import STORAGES
from ...gbuffer.defines.kernels import STAGES
from ...gbuffer.defines.packings import PACKINGS
from ...gbuffer.frame.frame import Plan
from ...gbuffer.gl.device import Device
from ...gbuffer.layouts.presets import LAYOUTS
from ...gbuffer.pipelines import PIPELINES
from ...gbuffer.scenes.setting import Setting
from ..isa import isa, spirv
from ..options.command_options import SuiteOptions
from ..output.errors import MissingError, pick
from ..results.runs import Row, Step
from ..tables.cost import measure as cost
from ..tables.depth import measure as depth
from ..tables.depth.command import DepthRequest
from ..tables.lights import measure as lights
from ..tables.lights.command import LightsRequest
from ..tables.quality import measure as quality
from ..tables.quality.command import Request
from ..tables.render.command import RenderRequest
from ..tables.render.measure import Bench, Case, described
from ..tables.sweep import measure as sweep
from ..tables.tangent_frames import measure as frames
from ..tables.tangent_frames.command import FramesRequest

# The article's methods and what engines ship; `--encoding all` of each command has the whole catalogue.
COMMON = (
    *("xyz", "xyz_renormalised", "xy", "xy_sign", "spherical", "spherical_lut", "spheremap", "spheremap_classic"),
    *("cryengine3", "stereographic", "per_pixel_view", "octahedral", "octahedral_precise", "best_fit"),
)
# Of render and passes; of passes on a software rasteriser, where a frame takes a second, the size is less.
SIZE, LIGHTS, OBJECTS, REPEATS = "640x480", 64, 200, 9
SOFTWARE_SIZE = "320x240"
# Of cost.
PACKED = ("rgba8", "rg16f", "12:12", "16:16", "11:10:11", "depth16", "depth24", "depth24_sign")
# A scene under few lights, as in seed 003, at one specular power.
FRAME = ("prepass", "gloss", "47", "320x240")


@dataclass(frozen=True, kw_only=True)
class SuiteRequest(SuiteOptions):
    """What to measure: tables, comma-separated; normals in a uniform set; and a seed."""

    def steps(self) -> list[Step]:
        """Every step, in the order of the tables; which tables this machine cannot measure is said on standard error.

        Raises:
            UsageError: an unknown table or count.
            MissingError: this machine can measure none of them.
        """
        names = pick("table", self.tables, {name: name for name in TABLES})
        gl, missing = quality.found_device()
        steps, reasons = list[Step](), dict[str, list[str]]()
        for name in names:
            if reason := LACKS.get(name, lambda _: "")(missing):
                reasons.setdefault(reason, []).append(name)
            else:
                steps += TABLES[name](self, gl)
        if not steps:
            raise MissingError("; ".join(reasons))
        for reason, without in reasons.items():
            print(f"normalbench: left out: {', '.join(without)}: {reason}", file=sys.stderr)
        return steps

    def quality_cases(self) -> list[quality.Case]:
        """Each encoding in RGBA8, and in RG16F those of two components, on the seeds' scene and on half the sphere."""
        wide = Request(encoding=",".join(COMMON), normals="playground,hemisphere", count=self.count, seed=self.seed)
        two = [e for e in map(ENCODINGS.__getitem__, COMMON) if e.components == 2 and Codec(e, STORAGES["rg16f"]).fits]
        half = replace(wide, encoding=",".join(e.name for e in two), storage="rg16f")
        return [*wide.cases(), *half.cases()]


def _quality(request: SuiteRequest, _: Device | None) -> Iterator[Step]:
    for case in request.quality_cases():
        codec, chosen = case.codec, case.normal_set
        key: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "rounding": codec.rounding}
        key |= {"normals": chosen.name, "backend": case.backend, "count": chosen.count, "seed": chosen.seed}
        yield Step("quality", key, lambda case=case: [quality.measure(case)])


def _render(request: SuiteRequest, gl: Device | None) -> Iterator[Step]:
    """Each encoding in RGBA8 in an otherwise exact frame; times are the passes' affair."""
    assert gl
    asked = RenderRequest(encoding=",".join(COMMON), size=SIZE, objects=OBJECTS, lights=LIGHTS, seed=request.seed)
    bench = Bench(gl, 0, False)
    for case in asked.cases(gl):
        yield Step("render", _render_key(case), lambda case=case: [bench.measure(case)[0]])


def _render_key(case: Case) -> Row:
    codec = case.plan.layout.codec
    key = described(case.pipeline, case.plan, case.setting, case.asked)
    return key | {"scene": case.maker.name, "codec": codec.name, "frames": case.frames}


def _passes(request: SuiteRequest, gl: Device | None) -> Iterator[Step]:
    """Each pipeline in the layout that it is published with."""
    assert gl
    width, height = map(int, (SOFTWARE_SIZE if gl.is_software else SIZE).split("x"))
    for pipeline in PIPELINES.values():
        targets = max(pipeline.light_targets, default=1)
        layout, light = LAYOUTS[pipeline.usual_layout], LIGHT_BUFFERS["rgba16f"]
        plan = Plan((width, height), 1, layout, light, targets, True, 1.0)
        point = sweep.Point(pipeline, plan, Setting(OBJECTS, LIGHTS, request.seed), REPEATS, 1)
        yield Step("passes", point.key(gl), lambda point=point: [sweep.measure(gl, point)])


def _lights(request: SuiteRequest, gl: Device | None) -> Iterator[Step]:
    """Each light buffer added up, and lighting a frame under six lamps."""
    pipeline, scene, power, size = FRAME
    added = {"peaks": "0.1,1", "samples": "1", "pipeline": pipeline, "scene": scene, "power": power, "size": size}
    asked = LightsRequest(**added, objects=OBJECTS, lights=6, seed=request.seed)
    names, added = list(lights.SUM_EXPERIMENTS), asked.added()
    for encoding in asked.encodings():
        key: Row = {"light_buffer": encoding.name, "experiments": ",".join(names), "seed": request.seed}
        key |= {"device": gl.renderer if gl else None}
        yield Step("lights", key, partial(_summed, names, encoding, added, gl))
    if gl:
        key = {"experiments": "image", "pipeline": pipeline, "scene": scene, "power": power, "size": size}
        key |= {"lights": asked.lights, "seed": request.seed, "device": gl.renderer}
        yield Step("lights", key, partial(_lit, asked, gl))


def _summed(names: list[str], encoding: LightCodec, added: lights.Sums, gl: Device | None) -> list[Row]:
    return list(lights.sum_rows(names, encoding, added, gl))


def _lit(asked: LightsRequest, gl: Device) -> list[Row]:
    (shot,), (pipeline,), (power,) = asked.shots(gl), asked.pipelines(), asked.powers()
    return list(lights.image_rows(gl, pipeline, shot, power, asked.encodings(), asked.targets(), lambda *_: None))


def _depth(request: SuiteRequest, _: Device | None) -> Iterator[Step]:
    asked = DepthRequest(near="0.1", seed=request.seed)
    for case in asked.cases():
        key: Row = {"codec": case.codec.name, "rebuilt": case.rebuilt, "backend": case.backend, "seed": case.seed}
        key |= {"near": case.camera.near, "far": case.camera.far, "fov": case.camera.fov, "count": case.count}
        yield Step("depth", key, lambda case=case: depth.measure(case))


def _frames(request: SuiteRequest, _: Device | None) -> Iterator[Step]:
    for case in FramesRequest(seed=request.seed).cases():
        key: Row = {"codec": case.codec.name, "frame_set": case.frame_set.name, "backend": case.backend}
        key |= {"count": case.frame_set.count, "seed": case.frame_set.seed}
        yield Step("frames", key, lambda case=case: [frames.measure(case)])


def cost_cases() -> list[cost.Case]:
    """Each encoding, and what the storages of the suite and packed words add."""
    packings = [packing for name in PACKED for packing in PACKINGS[name]]
    return cost.cases(map(ENCODINGS.__getitem__, COMMON), packings, cost.OPERATIONS)


def listed_costs(family: str) -> list[tuple[Row, str]]:
    """A family's rows with their disassembly; from the cache once they were measured."""
    return list(cost.isa_rows(cost_cases(), list(STAGES), [family], [], lambda _: None))


def _cost(_: SuiteRequest, __: Device | None) -> Iterator[Step]:
    """What each family's compiler makes of it."""
    for family in isa.FAMILIES:
        yield Step("cost", {"family": family}, lambda family=family: [row for row, _ in listed_costs(family)])


TABLES: dict[str, Callable[[SuiteRequest, Device | None], Iterator[Step]]] = {
    "quality": _quality,
    "render": _render,
    "cost": _cost,
    "lights": _lights,
    "depth": _depth,
    "frames": _frames,
    "passes": _passes,
}


def _lacks_compilers(_: str) -> str:
    return spirv.NO_COMPILER if spirv.version(spirv.COMPILER) is None else isa.missing()


# Of tables that not every machine can measure: what this one lacks, by why it has no GL device, if it has none.
LACKS: dict[str, Callable[[str], str]] = {"render": str, "passes": str, "cost": _lacks_compilers}
