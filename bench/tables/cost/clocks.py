"""The cost of operations, measured by the OpenGL device's clock."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack

import numpy as np

from ....encodings.storages.storage import STORAGES
from ....gbuffer.defines.kernels import Operation
from ....gbuffer.gl.device import Device
from ....gbuffer.gl.handles import Texture
from ....gbuffer.gl.shader import ShaderError
from ....gbuffer.render import Clock, clock_of
from .measure import CostCase, Row

# The median lies within its interval so surely, whatever the times are distributed like.
SURE = 0.95
# A pass takes about so long: a thousand times what starting and finishing it takes.
PASS_MS = 8.0
PASSES = 5
# More turns a software rasteriser does not take: it leaves a loop after 65535 without a word.
MOST_TURNS = 2**15
# The first turn finds look-up tables out of reach, the others where the first has left them.
LEAST_TURNS = 16
# Of the target that is timed. One tile of llvmpipe, which one thread draws: two hinder each other, and on a busy
# machine medians of three runs were apart by 3 % with it and by 10 % at 256x256. A GPU must be filled.
SOFTWARE_SIZE, SIZE = "64x64", "1024x1024"


PROCESSOR = "processor time of each finished pass"


def clock(device: Device) -> Clock:
    """Return a device's clock: its timer queries, or for a software rasteriser the processor time of its threads.

    A wall clock counts all other load on the machine as well: on two busy cores, medians of nine differences varied
    by 40% from run to run, and by 4% with this clock.
    """

    def by_processor_time(run: Callable[[], object]) -> float:
        start = time.process_time()
        run()
        device.context.finish()
        return (time.process_time() - start) * 1e3

    return Clock(PROCESSOR, by_processor_time) if device.is_software else clock_of(device)


class Field:
    """The targets and input textures that all passes of one size share. The textures are kept by their number of
    components. All are released with the stack."""

    def __init__(self, device: Device, stack: ExitStack, size: tuple[int, int]):
        self.device, self.stack, self.size = device, stack, size
        self.targets = [device.owned(stack, device.target(size, STORAGES["rgba32f"])) for _ in range(2)]
        self._points: dict[int, Texture] = {}

    def points(self, numbers: int) -> Texture:
        """Return a texture of random directions (three numbers) or codes, uploaded once per number of components."""
        if numbers not in self._points:
            self._points[numbers] = self.device.owned(self.stack, self.device.upload(_points(self.size, numbers)))
        return self._points[numbers]


class Pair:
    """A timed pass of an operation and the empty pass, with enough turns for both to take far longer than their
    start.

    Args:
        milliseconds: time of one pass, given 0 for the operation's pass or 1 for the empty pass, and the number of
            turns.
        pixels: number of pixels that a pass computes.
    """

    def __init__(self, milliseconds: Callable[[int, int], float], pixels: int):
        self._milliseconds, self._pixels, self.turns = milliseconds, pixels, LEAST_TURNS
        for which in (0, 1):
            milliseconds(which, self.turns)  # a first pass is a warm-up
        while (taken := min(milliseconds(0, self.turns) for _ in range(3))) < PASS_MS / 2 and self.turns < MOST_TURNS:
            self.turns = min(int(self.turns * min(max(PASS_MS / max(taken, 1e-3), 1.5), 8)), MOST_TURNS)

    def difference(self) -> float:
        """Return the nanoseconds per megapixel that the operation takes in addition to the empty pass.

        Both times are the shortest of several passes, because other load on the machine only ever makes a pass
        longer.
        """
        taken = [[self._milliseconds(which, self.turns) for which in (0, 1)] for _ in range(PASSES)]
        operation, empty = (min(times) for times in zip(*taken, strict=True))
        return (operation - empty) * 1e6 / (self.turns * self._pixels / 1e6)


class Passes:
    """The pass of an operation and the empty pass, over a field. Raises ShaderError if either does not compile."""

    def __init__(self, field: Field, operation: Operation):
        device, stack = field.device, field.stack
        self._field, self._clock = field, clock(device)
        self._textures = {"kernel_givens": field.points(operation.given)}
        self._textures |= {"kernel_besides": field.points(operation.beside)}
        self._textures |= {name: device.owned(stack, device.upload(t)) for name, t in operation.tables().items()}
        self._passes = [
            device.owned(stack, device.fragment_pass("kernel_repeat.frag", o.defines, o.names))
            for o in (operation, operation.empty)
        ]

    def milliseconds(self, which: int, turns: int) -> float:
        """Return the milliseconds of a pass: the operation's if `which` is 0, the empty pass's if it is 1."""
        return self._clock.measure(lambda: self.render(which, turns))

    def render(self, which: int, turns: int, nothing: float = 0.0) -> None:
        """Draw the operation's pass (`which` 0) or the empty pass (`which` 1) into the field's targets. `nothing` is
        added to the inputs at each turn; only a test passes a value other than 0."""
        passed = self._passes[which]
        for name, value in (("kernel_turns", turns), ("kernel_nothing", nothing)):
            if name in passed.program:
                passed.program[name] = value
        self._field.device.render(passed, self._field.targets, **self._textures)


def _points(size: tuple[int, int], numbers: int) -> np.ndarray:
    """Return random directions for three numbers, otherwise random codes; float32 of shape (height, width, 4), with 0
    in unused components."""
    points = np.random.default_rng(0).normal(size=(size[1], size[0], numbers)).astype(np.float32)
    # Codes of two numbers lie within the circle, where no method is at its limit.
    points *= (1.0 if numbers == 3 else 0.7) / np.linalg.norm(points, axis=-1, keepdims=True)
    return np.pad(points, ((0, 0), (0, 0), (0, 4 - numbers)))


def time_rows(
    device: Device, chosen: Sequence[CostCase], size: tuple[int, int], repeats: int, tick: Callable[[str], None]
) -> Iterator[Row]:
    """Yield a row for each case: the median of repeated time differences in nanoseconds per megapixel, and the width
    of its interval; or the reason in `skipped` if its shader does not compile.

    Each repetition covers all cases, so that other load on the machine is spread over all of them.
    """
    facts = {
        "size": f"{size[0]}x{size[1]}",
        "repeats": repeats,
        "software": device.is_software,
        "clock": clock(device).name,
        "device": device.renderer,
        "driver": device.version,
    }
    with ExitStack() as stack:
        field, pairs = Field(device, stack, size), dict[CostCase, Pair | str]()
        for case in chosen:
            try:
                pairs[case] = Pair(Passes(field, case.make()).milliseconds, math.prod(size))
            except ShaderError as error:
                pairs[case] = f"{case.name}: {error}"
            tick(case.name)
        taken: dict[CostCase, list[float]] = {case: [] for case in chosen}
        for number in range(repeats):
            for case, pair in pairs.items():
                if isinstance(pair, Pair):
                    taken[case].append(pair.difference())
            tick(f"repetition {number + 1}")
        device.idle.use()
    for case, pair in pairs.items():
        if isinstance(pair, str):
            yield case.row("time", **facts, skipped=pair)
        else:
            yield case.row("time", **facts, turns=pair.turns, **summary("ns_per_megapixel", taken[case]))


def summary(column: str, taken: Sequence[float]) -> dict[str, float]:
    """Return the median of samples as `column`, and the width of its confidence interval as `spread`."""
    low, high = median_interval(taken)
    return {column: float(np.median(taken)), "spread": high - low}


def median_interval(taken: Sequence[float]) -> tuple[float, float]:
    """Return the order statistics that enclose the median of the sampled quantity with a probability of SURE or more.

    For nine samples these are the second and the eighth. For fewer than six they are the smallest and the largest,
    with a lower probability."""
    ordered, count = sorted(taken), len(taken)
    # The chance that fewer than k of the samples lie below the median.
    beyond = np.cumsum([math.comb(count, k) for k in range(count)]) / 2.0**count
    cut = int(np.sum(2 * beyond[: count // 2] <= 1 - SURE))
    return float(ordered[max(cut - 1, 0)]), float(ordered[count - max(cut, 1)])
