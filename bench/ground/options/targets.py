"""Options for render targets and scenes: sizes, samples and counts, checked against the device."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Protocol, TypeVar

from ....encodings.storages.storage import DITHERED
from ....gbuffer.gl.device import Device
from ....gbuffer.scenes.setting import Setting
from ..output.errors import UsageError, by_reason, leave_out
from .counts import MAX_LIGHTS, MAX_OBJECTS, check_seed, checked_sides, in_range

# A pixel of a frame takes up to a few hundred bytes: one frame of 8K at one sample is the most.
MAX_SAMPLES = 2**25
TARGETS = {"1": 1, "2": 2}
SHADOWS = {"on": True, "off": False}

T = TypeVar("T")


def check_scale(scale: float) -> None:
    """Raise UsageError for a scale that is not from 0.05 to 1."""
    if not 0.05 <= scale <= 1:
        raise UsageError(f"--scale {scale}: out of range; use 0.05 to 1")


def checked_setting(objects: int, lights: int, seed: int) -> Setting:
    """Return the scenes' setting. Raises UsageError if a count or the seed is out of range."""
    in_range("--objects", objects, 1, MAX_OBJECTS)
    in_range("--lights", lights, 0, MAX_LIGHTS)
    check_seed(seed)
    return Setting(objects, lights, seed)


def checked_target(size: str, samples: int, frames: int, device: Device) -> tuple[tuple[int, int], int]:
    """Return the size, and the samples per pixel that the device provides. Raises UsageError for values out of
    range."""
    in_range("--samples", samples, 1, 64)
    sides, given = checked_sides(size, device.max_size, f"on {device.renderer}"), device.given_samples(samples)
    _check_budget(sides, given * frames)
    return sides, given


def _check_budget(size: tuple[int, int], samples: int) -> None:
    """Raise UsageError if frames of this size, with all their samples, are too large to store."""
    if math.prod(size) * samples > MAX_SAMPLES:
        raise UsageError(
            f"--size {size[0]}x{size[1]}: {math.prod(size) * samples} samples in all frames; "
            f"use at most {MAX_SAMPLES} (2^25)"
        )


class Fitted(Protocol):
    """A codec that may not fit its storage."""

    @property
    def name(self) -> str: ...
    @property
    def misfit(self) -> str | None: ...


F = TypeVar("F", bound=Fitted)


def that_fit(codecs: Iterable[F]) -> list[F]:
    """Return the codecs of any kind that fit; report the others on standard error. Raises UsageError if none fits."""
    candidates = list(codecs)
    complaints = [f"{codec.name}: {codec.misfit}" for codec in candidates if codec.misfit]
    return what_is_left([codec for codec in candidates if not codec.misfit], complaints)


class Noisy(Protocol):
    """A codec that may be rounded with noise."""

    @property
    def name(self) -> str: ...
    @property
    def is_dithered(self) -> bool: ...


N = TypeVar("N", bound=Noisy)


def not_with_noise(option: str) -> str:
    """Return the message for an option that cannot be used with codes that have noise."""
    return f"{option} cannot be used with --rounding {DITHERED}"


def without_noise(codecs: Iterable[N], reason: str) -> list[N]:
    """Return the codecs without noise, and report the others, with the reason, on standard error. Raises
    UsageError if every codec has noise."""
    every = list(codecs)
    exact = [codec for codec in every if not codec.is_dithered]
    if not exact:
        raise UsageError(reason)
    return what_is_left(exact, by_reason((codec.name, reason) for codec in every if codec.is_dithered))


def what_is_left(usable: list[T], complaints: list[str]) -> list[T]:
    """Return `usable` unchanged, and report each different complaint on standard error. Raises UsageError with the
    first complaint if nothing is usable."""
    reasons = list(dict.fromkeys(complaints))
    if not usable:
        raise UsageError(reasons[0] if reasons else "nothing to measure")
    for reason in reasons:
        leave_out(reason)
    return usable
