"""Measurement of an encoding's reflections by roughness, and of the lowest acceptable roughness."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from ....encodings.codecs.codec import Codec
from ....gbuffer.display import Display, measured_exposure
from ....gbuffer.environment.environment import Environment
from ....gbuffer.gl.device import Device, FormatError
from ....gbuffer.gl.shader import ShaderError
from ....gbuffer.layouts.words import LayoutError
from ...measures.metrics.flip import Flip
from ...measures.metrics.totals import psnr_db
from ..table import Row
from .frames import DITHERS, NONE, Accumulation, Frames
from .objects import shown
from .table import TABLE

ROUGHNESSES = (
    *(0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2, 0.22, 0.25, 0.28, 0.3, 0.35),
    *(0.4, 0.45, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0),
)
# Where FLIP is measured, which takes longer than the picture; and how exact the least roughness is.
WITH_FLIP = (0.0, 0.1, 0.2, 0.3, 0.5, 1.0)
STEP = 0.01
TONE_MAPPING, PERCENTILE = "aces", 99.0
# The roughness at which an object's exposure is measured.
EXPOSED_AT = 0.3
# The light of what is no metal.
SUN = "sun"
UNMEASURABLE = (ShaderError, FormatError, LayoutError)


@dataclass(frozen=True)
class RoughnessCase:
    """An object under an environment or a sun, with the codecs, thresholds and kinds of image to measure."""

    codecs: tuple[Codec, ...]
    object: str
    environment: Environment | None
    thresholds: tuple[float, ...]
    size: tuple[int, int]
    seen: tuple[Accumulation, ...] = (Accumulation(),)

    @property
    def light(self) -> str:
        """The name of the environment, or of the sun if there is no environment."""
        return self.environment.name if self.environment else SUN

    @property
    def name(self) -> str:
        return f"{self.object} in {self.light}"


class Pictures:
    """Displayed images for a case, with exact normals and with decoded normals; each exact image is drawn once."""

    def __init__(self, device: Device, stack: ExitStack, case: RoughnessCase):
        self._device, self._stack, self._case = device, stack, case
        self.what = shown(case.object, case.environment)
        self._exact, self._right = dict[int, Frames](), dict[tuple[int, float], Flip]()
        exact = self.exact(1)
        self.display = Display(measured_exposure(exact.light(EXPOSED_AT)[exact.covered]), TONE_MAPPING)

    def opened(self, stack: ExitStack, codec: Codec | None, seen: Accumulation) -> Frames:
        """Return the object drawn with a codec, or with exact normals if `codec` is None; the stack releases it.
        Raises one of UNMEASURABLE."""
        return Frames(self._device, stack, self.what, self._case.size, codec, seen)

    def exact(self, frames: int) -> Frames:
        """Return the object drawn with exact normals in this number of frames, which are kept for later calls."""
        if frames not in self._exact:
            self._exact[frames] = self.opened(self._stack, None, Accumulation(frames=frames))
        return self._exact[frames]

    def image(self, frames: Frames, roughness: float) -> np.ndarray:
        """Return an image as displayed, in [0, 1], float32 of shape (height, width, 3); black outside the object."""
        return self.display.image(frames.light(roughness)).astype(np.float32)

    def right(self, frames: int, roughness: float) -> Flip:
        """Return a FLIP comparison with the image of exact normals, made once per roughness and frame count."""
        if (frames, roughness) not in self._right:
            self._right[frames, roughness] = Flip(self.image(self.exact(frames), roughness))
        return self._right[frames, roughness]

    def figures(self, frames: Frames, roughness: float, with_flip: bool) -> Row:
        """Return the columns on one image compared with exact normals; `flip` and `flip_p99` only if `with_flip`."""
        image, exact = self.image(frames, roughness), self.right(len(frames.made), roughness)
        pixels, right = (picture[frames.covered].astype(np.float64) for picture in (image, exact.reference))
        bytes_off = np.abs(np.round(255 * pixels) - np.round(255 * right)).max(axis=-1)
        row: Row = {"roughness": roughness, "psnr_db": psnr_db(float(np.mean((pixels - right) ** 2)))}
        row |= {"off_percent": 100 * float(np.mean(bytes_off > 1)), "largest": float(bytes_off.max())}
        if with_flip:
            apart = exact.of(image)[frames.covered]
            row |= {"flip": float(apart.mean()), "flip_p99": float(np.percentile(apart, PERCENTILE))}
        return row


def measure(device: Device, case: RoughnessCase) -> list[Row]:
    """Return the rows of a case: for each codec and accumulation a row per threshold, then a row per roughness. If
    they cannot be drawn, a single row has the reason in `skipped`."""
    with ExitStack() as stack:
        pictures = Pictures(device, stack, case)
        about: Row = {"object": case.object, "environment": case.light, "tone_mapping": TONE_MAPPING}
        about |= {"exposure": pictures.display.exposure, "size": "x".join(map(str, case.size))}
        if around := case.environment:
            about |= {"environment_size": ", ".join((size_of(around), *around.changes))}
        empty = TABLE.empty() | about | {"device": device.renderer}
        looked = [(codec, seen) for codec in case.codecs for seen in case.seen]
        return [empty | row for codec, seen in looked for row in _rows_of(pictures, codec, seen, case.thresholds)]


def _rows_of(pictures: Pictures, codec: Codec, seen: Accumulation, thresholds: Sequence[float]) -> list[Row]:
    about: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "rounding": codec.rounding}
    about |= {"dither": seen.dither, "frames": seen.frames, "bits": codec.bits}
    if seen.dither != NONE and codec.undithered:
        return [about | {"skipped": f"{codec.name} cannot be dithered: {codec.undithered}"}]
    with ExitStack() as stack:
        try:
            frames = pictures.opened(stack, codec, seen)
        except UNMEASURABLE as error:
            return [about | {"skipped": str(error)}]
        return [about | row for row in _curve(pictures, frames, thresholds)]


def _curve(pictures: Pictures, frames: Frames, thresholds: Sequence[float]) -> list[Row]:
    """Return a row for each threshold, then a row for each roughness; FLIP is computed once for each image."""
    with_flip = cache(lambda roughness: pictures.figures(frames, roughness, True))
    singles = [with_flip(r) if r in WITH_FLIP else pictures.figures(frames, r, False) for r in ROUGHNESSES]
    return [*(_crossing(with_flip, singles, threshold) for threshold in thresholds), *singles]


def size_of(environment: Environment) -> str:
    """Return the size of an environment in texels, WIDTHxHEIGHT."""
    height, width, _ = environment.radiance.shape
    return f"{width}x{height}"


def _crossing(with_flip: Callable[[float], Row], rows: Sequence[Row], threshold: float) -> Row:
    """Return the row of the lowest roughness above which a codec stays within a threshold. If the codec never does,
    return the row of roughness 1 with None as its roughness.

    A single crossing is assumed between two roughnesses for which FLIP is measured.
    """
    known = [(row["roughness"], row["flip_p99"] <= threshold) for row in rows if "flip_p99" in row]
    low = max((roughness for roughness, is_kept in known if not is_kept), default=-STEP)
    high = min((roughness for roughness, _ in known if roughness > low), default=1.0)
    steps = [round(low / STEP), round(high / STEP)]
    while steps[1] - steps[0] > 1:
        middle = sum(steps) // 2
        is_kept = with_flip(round(middle * STEP, 2))["flip_p99"] <= threshold
        steps[1 if is_kept else 0] = middle
    crossing = with_flip(round(steps[1] * STEP, 2)) | {"threshold": threshold}
    return crossing if low < 1 else crossing | {"roughness": None}


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return the rows of crossings first, with the worst of each codec and threshold marked by `decides`, then the
    rows of single images."""
    rows = [{**row, "decides": None} for row in rows]
    crossings = sorted((row for row in rows if row["threshold"] is not None), key=_place)
    for row in crossings:
        row["decides"] = row is max((other for other in crossings if _code(other) == _code(row)), key=_least)
    return [*crossings, *(row for row in rows if row["threshold"] is None)]


def _place(row: Row) -> tuple[Any, ...]:
    code = (row[name] for name in ("bits", "encoding", "storage", "rounding"))
    return -row["threshold"], *code, DITHERS.index(row["dither"]), row["frames"], -_least(row)


def _code(row: Row) -> tuple[Any, ...]:
    return tuple(row[name] for name in ("encoding", "storage", "rounding", "dither", "frames", "threshold"))


def _least(row: Row) -> float:
    """Return the lowest roughness within the threshold; more than 1 if no roughness is."""
    return 1 + STEP if row["roughness"] is None else row["roughness"]


def answers(rows: Sequence[Row]) -> Iterator[Row]:
    """Yield the rows that decide, which have the lowest roughness within a threshold for all objects."""
    yield from (row for row in rows if row.get("decides"))
