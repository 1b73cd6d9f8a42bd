"""Users' own codes of motion vectors."""

from __future__ import annotations

from typing import Any

import numpy as np

from .....encodings.catalogue import MOTION_ENCODINGS
from .....encodings.codecs.motion_codec import MotionEncoding
from .....encodings.kinds import MOTION
from .....gbuffer.codecs.own.own_passes import Tried
from .....gbuffer.gl.device import Device
from .own import COUNT, ROUNDED, SEED, Own, OwnKind, Values, numbers, of_range, rows

# How far an encoder's code of no motion may be from the middle of [0, 1], and from 0, to tell which of the two it is.
MIDDLE = 0.25
# Motions are looked for up to this many screens that come to 1.
MOST_RANGE, LEAST_RANGE = 16.0, 2.0**-10
# How far a motion that is held comes back off, in screens, and in shares of the motion to find the range.
NEARLY = 1e-3
DIRECTIONS = ((1, 0), (-1, 0), (0, 1), (0, -1))


def _motions(own: Own) -> Values:
    """Return motion vectors up to the range: in random directions with log-uniform lengths, and along axes."""
    random = np.random.default_rng(SEED)
    angles, lengths = random.uniform(0, 2 * np.pi, COUNT), 2.0 ** random.uniform(-12, 0, COUNT)
    x, y = np.cos(angles) * lengths, np.sin(angles) * lengths
    axes = np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1]])
    largest = own.found.get("own_range") or 1.0
    return Values(rows(*(np.concatenate([axes[:, i], (x, y)[i]]) * largest for i in (0, 1))), of_range(len(x) + 7))


def _motion_errors(values: Values, trial: Tried) -> np.ndarray:
    return np.abs(trial.back[0][:, :2].astype(np.float64) - values.given[:, :2]).max(axis=1)


def _motion_facts(own: Own, gl: Device) -> dict[str, Any]:
    """Return findings by name: `is_unit`, from the code for zero motion; `own_range`, if functions take no range."""
    at_rest = own.tried(gl, rows(np.zeros(1)), of_range(1)).codes[0, : own.made.components]
    is_unit = bool((np.abs(at_rest - 0.5) < MIDDLE).all())
    if own.settings:
        return {"is_unit": is_unit}
    reach = _reach(own, gl, is_unit, comes_back=True)
    # Where nothing comes back, that is wrong with it, and not its range.
    reach = reach if reach > LEAST_RANGE else _reach(own, gl, is_unit, comes_back=False)
    return {"is_unit": is_unit, "own_range": float(f"{reach:.4g}")}


def _reach(own: Own, gl: Device, is_unit: bool, comes_back: bool) -> float:
    """Return the largest motion along the axes whose codes fit a fixed-point storage.

    Args:
        comes_back: whether motions must also round-trip, because an encoder may clip its own codes.
    """
    low, high = LEAST_RANGE, MOST_RANGE
    # Each pass divides the ratio of the two ends by many steps.
    for _ in range(2):
        tries = np.geomspace(low, high, COUNT)
        fits = np.logical_and.reduce([_fit(own, gl, tries * x, tries * y, is_unit, comes_back) for x, y in DIRECTIONS])
        index = int(np.argmin(fits)) if not fits.all() else COUNT
        low, high = tries[max(index - 1, 0)], tries[min(index, COUNT - 1)]
    return float(low)


def _fit(own: Own, gl: Device, x: np.ndarray, y: np.ndarray, is_unit: bool, comes_back: bool) -> np.ndarray:
    values = Values(rows(x, y), of_range(len(x)))
    trial = own.tried(gl, values.given, values.more)
    codes = trial.codes[:, :2]
    is_held = np.all((codes >= (0 if is_unit else -1) - ROUNDED) & (codes <= 1 + ROUNDED), axis=1)
    return is_held & ((_motion_errors(values, trial) <= NEARLY * np.abs(values.given).max(axis=1)) | (not comes_back))


def _motion_encoding(own: Own) -> MotionEncoding:
    storages = MOTION_ENCODINGS["linear"].storages
    own_range = None if own.settings else own.found.get("own_range", 1.0)
    return MotionEncoding(**own.described(), storages=storages, is_unit=own.is_unit, own_range=own_range)


KIND = OwnKind(
    kind=MOTION,
    values=_motions,
    errors=_motion_errors,
    unit="screens",
    nearly=NEARLY,
    exactly=lambda _: {"a motion of 0": Values(rows(np.zeros(1)), of_range(1))},
    encoding=_motion_encoding,
    facts=_motion_facts,
    said=lambda given, more: numbers(given[:2], more),
)
