"""An encoder and its decoder as functions for any input, and the round trip of directions through them.

Arrays are float of shape (count, ...), with a row for each direction: `n` the direction, `codes` the components of
its code, `decoded` the decoded direction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .....encodings.codecs.encoding import Encoding
from .....gbuffer.codecs.codec_passes import exact_values
from .....gbuffer.gl.device import Device
from ....ground.angles import angles_deg

# The view-space position that every direction is seen at.
VIEW = (0.1, -0.2, -1.0)


@dataclass(frozen=True)
class Probe:
    """The two functions of an encoding, without any storage.

    Attributes:
        encode: a function from directions of shape (count, 3) to codes of shape (count, size).
        decode: a function from codes to decoded directions, which are not normalised.
        size: the number of components of a code.
        is_unit: whether the user's own components are in [0, 1]: c / 2 + 1 / 2 for each component c of a code here.
        is_packed: whether the user's own code is a 32-bit integer, whose halves are the components.
    """

    encode: Callable[[np.ndarray], np.ndarray]
    decode: Callable[[np.ndarray], np.ndarray]
    size: int
    is_unit: bool = False
    is_packed: bool = False

    @property
    def range(self) -> str:
        """The range of a component in the user's own functions, as text."""
        return "[0, 1]" if self.is_unit else "[-1, 1]"

    def own(self, number: float) -> float:
        """Return a component of a code in the range of the user's own functions."""
        return number * 0.5 + 0.5 if self.is_unit else number


def of_unit(probe: Probe) -> Probe:
    """Return a Probe with codes in [-1, 1], made from a probe whose functions use codes in [0, 1]."""
    return Probe(lambda n: probe.encode(n) * 2 - 1, lambda codes: probe.decode(codes * 0.5 + 0.5), probe.size)


def probe_of(gl: Device, encoding: Encoding) -> Probe:
    """Return the two functions of an encoding, run on a device. They raise the same exceptions as `exact_values`."""
    size = encoding.components + encoding.sign_bits

    def both(given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        wide = np.pad(given, ((0, 0), (0, 4 - given.shape[1]))).astype(np.float32)
        view = np.tile(np.array([*VIEW, 0.0], np.float32), (len(wide), 1))
        return exact_values(gl, encoding, wide, view, wide)

    return Probe(
        lambda n: both(n)[0][:, :size], lambda codes: both(codes)[1][:, :3], size, encoding.is_unit, encoding.is_packed
    )


@dataclass(frozen=True)
class Trip:
    """Directions, their view-space positions, their codes, and the directions that the codes, clipped, decode to."""

    n: np.ndarray
    view: np.ndarray
    codes: np.ndarray
    decoded: np.ndarray

    def of(self, which: np.ndarray) -> Trip:
        """Return the part of the trip for some of the directions, given as a mask or as indices."""
        return Trip(self.n[which], self.view[which], self.codes[which], self.decoded[which])

    @property
    def is_finite(self) -> np.ndarray:
        """Whether each direction has a finite code that decodes to finite numbers; bool of shape (count,)."""
        return np.asarray(np.isfinite(self.codes).all(axis=1) & np.isfinite(self.decoded).all(axis=1))

    @property
    def hole(self) -> str:
        """The first direction for which a function is not finite, in words; empty if all results are finite."""
        for what, numbers in (("encode", self.codes), ("decode", self.decoded)):
            indices = np.flatnonzero(~np.isfinite(numbers).all(axis=1))
            if len(indices):
                return f"{what} of {vector(self.n[indices[0]])} is {vector(numbers[indices[0]])}, not finite"
        return ""

    def angles(self) -> np.ndarray:
        """Return the angle between each direction and its decoded direction, in degrees."""
        return angles_deg(self.n, self.decoded)

    def example(self, index: int) -> str:
        """Return in words a direction and its decoded direction."""
        return f"{vector(self.n[index])} becomes {vector(self.decoded[index])}"

    @property
    def worst(self) -> str:
        """The direction with the largest error, and its decoded direction, in words."""
        return self.example(int(np.argmax(self.angles())))


def trip_of(probe: Probe, n: np.ndarray) -> Trip:
    """Return the round trip of directions of shape (count, 3), all seen from the same view-space position."""
    codes = probe.encode(n)
    view = np.broadcast_to(np.array(VIEW, np.float32), n.shape)
    return Trip(n, view, codes, probe.decode(np.clip(codes, -1, 1)))


def vector(values: np.ndarray) -> str:
    """Return numbers as text in parentheses, with three significant digits each."""
    return "(" + ", ".join(f"{value + 0.0:.3g}" for value in values) + ")"
