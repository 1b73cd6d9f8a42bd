"""The number of times that the loops of an encoding run, and the issue slots that a kernel takes as a result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np

from ....encodings.catalogue import is_in_catalogue
from ....encodings.codecs.encoding import Encoding
from ....gbuffer.codecs.loops import turns_made
from ....gbuffer.gl.device import Device
from ....gbuffer.gl.shader import ShaderError
from ...ground.output import cache as kept
from ...ground.output.sources import sources

# Normals that the turns of loops are counted for.
COUNT, SEED = 2048, 0
# What the eye is from what it sees, for codes that depend on it.
VIEW = (0.0, 0.0, -5.0, 0.0)


@cache
def turns_of(encoding: Encoding) -> Mapping[str, Sequence[Sequence[float]]] | None:
    """Return the mean and the standard deviation of the number of turns, by operation, for each loop that runs.

    None if no device can count the turns, or the shader code cannot be counted.
    """
    # It imports JAX, which only loops are worth.
    from ...ground.machine.devices import found_device

    device, _ = found_device()
    if not device:
        return None
    name = encoding.name if is_in_catalogue(encoding) else None
    key = kept.key_of("turns", sources(), name, device.renderer) if name else ""
    return kept.kept(key, lambda: {"turns": _loop_turns(device, encoding)})["turns"]


def _loop_turns(device: Device, encoding: Encoding) -> dict[str, list[list[float]]] | None:
    n = np.zeros((COUNT, 4), np.float32)
    n[:, :3] = np.random.default_rng(SEED).normal(size=(COUNT, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    if encoding.domain != "sphere":
        n[:, 2] = np.abs(n[:, 2])
    try:
        loop_turns = turns_made(device, encoding, n, np.tile(np.array(VIEW, np.float32), (COUNT, 1)))
    except ShaderError:
        return None
    return {name: _mean_turns(turns) for name, turns in zip(("encode", "decode"), loop_turns, strict=True)}


def _mean_turns(turns: np.ndarray) -> list[list[float]]:
    figures = zip(turns.mean(axis=0).tolist(), turns.std(axis=0).tolist(), strict=True)
    return [[mean, deviation] for mean, deviation in figures if mean]


def executed_slots(
    kinds: Sequence[str], rates: Mapping[str, int], loops: Sequence[range], turns: Sequence[Sequence[float]]
) -> float | None:
    """Return the issue slots that a lane of a kernel takes, with its loops run; None if the listing has more loops
    than the source.

    Args:
        kinds: the kind of each instruction, in the order of the listing.
        rates: slots by kind; a kind without a rate takes no slots.
        loops: the positions of each loop's instructions in the listing.
        turns: mean and standard deviation of the turns of each loop, in source order.
    """
    if len(loops) > len(turns):
        return None
    # A compiler unrolls what runs a known and small number of times; the others stay, in their order.
    rank = sorted(range(len(turns)), key=lambda number: (turns[number][1] > 0, turns[number][0]), reverse=True)
    left = [turns[index][0] for index in sorted(rank[: len(loops)])]
    by_place = zip(sorted(loops, key=lambda loop: loop.start), left, strict=True)
    times = [1.0] * len(kinds)
    # An inner loop's count is of all its turns: it comes after the loop around it.
    for places, count in sorted(by_place, key=lambda pair: -len(pair[0])):
        times[places.start : places.stop] = [count] * len(places)
    return sum(rates.get(kind, 0) * count for kind, count in zip(kinds, times, strict=True))
