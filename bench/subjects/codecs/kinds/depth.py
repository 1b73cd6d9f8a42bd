"""Users' own codes of depth."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from .....encodings.codecs.depth_codec import DepthEncoding
from .....encodings.kinds import DEPTH
from .....encodings.storages.depth_storage import DEPTH_STORAGES
from .....gbuffer.codecs.own.own_passes import Tried
from .....gbuffer.gl.device import Device
from .own import COUNT, SEED, Own, OwnKind, Values, longest, number, one_number_errors, rows

# The planes of functions that are given them; and between which depths functions without them are tried.
NEAR, FAR, NEAREST, FARTHEST = 0.1, 1000.0, 1e-4, 1e6
# In place of a far plane, for numbers of which each is as good as another.
EVEN = -1.0
# What a depth of floats comes back as by half a step of an encoder's, as a share of the depth.
DEPTH_NEARLY = 1e-2


def _is_over_bytes(own: Own) -> bool:
    return "bytes" in own.shape.template


def _depths(own: Own) -> Values:
    """Return depths between the planes, spaced evenly on a logarithmic scale; for an encoding over bytes, numbers
    spread evenly from 0 to 1."""
    if _is_over_bytes(own):
        even = (np.arange(COUNT) + np.random.default_rng(SEED).random(COUNT)) / COUNT
        return Values(rows(even), rows(np.zeros(COUNT), EVEN))
    near, far = own.found.get("planes", (NEAR, FAR))
    return Values(rows(np.geomspace(near, far, COUNT)), rows(np.full(COUNT, near), far))


def _depth_errors(values: Values, trial: Tried) -> np.ndarray:
    """Return errors relative to the depth; for an encoding over bytes, relative to the range."""
    return one_number_errors(values, trial) / np.where(values.more[:, 1] == EVEN, 1.0, values.given[:, 0])


def _depth_facts(own: Own, gl: Device) -> dict[str, Any]:
    """Return findings by name: `planes`, the nearest and farthest depths that round-trip if the functions take no
    planes, otherwise the usual planes; `is_open`, whether codes exceed 1, as depths in scene units do; and `notes`.
    An encoding over bytes has only `wrong` and `notes`."""
    if _is_over_bytes(own):
        return {"wrong": list(_faults_of_bytes(own, gl)), "notes": [OF_BYTES]}
    planes = (NEAR, FAR)
    if not own.settings:
        depths = Values(rows(np.geomspace(NEAREST, FARTHEST, COUNT)), rows(np.zeros(COUNT)))
        trial = own.tried(gl, depths.given, depths.more)
        planes = longest(depths.given[:, 0], _depth_errors(depths, trial) < DEPTH_NEARLY) or planes
    facts = {"planes": planes}
    values = _depths(Own(own.file, own.made, facts))
    codes = own.tried(gl, values.given, values.more).codes[:, 0]
    is_open = bool(np.nanmax(codes) > 1 + DEPTH_NEARLY)
    notes = [OPEN] if is_open else []
    if not own.settings:
        notes.append(OWN_PLANES.format(*planes))
    return facts | {"is_open": is_open, "notes": notes}


def _faults_of_bytes(own: Own, gl: Device) -> Iterator[str]:
    """Yield the mistakes in an encoding over bytes: a missing digit, or a component that is not a whole byte."""
    values, size = _depths(own), own.made.components
    x = values.given[:, 0].astype(np.float64)
    trial = own.tried(gl, values.given, values.more)
    if np.abs(trial.back[0][:, 0] - x).max() > DEPTH_NEARLY:
        same = (digits for digits in range(1, size + 1) if _is_lost(trial.back[0][:, 0], x, digits))
        if digits := next(same, 0):
            yield LOST.format(256**digits, "byte is" if digits == 1 else f"{digits} bytes are")
        return
    bytes_of = np.rint(np.clip(trial.codes, 0, 1) * 255) / 255
    steps = 2.0 ** min(8 * size, 24)
    errors = []
    # One number after the other is rounded, the others stay.
    for channel in [*range(size), slice(0, size)]:
        codes = trial.codes.copy()
        codes[:, channel] = bytes_of[:, channel]
        back = own.tried(gl, values.given, values.more, codes).back[0][:, 0]
        errors.append(float(np.abs(back - x).max() * steps))
    if errors[-1] > MOST_STEPS:
        worst = int(np.argmax(errors[:size]))
        yield NO_BYTE.format(errors[-1], f"{steps:.0f}", worst + 1, errors[worst])


def _is_lost(back: np.ndarray, x: np.ndarray, digits: int) -> bool:
    """Whether the decoded depths `back` equal the depths `x` without their first `digits` bytes."""
    whole = 256.0**digits
    return float(np.abs(back - np.modf(x * whole)[0] / whole).max()) < DEPTH_NEARLY / whole


OF_BYTES = "it packs bytes: `normalbench depth` measures it with linear, window and reversed window depth"
# Of a code over bytes, how many of its least steps a number may be off once its bytes are rounded.
MOST_STEPS = 2.0
LOST = "depths that differ by 1/{} share a code: the code's most significant {} missing"
NO_BYTE = (
    "stored in bytes, depths are off by up to {:.0f} steps of 1/{}: component {} of the code alone by {:.0f}, because "
    "it is not a multiple of 1/255; use powers of 255 instead of 256"
)
OPEN = "its codes exceed 1: only float storages hold them"
OWN_PLANES = "it round-trips for depths from {0:.3g} to {1:.3g}; set the measured range with --near and --far"


def _depth_encoding(own: Own) -> DepthEncoding:
    if _is_over_bytes(own):
        return DepthEncoding(**own.described(), storages=(), bytes=own.made.components)
    is_open = own.found.get("is_open", False)
    storages = tuple(name for name, storage in DEPTH_STORAGES.items() if storage.is_open or not is_open)
    return DepthEncoding(**own.described(), storages=storages)


KIND = OwnKind(
    kind=DEPTH,
    values=_depths,
    errors=_depth_errors,
    unit="of the depth",
    nearly=DEPTH_NEARLY,
    exactly=lambda _: {},
    encoding=_depth_encoding,
    facts=_depth_facts,
    said=number,
)
