"""Common mistakes in an octahedral map, in each of the two functions separately.

An octahedral map projects a direction m, in some axes, to p = m.xy / (|m.x| + |m.y| + |m.z|), and folds points with
m.z < 0 outwards: (1 - |p.yx|) sign(p). Every mistake here is such a map with one change. A function has the mistake
if it matches the changed map for nearly all tested directions, and the other function is right in the same axes. Only
the results of the functions are compared, not their code.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from types import MappingProxyType

import numpy as np

from ....ground.directions import directions, unit
from .probe import Probe, of_unit

# How many directions and codes are compared.
COUNT = 128
# How near two codes are the same, or two unit vectors, and of how many that must be so.
NEAR, NEARLY_ALL = 2e-3, 0.98
# Points of shape (count, 2) to others; a side of the map, of directions to codes or back.
Fold = Callable[[np.ndarray], np.ndarray]
Side = Callable[[np.ndarray], np.ndarray]
Numbers = Sequence[int]


def _signs(p: np.ndarray) -> np.ndarray:
    return np.where(p < 0, -1.0, 1.0)


def _sum(v: np.ndarray, bare: Numbers) -> np.ndarray:
    """Return |v.x| + |v.y| + ..., without the absolute value for the components in `bare`, of shape (count, 1)."""
    return np.where(np.isin(np.arange(v.shape[1]), bare), v, np.abs(v)).sum(axis=1, keepdims=True)


def _fold(p: np.ndarray, bare: Numbers = ()) -> np.ndarray:
    """Return (1 - |p.yx|) sign(p), of shape (count, 2), without absolute values for the p.yx components in `bare`."""
    swapped = p[:, ::-1]
    return (1 - np.where(np.isin(np.arange(2), bare), swapped, np.abs(swapped))) * _signs(p)


def _encoder(fold: Fold = _fold, bare: Numbers = (), in_place: bool = False) -> Side:
    """Return an octahedral encode from (count, 3) to (count, 2), correct or with a mistake.

    Args:
        fold: the function for the half with negative z.
        bare: the components without an absolute value in the sum.
        in_place: whether m itself is divided; a negative sum then changes the sign of the z that decides the fold.
    """

    def encode(m: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore", invalid="ignore"):
            divided = m / _sum(m, bare)
        p = divided[:, :2]
        return np.where((divided if in_place else m)[:, 2:] < 0, fold(p), p)

    return encode


def _decoder(unfold: Fold = _fold, bare: Numbers = (), everywhere: bool = False) -> Side:
    def decode(c: np.ndarray) -> np.ndarray:
        z = 1 - _sum(c, bare)
        return unit(np.concatenate([np.where((z < 0) | everywhere, unfold(c), c), z], axis=1))

    return decode


def _by_size(bare: Numbers) -> Side:
    """Return a decode that unfolds by n.xy -= sign(n.xy) max(-n.z, 0). The sum in n.z has no absolute value for the
    components in `bare`."""

    def decode(c: np.ndarray) -> np.ndarray:
        z = 1 - _sum(c, bare)
        return unit(np.concatenate([c - _signs(c) * np.maximum(-z, 0), z], axis=1))

    return decode


def _beyond(c: np.ndarray) -> np.ndarray:
    """Return |x| + |y| - 1 for each point, of shape (count, 1); positive outside the diamond."""
    return _sum(c, ()) - 1


SOME_OF_TWO = ((0,), (1,), (0, 1))
SOME_OF_THREE = tuple(itertools.chain.from_iterable(itertools.combinations(range(3), size) for size in (1, 2, 3)))
BARE_FOLDS = tuple(partial(_fold, bare=bare) for bare in SOME_OF_TWO)
# Each mistake, and the maps that it makes; "" is the right one.
ENCODERS: Mapping[str, Sequence[Side]] = MappingProxyType(
    {
        "": [_encoder()],
        "its fold is missing": [_encoder(lambda p: p)],
        "its fold uses .xy instead of .yx": [_encoder(lambda p: (1 - np.abs(p)) * _signs(p))],
        "abs() is missing in its fold": [_encoder(fold) for fold in BARE_FOLDS],
        "abs() is missing in |x| + |y| + |z|": [
            _encoder(_fold, bare, in_place) for bare in SOME_OF_THREE for in_place in (False, True)
        ],
        "the sign is missing in its fold": [_encoder(lambda p: 1 - np.abs(p[:, ::-1]))],
    }
)
DECODERS: Mapping[str, Sequence[Side]] = MappingProxyType(
    {
        "": [_decoder()],
        "its unfold is missing": [_decoder(lambda c: c)],
        "its unfold uses .xy instead of .yx": [_decoder(lambda c: (1 - np.abs(c)) * _signs(c))],
        "abs() is missing in its unfold": [_decoder(fold) for fold in BARE_FOLDS],
        "abs() is missing in 1 - |x| - |y|": [
            *(_decoder(_fold, bare) for bare in SOME_OF_TWO),
            *(_by_size(bare) for bare in SOME_OF_TWO),
        ],
        "the sign is missing in its unfold": [
            _decoder(lambda c: 1 - np.abs(c[:, ::-1])),
            _decoder(lambda c: c - _beyond(c)),
        ],
        "the sign is wrong in its unfold": [
            _decoder(lambda c: c + _signs(c) * _beyond(c)),
            _decoder(lambda c: -_fold(c)),
        ],
        "its unfold is also applied if z > 0": [_decoder(everywhere=True)],
    }
)


@dataclass(frozen=True, eq=False)
class Axes:
    """The axes of an octahedron: m = matrix n for a direction n. The codes may also be rotated by 45 degrees."""

    matrix: np.ndarray
    is_turned: bool = False

    def code(self, p: np.ndarray) -> np.ndarray:
        """Return the codes of points in the octahedron's square, of shape (count, 2)."""
        return self._turned_points(p) / 2 if self.is_turned else p

    def point(self, c: np.ndarray) -> np.ndarray:
        """Return the points in the octahedron's square for codes of shape (count, 2)."""
        return self._turned_points(c) if self.is_turned else c

    def _turned_points(self, p: np.ndarray) -> np.ndarray:
        x, y = p.T
        return np.stack([x + y, x - y], axis=1)


@cache
def frames() -> tuple[Axes, ...]:
    """Return the Axes for every order and sign of the axes: unrotated, rotated by 45 degrees around the pole, and
    with rotated codes."""
    half = np.sqrt(0.5)
    about = np.array([[half, half, 0], [half, -half, 0], [0, 0, 1]])
    plain = [
        np.eye(3)[list(order)] * np.array(signs)[:, None]
        for order in itertools.permutations(range(3))
        for signs in itertools.product((1.0, -1.0), repeat=3)
    ]
    turned = [Axes(about @ matrix) for matrix in plain]
    return (*map(Axes, plain), *turned, *(Axes(matrix, True) for matrix in plain))


@dataclass(frozen=True)
class Found:
    """The octahedral maps that two functions match: by mistake, "" for none, the indices of axes in `frames`."""

    encoder: Mapping[str, set[int]]
    decoder: Mapping[str, set[int]]

    def mistakes(self) -> Iterator[str]:
        """Yield the mistake in one function if the other is correct in the same axes; nothing if both are correct."""
        right = self.encoder.get("", set()), self.decoder.get("", set())
        if right[0] & right[1]:
            return
        for name, side, other in (("encode", self.encoder, right[1]), ("decode", self.decoder, right[0])):
            if mistake := next((text for text, axes in side.items() if text and axes & other), ""):
                yield f"{name} is octahedral, but {mistake}"


def mistakes(probe: Probe) -> list[str]:
    """Return the mistakes in an octahedral map with codes in [-1, 1] or [0, 1], as lines; may be empty."""
    if probe.size != 2:
        return []
    return list(found(probe).mistakes()) or list(found(of_unit(probe)).mistakes())


def found(probe: Probe) -> Found:
    """Return the octahedral maps, correct or with a known mistake, that the two functions match, and in which axes.
    Codes must have two components."""
    n, codes = directions()[-COUNT:], np.random.default_rng(1).uniform(-1, 1, size=(COUNT, 2)).astype(np.float32)
    given, back = probe.encode(n), unit(probe.decode(codes))
    # In every axes at once: (axes, count, 3), and the points that codes stand for.
    turned = np.stack([n @ axes.matrix.T for axes in frames()])
    points = np.stack([axes.point(codes) for axes in frames()])
    is_point = np.asarray((np.abs(points) <= 1).all(axis=2))

    def encoded(model: Side) -> np.ndarray:
        model_codes = model(turned.reshape(-1, 3)).reshape(*turned.shape[:2], 2)
        return np.stack([axes.code(p) for axes, p in zip(frames(), model_codes, strict=True)])

    def decoded(model: Side) -> np.ndarray:
        model_normals = model(points.reshape(-1, 2)).reshape(*points.shape[:2], 3)
        return np.stack([m @ axes.matrix for axes, m in zip(frames(), model_normals, strict=True)])

    everywhere = np.full(turned.shape[:2], True)
    return Found(
        _matching_axes(ENCODERS, lambda model: _alike(encoded(model), given, everywhere)),
        _matching_axes(DECODERS, lambda model: _alike(decoded(model), back, is_point)),
    )


def _matching_axes(models: Mapping[str, Sequence[Side]], alike: Callable[[Side], np.ndarray]) -> dict[str, set[int]]:
    matched = {
        mistake: set(np.flatnonzero(np.any([alike(model) for model in variants], axis=0)).tolist())
        for mistake, variants in models.items()
    }
    return {mistake: axes for mistake, axes in matched.items() if axes}


def _alike(modelled: np.ndarray, own: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Return for each choice of axes whether a model's results, of shape (axes, count, size), match the user's
    results in nearly all rows for which `counts` is true; bool of shape (axes,)."""
    with np.errstate(invalid="ignore"):
        near = (np.abs(modelled - own) < NEAR * np.maximum(1, np.abs(own))).all(axis=2)
    # A sum that is 0 is finite in neither.
    neither = ~np.isfinite(modelled).all(axis=2) & ~np.isfinite(own).all(axis=1)
    return ((near | neither) & counts).sum(axis=1) > NEARLY_ALL * counts.sum(axis=1)
