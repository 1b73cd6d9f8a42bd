"""Encodings in the catalogue that each of two functions matches, in any axes, range and order of components."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .....encodings.catalogue import ENCODINGS
from .....encodings.codecs.encoding import Encoding
from .....gbuffer.gl.device import Device
from ....ground.angles import angles_deg
from ....ground.directions import directions
from .between import NOTHING, RANGES, SAME_DEG, TURNS, Step, decoded_after
from .domains import HALVES, SPHERE, Domain
from .folds import frames
from .probe import Probe, probe_of, trip_of

# How many directions are compared, how near two codes are the same, and of how many that must be so.
COUNT, NEAR, NEARLY_ALL = 64, 0.01, 0.95
# The axes are the first frames of `folds`: every order with every sign.
AXES = 48


@dataclass(frozen=True)
class Likeness:
    """The encodings that each of two functions matches.

    Attributes:
        encoder, decoder: the names of the encodings in the catalogue that the function matches; may be empty.
    """

    encoder: tuple[str, ...]
    decoder: tuple[str, ...]

    def shared(self, domain: str = "") -> str:
        """Return the name of the first encoding that both functions match, with this domain if one is given; empty if
        they share no such encoding."""
        both = [name for name in self.encoder if name in self.decoder]
        return next((name for name in both if domain in ("", ENCODINGS[name].domain)), "")


def likeness(gl: Device, probe: Probe, domain: Domain) -> Likeness:
    """Return the names of the encodings in the catalogue that a user's encode and decode each match on a domain."""
    n = domain.held(trip_of(probe, directions())).n[-COUNT:]
    matrices = np.stack([axes.matrix for axes in frames()[:AXES]])
    # Of shape (axes, count, 3): each direction in each axes.
    turned = np.einsum("aij,nj->ani", matrices, n).astype(np.float32)
    comparable = [e for e in ENCODINGS.values() if _is_comparable(e, probe.size, domain)]
    codes = {e.name: _codes_of(gl, e, turned) for e in comparable}
    own = probe.encode(n)
    encoder = tuple(name for name, its in codes.items() if _is_encoder(own, its, turned, ENCODINGS[name]))
    return Likeness(encoder, _decoders(probe, codes, turned))


def names_alone(gl: Device, probe: Probe, is_encoder: bool) -> tuple[str, ...]:
    """Return the names of the encodings in the catalogue that one function matches: for all directions or, failing
    that, for directions with z >= 0. May be empty."""
    for domain in (SPHERE, HALVES[0]):
        resemblance = likeness(gl, probe, domain)
        if names := resemblance.encoder if is_encoder else resemblance.decoder:
            return names
    return ()


def _is_comparable(encoding: Encoding, size: int, domain: Domain) -> bool:
    """Whether an encoding has `size` components, has its own map, and covers a domain."""
    is_alike = encoding.components + encoding.sign_bits == size and not encoding.is_precise
    return is_alike and (encoding.domain == SPHERE.name or domain.name != SPHERE.name)


def _codes_of(gl: Device, encoding: Encoding, turned: np.ndarray) -> np.ndarray:
    codes = probe_of(gl, encoding).encode(turned.reshape(-1, 3))
    return codes.reshape(*turned.shape[:2], -1)


def _held_mask(encoding: Encoding, turned: np.ndarray) -> np.ndarray:
    """Return whether an encoding is made for each direction, bool of shape (axes, count)."""
    return turned[..., 2] > 0 if encoding.domain != "sphere" else np.full(turned.shape[:2], True)


def _is_encoder(own: np.ndarray, codes: np.ndarray, turned: np.ndarray, encoding: Encoding) -> bool:
    """Whether a user's codes equal an encoding's codes in some axes, up to an affine map of the components."""
    return any(
        _is_linear_fit(own[held], its[held]) for its, held in zip(codes, _held_mask(encoding, turned), strict=True)
    )


def _is_linear_fit(own: np.ndarray, codes: np.ndarray) -> bool:
    wide = np.column_stack([codes, np.ones(len(codes))]).astype(np.float64)
    if len(own) <= 2 * wide.shape[1] or not (np.isfinite(wide).all() and np.isfinite(own).all()):
        return False
    fitted, *_ = np.linalg.lstsq(wide, own.astype(np.float64), rcond=None)
    # A matrix that leaves out a number fits constants.
    if np.linalg.matrix_rank(fitted[:-1], tol=0.1) < own.shape[1]:
        return False
    return bool((np.abs(wide @ fitted - own).max(axis=1) < NEAR).mean() > NEARLY_ALL)


def _decoders(probe: Probe, codes: Mapping[str, np.ndarray], turned: np.ndarray) -> tuple[str, ...]:
    """Return the names of the encodings whose codes a user's decoder accepts, up to a range, a rotation and axes."""
    changes = _code_steps(probe.size)
    names = []
    for name, its in codes.items():
        held = _held_mask(ENCODINGS[name], turned)
        # In axes of which the encoding holds the directions.
        axes_index = int(np.argmax(held.sum(axis=1)))
        back = decoded_after(probe, its[axes_index], changes)
        if held[axes_index].any() and any(_is_decoded_back(decoded, turned, held[axes_index]) for decoded in back):
            names.append(name)
    return tuple(names)


def _is_decoded_back(decoded: np.ndarray, turned: np.ndarray, held: np.ndarray) -> bool:
    with np.errstate(invalid="ignore"):
        near = angles_deg(np.broadcast_to(decoded, turned.shape), turned) < SAME_DEG
    return bool((near[:, held].mean(axis=1) > NEARLY_ALL).any())


def _code_steps(size: int) -> Sequence[Step]:
    if size != 2:
        return RANGES
    return [
        Step("", lambda codes, turn=turn, range_=range_: range_.change(turn.change(codes)))
        for turn in (NOTHING, *TURNS[1:])
        for range_ in RANGES
    ]
