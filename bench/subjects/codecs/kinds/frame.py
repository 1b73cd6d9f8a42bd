"""Users' own encodings of tangent frames, including quaternions."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from .....encodings.catalogue import FRAME_ENCODINGS
from .....encodings.codecs.frame_codec import FrameCodec
from .....encodings.codecs.frame_encoding import FrameEncoding
from .....encodings.kinds import FRAME
from .....encodings.rotation import rotated_frame
from .....encodings.storages.storage import FRAME_STORAGES
from .....encodings.vec import Vec4
from .....gbuffer.codecs.own.own_passes import RESULTS, Tried
from .....gbuffer.gl.device import Device
from ....ground.angles import angles_deg
from ..doctor.exact import FEW_VALUES, OF_A_HALF, is_unit
from .own import COUNT, SEED, Own, OwnKind, Values, numbers, rows


def _frame_text(given: np.ndarray, more: np.ndarray) -> str:
    return f"{numbers(given, more)} and {numbers(more[:3], more)}"


# How far a frame that undoes itself comes back off, in degrees: decoders of quaternions have sines of small numbers.
FRAME_NEARLY_DEG = 1.0
NO_HAND = "its decoder returns no handedness, which is lost for mirrored tangent frames"
HANDS = "{0:.3g}% of the tangent frames decode with the opposite handedness"


def _frames(own: Own) -> Values:
    """Return random rotations, half of them mirrored, either as quaternions and handedness, or as normals with
    handedness and tangents."""
    random = np.random.default_rng(SEED)
    q = random.normal(size=(COUNT, 4))
    q *= np.sign(q[:, 3:]) / np.linalg.norm(q, axis=1, keepdims=True)
    hand = np.where(np.arange(COUNT) % 2, -1.0, 1.0)
    if own.size("rotation")[0]:
        return Values(_largest_first(q).astype(np.float32), rows(hand))
    frame = rotated_frame(Vec4(*q.T), hand)
    return Values(rows(*frame.normal, hand), rows(*frame.tangent))


def _largest_first(q: np.ndarray) -> np.ndarray:
    """Return quaternions, negated where needed to make the component of largest magnitude positive."""
    largest = np.take_along_axis(q, np.abs(q).argmax(axis=1)[:, None], axis=1)
    return q * np.sign(largest)


def _axes(given: np.ndarray, more: np.ndarray, of_rotation: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return normals and tangents, of shape (count, 3), from an adapter's input or output."""
    if not of_rotation:
        return given[:, :3], more[:, :3]
    q = given.astype(np.float64)
    with np.errstate(invalid="ignore", divide="ignore"):
        n, t, _ = rotated_frame(Vec4(*(q / np.linalg.norm(q, axis=1, keepdims=True)).T), 1.0)
    return np.stack(n, axis=1), np.stack(t, axis=1)


def _frame_errors(values: Values, trial: Tried) -> np.ndarray:
    """Return the angular error of the normal or the tangent, whichever is larger, in degrees."""
    of_rotation = len(trial.back) < len(RESULTS)
    (n, t), (n_back, t_back) = (
        _axes(first, other, of_rotation) for first, other in ((values.given, values.more), trial.back[:2])
    )
    with np.errstate(invalid="ignore"):
        return np.maximum(angles_deg(n, n_back), angles_deg(t, t_back))


def _frame_facts(own: Own, gl: Device) -> dict[str, Any]:
    """Return findings by name: `is_unit`; `levels`, the number of values of each component, 0 for many; and the
    findings of `_of_hands`."""
    values = _frames(own)
    trial = own.tried(gl, values.given, values.more)
    codes = trial.codes[:, : own.made.components]
    finite = codes[np.isfinite(codes).all(axis=1)]
    is_in_unit = bool(len(finite)) and is_unit(finite, OF_A_HALF)
    levels = [_level_count(finite[:, i] * 2 - 1 if is_in_unit else finite[:, i]) for i in range(codes.shape[1])]
    facts = {"is_unit": is_in_unit, "levels": levels}
    return facts | _of_hands(own, values, trial)


def _level_count(numbers: np.ndarray) -> int:
    """Return the number of distinct values: 1, or a few that are evenly spaced from -1 to 1; otherwise 0."""
    values = np.unique(np.round(numbers, 4))
    if len(values) == 1:
        return 1
    is_few = 2 <= len(values) <= FEW_VALUES
    return len(values) if is_few and np.abs(values - np.linspace(-1, 1, len(values))).max() < 1e-3 else 0


def _of_hands(own: Own, values: Values, trial: Tried) -> dict[str, Any]:
    """Return findings by name: `notes` and a false `has_hand` if decode returns no handedness, or `wrong` if it
    reverses the handedness of some frames; otherwise an empty dictionary."""
    gives = [part for part in ("hand", "bitangent") if own.size(part)[1]]
    if not gives and own.size("tangent")[1] < 4:
        return {"notes": [NO_HAND], "has_hand": False}
    if gives == ["bitangent"]:
        n, t, b = (vectors[:, :3] for vectors in trial.back)
        hand = np.sum(np.cross(n, t) * b, axis=1)
    else:
        of_rotation = len(trial.back) < len(RESULTS)
        hand = trial.back[1][:, 0] if of_rotation else trial.back[not gives][:, 3]
    given = values.more[:, 0] if own.size("rotation")[0] else values.given[:, 3]
    lost = float(np.mean((hand < 0) != (given < 0)))
    return {"wrong": [HANDS.format(100 * lost)]} if lost else {}


def _frame_encoding(own: Own) -> FrameEncoding:
    every = dict.fromkeys(name for known in FRAME_ENCODINGS.values() for name in known.storages)
    levels = tuple(own.found.get("levels", (0, 0, 0, 0)))
    hand_in = len(levels) - 1 if own.found.get("has_hand", True) else None
    encoding = FrameEncoding(
        **own.described(), hand_in=hand_in, levels=levels, storages=tuple(every), is_unit=own.is_unit
    )
    fitting = tuple(name for name in every if not FrameCodec(encoding, FRAME_STORAGES[name]).misfit)
    return replace(encoding, storages=fitting)


KIND = OwnKind(
    kind=FRAME,
    values=_frames,
    errors=_frame_errors,
    unit="degrees",
    nearly=FRAME_NEARLY_DEG,
    exactly=lambda _: {},
    encoding=_frame_encoding,
    facts=_frame_facts,
    said=_frame_text,
)
