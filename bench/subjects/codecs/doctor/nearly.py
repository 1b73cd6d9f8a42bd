"""Mistakes in a pair that nearly round-trips: codes that are scaled, shifted or truncated between the two functions.

The code that the decoder expects for a direction is the code that decodes to this direction; Newton's method finds it
from the encoder's code. The difference between the two codes identifies the mistake for any map.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from .....encodings.storages.storage import Storage
from ....ground.angles import angles_deg
from ....ground.directions import unit
from .probe import Probe, Trip

# Of a finite difference; of float32's digits it leaves half.
STEP = 1e-3
# How many steps of Newton's method.
ROUNDS = 3
# Of the scales that are tried: the farthest from 1, how many, and on how many directions.
FARTHEST, SCALES, FEW = 4.0, 33, 256
# Of a line: how often it is drawn, of what share of the nearest, through how many, and over which range at least.
FITTINGS, KEPT, LEAST_COUNT, LEAST_SPREAD = 3, 0.9, 16, 0.1
# Of its distance from 1: how much scales of numbers may differ that are one.
ALIKE = 0.02
# Of a shift: how much those of numbers may differ that are one, and of half a step, how near it must be to it.
ALIKE_SHIFTS, NEAR_A_HALF = 0.1, 0.02
# How near to 0, to -1 or to 0.5 is the point about which codes are scaled.
NEAR_A_POINT = 0.05
# Scales this near are not told apart; and how near to a fraction, of its distance from 1, a scale is it.
UNTOLD, OF_A_FRACTION = 1e-7, 0.003
# By how much a mistake that is named makes the error smaller at least.
FEWER = 8.0
# Of an angle: how far from its axis it is looked at, how near its slope must be to a step of a turn, and what is left
# of the error at most without that.
TURN, WIDE, OF_A_STEP, LEFT = 2 * np.pi, 0.3, 0.05, 0.75
# The sizes of steps that codes may be rounded to.
BITS = range(5, 17)
# Of half a step, as a share of a step: how near a shift must be to it; and of a step, how near a code to a whole one.
HALF_STEP, WHOLE = 0.08, 0.02


@dataclass(frozen=True)
class Fit:
    """A change to a component c of a code, counted from 1: the decoder expects scale c + shift."""

    number: int
    scale: float
    shift: float


@dataclass(frozen=True)
class Lattice:
    """A regular grid that components of codes are rounded to, with `steps` steps from 0 to 1.

    Attributes:
        is_unit: whether (c + 1) / 2 is a multiple of the step, as in UNORM; otherwise c is, as in SNORM.
        is_one_more: whether there is one more step than the bits hold: 256 instead of 255.
    """

    bits: int
    is_unit: bool
    is_one_more: bool = False

    @property
    def steps(self) -> int:
        return 2 ** (self.bits - (not self.is_unit)) - (not self.is_one_more)

    def is_of(self, storage: Storage, size: int) -> bool:
        """Whether a storage's first `size` channels are UNORM or SNORM with the steps of this lattice."""
        scales = {storage.scale(channel) for channel in range(min(size, storage.channels))}
        return storage.kind == ("unorm" if self.is_unit else "snorm") and scales == {self.steps}

    def whole(self, codes: np.ndarray) -> np.ndarray:
        """Return codes in units of steps: whole numbers if the codes are on the lattice."""
        return (codes * 0.5 + 0.5 if self.is_unit else codes) * self.steps

    @property
    def step(self) -> float:
        """The step size of a component in [-1, 1]."""
        return (2.0 if self.is_unit else 1.0) / self.steps


def lattice_of(codes: np.ndarray) -> Lattice | None:
    """Return the coarsest lattice that contains nearly all components of the codes; None if no lattice fits, or if
    the codes have too few values to decide."""
    for bits in BITS:
        for lattice in (Lattice(bits, True), Lattice(bits, False), Lattice(bits, True, True)):
            whole = lattice.whole(codes.astype(np.float64))
            if (np.abs(whole - np.rint(whole)) < WHOLE).mean() > 0.999 and len(np.unique(np.rint(whole))) > 8:
                return lattice
    return None


@dataclass(frozen=True)
class Start:
    """The initial guess in the search for a scale: each component is scaled by `scale` about the value `about`."""

    scale: float = 1.0
    about: float = 0.0

    @property
    def shift(self) -> float:
        """The offset to add to a component times `scale`."""
        return self.about * (1 - self.scale)

    def of(self, codes: np.ndarray) -> np.ndarray:
        """Return codes times `scale` plus `shift`."""
        return codes * self.scale + self.shift


UNCHANGED = Start()


def start(trip: Trip, probe: Probe) -> Start:
    """Return the Start with the smallest median angular error, from several scales about 0 and about 0.5."""
    scales = np.geomspace(1 / FARTHEST, FARTHEST, SCALES)
    tried = [Start(float(scale), about) for about in (0.0, 0.5) for scale in scales]
    few = trip.of(np.arange(max(len(trip.n) - FEW, 0), len(trip.n)))
    given = np.concatenate([begin.of(few.codes).astype(np.float32) for begin in tried])
    back = np.split(probe.decode(given), len(tried))
    return min(zip(tried, back, strict=True), key=lambda pair: float(np.median(angles_deg(few.n, pair[1]))))[0]


def wanted(trip: Trip, probe: Probe, begin: Start) -> np.ndarray:
    """Return the codes that decode to the trip's directions, of shape (count, size), found by Newton's method
    starting from `begin`; NaN where the method fails."""
    codes = begin.of(trip.codes.astype(np.float64))
    for _ in range(ROUNDS):
        codes = codes + _towards(trip.n, codes, probe)
    return codes


def _towards(n: np.ndarray, codes: np.ndarray, probe: Probe) -> np.ndarray:
    """Return the Newton step of each code towards its direction in n, of shape (count, size), from the slope of
    decode; NaN where the slope is not finite."""
    size = codes.shape[1]
    # Of what float32 makes of a code, so that a difference is one of codes that are.
    rounded_codes = codes.astype(np.float32)
    shifts = [np.float32(sign * STEP) * np.eye(size, dtype=np.float32)[i] for i in range(size) for sign in (1, -1)]
    given = [rounded_codes, *((rounded_codes + shift).astype(np.float32) for shift in shifts)]
    back = [unit(decoded) for decoded in np.split(probe.decode(np.concatenate(given)), len(given))]
    gaps = [(given[1 + 2 * i] - given[2 + 2 * i])[:, i : i + 1] for i in range(size)]
    # Beside a code beyond float32's digits lies the code itself.
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.stack([(back[1 + 2 * i] - back[2 + 2 * i]) / gaps[i] for i in range(size)], axis=2)
    flat = ~(np.isfinite(slope).all(axis=(1, 2)))
    slope[flat] = 0.0
    steps = np.einsum("nij,nj->ni", np.linalg.pinv(slope, rcond=1e-3), n - back[0])
    steps[flat] = np.nan
    return steps - (codes - rounded_codes)


def _fit(index: int, given: np.ndarray, wanted_codes: np.ndarray, begin: Start) -> Fit:
    """Return the line through most of the wanted values of component `index`, by repeated least squares without
    outliers; scale 1 and shift 0 if too few values are left."""
    x, y = given[:, index], wanted_codes[:, index]
    scale, shift = begin.scale, begin.shift
    kept = np.isfinite(y) & (np.abs(y - begin.of(x)) < 0.5)
    for _ in range(FITTINGS):
        if kept.sum() < LEAST_COUNT or np.ptp(x[kept]) < LEAST_SPREAD:
            return Fit(index + 1, 1.0, 0.0)
        scale, shift = np.polyfit(x[kept], y[kept], 1)
        off = np.abs(scale * x + shift - y)
        kept = kept & (off <= np.quantile(off[kept], KEPT))
    return Fit(index + 1, float(scale), float(shift))


def mistakes(trip: Trip, probe: Probe, begin: Start = UNCHANGED) -> Iterator[str]:
    """Yield lines on how the components of codes are scaled, shifted or truncated between the two functions.

    Args:
        begin: the approximate change that the codes need.
    """
    lattice = lattice_of(trip.codes)
    x, y = trip.codes.astype(np.float64), wanted(trip, probe, begin)
    moving = [i for i in range(probe.size) if np.nanmax(np.abs(y[:, i] - x[:, i]), initial=0.0) > 0]
    if not moving:
        return
    if lattice:
        yield from _of_lattice(x[:, moving], y[:, moving], lattice)
        return
    fits, better = [_fit(i, x, y, begin) for i in moving], trip.codes.copy()
    for number, fit in zip(moving, fits, strict=True):
        better[:, number] = x[:, number] * fit.scale + fit.shift
    after = Trip(trip.n, trip.view, better, probe.decode(better)).angles()
    if FEWER * np.median(after) < np.median(trip.angles()):
        yield from _rounding_sentences(fits, trip, probe)


def _rounding_sentences(fits: list[Fit], trip: Trip, probe: Probe) -> Iterator[str]:
    shown = f"up to {np.quantile(trip.angles(), 0.99):.3g} degrees off without any storage"
    scale = np.array([1 / fit.scale for fit in fits])
    # Where c is 0, and where it is at its ends: a shift in [0, 1] is one of the scale, too.
    shift = np.array([-fit.shift / fit.scale for fit in fits])
    if not _is_shift(scale, shift):
        yield f"encode gives {_scale_said(fits, scale, shift, probe)}: {shown}"
    elif bits := _half_step(float(shift.mean())):
        size = "large" if shift.mean() > 0 else "small"
        yield f"codes are half a step of {bits} bits too {size}: {shown}; is 0.5 added although storing rounds?"
    else:
        yield f"encode gives the code that decode expects, plus {shift.mean():.3g}: {shown}"


def _is_shift(scale: np.ndarray, shift: np.ndarray) -> bool:
    """Whether all components are shifted by the same amount and not scaled."""
    most = ALIKE_SHIFTS * np.abs(shift).max()
    return bool(np.ptp(shift) < most and np.abs(scale - 1).max() < most)


def _half_step(shift: float) -> int:
    """Return the bit count for which the shift is half a step; 0 if no bit count fits."""
    halves = ((bits, abs(shift) * steps) for bits in BITS for steps in (2**bits - 1, 2**bits))
    return next((bits for bits, share in halves if abs(share - 1) < NEAR_A_HALF), 0)


def _scale_said(fits: list[Fit], scale: np.ndarray, shift: np.ndarray, probe: Probe) -> str:
    """Return the scales in words: one scale for all components, or each component's scale and shift, without
    components whose scale is right."""
    if max(np.ptp(scale), np.ptp(shift)) <= ALIKE * np.abs(scale - 1).max():
        mean_scale = float(scale.mean())
        fixed_point = _fixed_point_text(mean_scale, float(shift.mean()), probe)
        return f"{_fraction(mean_scale)} times the code that decode expects{fixed_point}"
    off = np.abs(scale - 1) > ALIKE * np.abs(scale - 1).max()
    parts = [
        f"{scale[i]:.3g} times component {fits[i].number}{_shift_said(scale[i], shift[i])}" for i in np.flatnonzero(off)
    ]
    return f"{' and '.join(parts)} of the code that decode expects"


def _fixed_point_text(scale: float, shift: float, probe: Probe) -> str:
    """Return in words, after a comma, the fixed point of the scaling if it is 0.5; otherwise the shift in the user's
    own range. Empty if the fixed point is 0."""
    own = (1 - scale + shift) / 2 if probe.is_unit else shift
    stays = own / (1 - scale)
    # Codes in [0, 1] that have become [-1, 1] by the user's own doing are scaled about -1.
    if abs(stays) < NEAR_A_POINT or (abs(stays + 1) < NEAR_A_POINT and not probe.is_unit):
        return ""
    if abs(stays - 0.5) < NEAR_A_POINT:
        return ", around 0.5"
    return f", {'plus' if own > 0 else 'minus'} {_of_steps(abs(own))}"


def _of_steps(shift: float) -> str:
    """Return a shift as one step at some bit count, such as `1/255`, if one fits; otherwise as a decimal number."""
    steps = next((2**bits - 1 for bits in BITS if abs(shift * (2**bits - 1) - 1) < NEAR_A_HALF), 0)
    return f"1/{steps}" if steps else f"{shift:.3g}"


def _shift_said(scale: float, shift: float) -> str:
    """Return a shift as ` plus 0.1` or ` minus 0.1`, with the leading space; empty if a component is not shifted in
    [-1, 1] or not shifted in [0, 1]."""
    is_told = min(abs(shift), abs(shift - (scale - 1))) > ALIKE * abs(scale - 1)
    return f" {'plus' if shift > 0 else 'minus'} {abs(shift):.3g}" if is_told else ""


def _fraction(scale: float) -> str:
    """Return a scale as a ratio of the integers that represent 1, such as `254/255`, if such a ratio fits; otherwise
    as a decimal number."""
    fractions = {}
    for steps in (count for bits in BITS for count in (2**bits - 1, 2**bits, 2 ** (bits - 1) - 1)):
        fractions |= {f"{steps - 1}/{steps}": 1 - 1 / steps, f"{steps}/{steps - 1}": steps / (steps - 1)}
    # Of two that float32 does not tell apart the first, whose integers stand for 1.
    fraction, value = min(fractions.items(), key=lambda pair: round(abs(pair[1] - scale) / UNTOLD))
    return fraction if abs(value - scale) < OF_A_FRACTION * abs(value - 1) else f"{scale:.5g}"


def _of_lattice(x: np.ndarray, y: np.ndarray, lattice: Lattice) -> Iterator[str]:
    """Yield at most one line about codes that the encoder itself rounds: rounded to the wrong number of steps,
    rounded down, truncated, or half a step too large.

    Args:
        x, y: the encoder's codes, and the codes that the decoder needs."""
    off = (y - x) / lattice.step
    off = off[np.isfinite(off).all(axis=1) & (np.abs(off) < 4).all(axis=1)]
    kept = x[np.isfinite(y).all(axis=1) & (np.abs((y - x) / lattice.step) < 4).all(axis=1)]
    up, away = np.median(off, axis=0), np.median(off * np.sign(kept), axis=0)
    bits = f"codes are {{}} to {lattice.bits} bits, and all are off by half a step: {{}} half a step before rounding"
    if scaled := list(_lattice_scale(kept, off, lattice)):
        yield from scaled
    elif (np.abs(up - 0.5) < HALF_STEP).all():
        yield bits.format("rounded down", "add")
    elif (np.abs(away - 0.5) < HALF_STEP).all():
        yield bits.format("truncated", "add")
    elif (np.abs(up + 0.5) < HALF_STEP).all():
        yield f"codes are half a step of {lattice.bits} bits too large: is 0.5 added twice before truncation?"


def _lattice_scale(x: np.ndarray, off: np.ndarray, lattice: Lattice) -> Iterator[str]:
    """Yield a line if codes are rounded to one step more or fewer than expected, such as 254 instead of 255."""
    slopes = [_slope(x[:, i], off[:, i]) for i in range(x.shape[1])]
    # One step too many or too few from end to end.
    steps = np.array(slopes) * (2.0 if lattice.is_unit else 1.0)
    if (np.abs(np.abs(steps) - 1) < 0.2).all() and np.ptp(np.sign(steps)) == 0:
        used = lattice.steps - 1 if steps.mean() > 0 else lattice.steps + 1
        yield f"encode gives {used}/{lattice.steps} times the code that decode expects: it rounds to {used} steps"


def scaled_angles(held: Trip) -> Iterator[str]:
    """Yield a line if the two functions divide a full turn into different numbers of steps, such as 256 and 255.

    Args:
        held: directions that the encoding is made for, with their decoded directions.
    """
    for axis, name in enumerate("xyz"):
        across = [(axis + 1) % 3, (axis + 2) % 3]
        wide = np.hypot(*held.n[:, across].T) > WIDE
        given, back = (np.arctan2(*part[wide][:, across[::-1]].T) % TURN for part in (held.n, unit(held.decoded)))
        off = (back - given + TURN / 2) % TURN - TURN / 2
        slope = _slope(given, off)
        left = float(np.std(off - slope * given)) / (float(np.std(off)) or 1.0)
        steps = next((2**bits for bits in BITS if abs(abs(slope) * (2**bits - 0.5) - 1) < OF_A_STEP), 0)
        if steps and left < LEFT:
            takes = (steps, steps - 1) if slope > 0 else (steps - 1, steps)
            yield (
                f"the angle about {name} decodes to {takes[0]}/{takes[1]} of its value: encode uses {takes[0]} "
                f"steps per turn, decode {takes[1]}"
            )
            return


def _slope(x: np.ndarray, off: np.ndarray) -> float:
    return float(np.polyfit(x, off, 1)[0]) if x.size and np.ptp(x) > 0.1 else 0.0
