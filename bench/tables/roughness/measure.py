"""How a code's reflections are measured over roughness, and from which roughness on it carries them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....encodings.codecs.codec import Codec
from ....gbuffer.display import Display, measured_exposure
from ....gbuffer.environment.environment import Environment
from ....gbuffer.frame.plan import Plan
from ....gbuffer.frame.resources import GBUFFER
from ....gbuffer.gl.device import Device, FormatError
from ....gbuffer.gl.shader import ShaderError
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.layouts.words import LayoutError
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import Rendering, rendering
from ...measures.metrics.images import flip
from ...measures.metrics.totals import psnr_db
from .objects import METAL, shown
from .table import TABLE

ROUGHNESSES = (
    *(0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2, 0.22, 0.25, 0.28, 0.3, 0.35),
    *(0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0),
)
# Where FLIP is measured, which takes longer than the picture; and how exact the least roughness is.
WITH_FLIP = (0.0, 0.1, 0.2, 0.3, 0.5, 1.0)
STEP = 0.01
PIPELINE, TONE_MAPPING, PERCENTILE = "deferred", "aces", 99.0
# The pass that reads the G-buffer: there is no light but what lies around.
SHADES = "screen"
# The roughness at which an object's exposure is measured.
EXPOSED_AT = 0.3
UNMEASURABLE = (ShaderError, FormatError, LayoutError)
Row = dict[str, Any]


@dataclass(frozen=True)
class Case:
    """An object under an environment, and the codes whose reflections are looked at."""

    codecs: tuple[Codec, ...]
    object: str
    environment: Environment
    thresholds: tuple[float, ...]
    size: tuple[int, int]

    @property
    def name(self) -> str:
        return f"{self.object} in {self.environment.name}"


def layout_of(codec: Codec) -> Layout:
    """All else in floats; the normal in world space, as engines keep it, where the code is made for that."""
    space = "world" if codec.encoding.domain == "sphere" else "view"
    return replace(LAYOUTS["fp32"], space=space).with_codec(codec)


class Pictures:
    """What a case shows by exact normals and by those of codes, as displayed; each exact picture is drawn once."""

    def __init__(self, device: Device, stack: ExitStack, case: Case):
        self._device, self._stack, self._case = device, stack, case
        self.what = shown(case.object, case.environment)
        self._exact, self._right = self.opened(LAYOUTS["fp32"]), dict[float, np.ndarray]()
        self.covered = self._exact.gbuffer()[0][..., 2] != 0
        self.display = Display(measured_exposure(self._exact.image()[self.covered]), TONE_MAPPING)

    def opened(self, layout: Layout) -> Rendering:
        """The object by a layout, drawn once and kept open with the stack. Raises what UNMEASURABLE lists."""
        plan = Plan(self._case.size, 1, layout, LIGHT_BUFFERS["rgba32f"], 1, False, 1.0, antialiased=False)
        scene = self.what.scene(EXPOSED_AT)
        made = self._stack.enter_context(rendering(self._device, PIPELINES[PIPELINE], scene, plan))
        made.draw()
        return made

    def image(self, made: Rendering, roughness: float) -> np.ndarray:
        """A picture in [0, 1], float32 of shape (height, width, 3); black around the object."""
        _draw_again(made, roughness)
        return np.where(self.covered[..., None], self.display.image(made.image()), 0.0).astype(np.float32)

    def right(self, roughness: float) -> np.ndarray:
        """The picture by exact normals."""
        if roughness not in self._right:
            self._right[roughness] = self.image(self._exact, roughness)
        return self._right[roughness]

    def figures(self, made: Rendering, roughness: float, with_flip: bool) -> Row:
        """What a row says of one picture."""
        image, exact = self.image(made, roughness), self.right(roughness)
        pixels, right = (one[self.covered].astype(np.float64) for one in (image, exact))
        bytes_off = np.abs(np.round(255 * pixels) - np.round(255 * right)).max(axis=-1)
        found: Row = {"roughness": roughness, "psnr_db": psnr_db(float(np.mean((pixels - right) ** 2)))}
        found |= {"off_percent": 100 * float(np.mean(bytes_off > 1)), "largest": float(bytes_off.max())}
        if with_flip:
            apart = flip(image, exact)[self.covered]
            found |= {"flip": float(apart.mean()), "flip_p99": float(np.percentile(apart, PERCENTILE))}
        return found


def _draw_again(made: Rendering, roughness: float) -> None:
    """The picture of another roughness, in a fifth of the time: of the G-buffer one target changes, to a constant."""
    number = next(w.target for w in made.frame.plan.layout.words if w.component == "power")
    # Reflectance head on, and the roughness, which a metal/rough surface has in place of a power.
    made.frame.framebuffer([made.frame.textures(GBUFFER)[number]]).clear(*METAL, roughness)
    made.passes[SHADES]()


def measure(device: Device, case: Case) -> list[Row]:
    """Of each code a row for each threshold, then one for each roughness."""
    with ExitStack() as stack:
        pictures = Pictures(device, stack, case)
        about: Row = {"object": case.object, "environment": case.environment.name, "tone_mapping": TONE_MAPPING}
        about |= {"exposure": pictures.display.exposure, "size": "x".join(map(str, case.size))}
        about |= {"environment_size": ", ".join((size_of(case.environment), *case.environment.changes))}
        empty = TABLE.empty() | about | {"device": device.renderer}
        return [empty | row for codec in case.codecs for row in _rows_of(pictures, codec, case.thresholds)]


def _rows_of(pictures: Pictures, codec: Codec, thresholds: Sequence[float]) -> list[Row]:
    said: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "rounding": codec.rounding}
    said["bits"] = codec.bits
    try:
        made = pictures.opened(layout_of(codec))
    except UNMEASURABLE as error:
        return [said | {"skipped": str(error)}]
    singles = [pictures.figures(made, roughness, roughness in WITH_FLIP) for roughness in ROUGHNESSES]
    crossings = [_crossing(pictures, made, singles, threshold) for threshold in thresholds]
    return [said | row for row in (*crossings, *singles)]


def size_of(environment: Environment) -> str:
    """The texels of an environment, WIDTHxHEIGHT."""
    height, width, _ = environment.radiance.shape
    return f"{width}x{height}"


def _crossing(pictures: Pictures, made: Rendering, rows: Sequence[Row], threshold: float) -> Row:
    """The picture at the least roughness from which on a code keeps a threshold; at 1, without one, where none does.

    Between two roughnesses with FLIP it is taken to cross once.
    """
    known = [(row["roughness"], row["flip_p99"] <= threshold) for row in rows if "flip_p99" in row]
    low = max((roughness for roughness, is_kept in known if not is_kept), default=-STEP)
    high = min((roughness for roughness, _ in known if roughness > low), default=1.0)
    steps = [round(low / STEP), round(high / STEP)]
    while steps[1] - steps[0] > 1:
        middle = sum(steps) // 2
        is_kept = pictures.figures(made, round(middle * STEP, 2), True)["flip_p99"] <= threshold
        steps[1 if is_kept else 0] = middle
    found = pictures.figures(made, round(steps[1] * STEP, 2), True) | {"threshold": threshold}
    return found if low < 1 else found | {"roughness": None}


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Rows that answer first, the worst of each code's marked as the one that decides; then pictures, by roughness."""
    rows = [{**row, "decides": None} for row in rows]
    crossings = sorted((row for row in rows if row["threshold"] is not None), key=_place)
    for row in crossings:
        row["decides"] = row is max((other for other in crossings if _code(other) == _code(row)), key=_least)
    return [*crossings, *(row for row in rows if row["threshold"] is None)]


def _place(row: Row) -> tuple[Any, ...]:
    return -row["threshold"], row["bits"], row["encoding"], row["storage"], -_least(row)


def _code(row: Row) -> tuple[Any, ...]:
    return row["encoding"], row["storage"], row["rounding"], row["threshold"]


def _least(row: Row) -> float:
    """The least roughness that is kept; beyond 1 where none is."""
    return 1 + STEP if row["roughness"] is None else row["roughness"]


def answers(rows: Sequence[Row]) -> Iterator[Row]:
    """Of finished rows those that say from which roughness on each code carries all."""
    yield from (row for row in rows if row.get("decides"))
