"""What an encoding costs by the clock: encode and decode on the GL device, and in JAX."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from typing import Any

import jax
import jax.numpy as jnp
import moderngl
import numpy as np

from ..encodings.catalogue import ENCODINGS
from ..encodings.storage import STORAGES
from ..encodings.vec import Vec2, Vec3
from ..gbuffer.device import Device
from ..gbuffer.kernels import Operation
from ..gbuffer.render import Clock, clock_of
from ..gbuffer.shader import ShaderError
from .cost import Case, Row
from .metrics import FAST_BLOCK, LANES, compiled
from .throughput import CORES, Input, make_input, on_all_cores

# A pass takes about so long: a thousand times what starting and finishing it takes.
PASS_MS = 6.0
PASSES = 5
# More turns a software rasteriser does not take: it leaves a loop after 65535 without a word.
MOST_TURNS = 2**15
# The first turn finds look-up tables out of reach, the others where the first has left them.
LEAST_TURNS = 16
JAX_SECONDS = 0.03


PROCESSOR = "processor time of each finished pass"


def clock(device: Device) -> Clock:
    """The device's timer queries; of a software rasteriser the time that its threads spend on a processor.

    A wall clock counts whatever else the machine does: on two busy cores medians of nine differences were apart by 40 %
    from run to run, and by 4 % on this clock.
    """

    def by_processor_time(run: Callable[[], object]) -> float:
        start = time.process_time()
        run()
        device.context.finish()
        return (time.process_time() - start) * 1e3

    return Clock(PROCESSOR, by_processor_time) if device.is_software else clock_of(device)


class Field:
    """What the passes of one size share: targets, and what is fetched by how many numbers it has; released with the
    stack."""

    def __init__(self, device: Device, stack: ExitStack, size: tuple[int, int]):
        self.device, self.stack, self.size = device, stack, size
        self.targets = [device.owned(stack, device.target(size, STORAGES["rgba32f"])) for _ in range(2)]
        self._points: dict[int, moderngl.Texture] = {}

    def points(self, numbers: int) -> moderngl.Texture:
        """A texture of directions or codes."""
        if numbers not in self._points:
            self._points[numbers] = self.device.owned(self.stack, self.device.upload(_points(self.size, numbers)))
        return self._points[numbers]


class Timed:
    """One operation beside the empty one, over a whole target. Raises ShaderError where it does not compile."""

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
        self.turns = LEAST_TURNS
        self._calibrate()

    def _calibrate(self) -> None:
        """Turns until a pass is long enough to be timed; every first pass is a warm-up."""
        for passed in self._passes:
            self._milliseconds(passed)
        while (taken := self._shortest()) < PASS_MS / 2 and self.turns < MOST_TURNS:
            self.turns = min(int(self.turns * min(max(PASS_MS / max(taken, 1e-3), 1.5), 8)), MOST_TURNS)

    def _shortest(self) -> float:
        return min(self._milliseconds(self._passes[0]) for _ in range(3))

    def _milliseconds(self, passed: moderngl.VertexArray) -> float:
        turns: Any = passed.program["kernel_turns"]
        turns.value = self.turns

        def run() -> None:
            self._field.device.render(passed, self._field.targets, **self._textures)

        return self._clock.measure(run)

    def difference(self) -> float:
        """Nanoseconds for a million pixels that the operation takes more than the empty one.

        Of a few passes of each, in turns, the shortest: whatever else the machine does only ever makes one longer.
        """
        taken = [[self._milliseconds(passed) for passed in self._passes] for _ in range(PASSES)]
        operation, empty = (min(times) for times in zip(*taken, strict=True))
        return (operation - empty) * 1e6 / (self.turns * math.prod(self._field.size) / 1e6)


def _points(size: tuple[int, int], numbers: int) -> np.ndarray:
    """Directions, or codes of other than three numbers; float32 of shape (height, width, 4), 0 where there is none."""
    points = np.random.default_rng(0).normal(size=(size[1], size[0], numbers)).astype(np.float32)
    # Codes of two numbers lie within the circle, where no method is at its limit.
    points *= (1.0 if numbers == 3 else 0.7) / np.linalg.norm(points, axis=-1, keepdims=True)
    return np.pad(points, ((0, 0), (0, 0), (0, 4 - numbers)))


def time_rows(
    device: Device, chosen: Sequence[Case], size: tuple[int, int], repeats: int, tick: Callable[[str], None]
) -> Iterator[Row]:
    """Nanoseconds a megapixel of each case: the median of repeated differences, and from the least to the largest.

    Each repetition goes over all cases, so that what else the machine does is spread over all of them.
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
        field, made = Field(device, stack, size), dict[Case, Timed | str]()
        for case in chosen:
            try:
                made[case] = Timed(field, case.make())
            except ShaderError as error:
                made[case] = f"{case.name}: {error}"
            tick(case.name)
        taken: dict[Case, list[float]] = {case: [] for case in chosen}
        for number in range(repeats):
            for case, timed in made.items():
                if isinstance(timed, Timed):
                    taken[case].append(timed.difference())
            tick(f"repetition {number + 1}")
        device.idle.use()
    for case, timed in made.items():
        if isinstance(timed, str):
            yield case.row("time", **facts, skipped=timed)
        else:
            yield case.row("time", **facts, turns=timed.turns, **_summary("ns_per_megapixel", taken[case]))


def _summary(column: str, taken: Sequence[float]) -> dict[str, float]:
    """The median, and the distance from the least to the largest: of nine the quartiles are too near each other for
    another run's median to lie within."""
    return {column: float(np.median(taken)), "spread": float(np.ptp(taken))}


def jax_rows(chosen: Sequence[Case], count: int, repeats: int, tick: Callable[[str], None]) -> Iterator[Row]:
    """Million normals a second of each encoding's case in JAX, on all cores: median, and least to largest.

    Args:
        count: normals, rounded down to whole blocks, one for each core at least.
    """
    data = make_input(max(count // (FAST_BLOCK * CORES), 1) * FAST_BLOCK * CORES)
    device = f"{jax.devices()[0].device_kind}, {CORES} cores"
    for case in chosen:
        if case.encoding is not None:
            try:
                taken = _rates(_work(case, data), len(data.n), repeats)
            except Exception as error:  # whatever a user's own code raises
                reason = f"{case.name}: {type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"
                yield case.row("jax", device=device, skipped=reason)
                continue
            facts = {"repeats": repeats, "device": device, "driver": f"jax {jax.__version__}", "clock": "wall clock"}
            yield case.row("jax", **facts, **_summary("millions_per_second", taken))
        tick(case.name)


def _rates(work: Callable[[], object], count: int, repeats: int) -> list[float]:
    """Million normals a second, `repeats` times, each the fastest call of JAX_SECONDS; the first of all compiles."""
    work()
    rates = []
    for _ in range(repeats):
        taken: list[float] = []
        while sum(taken) < JAX_SECONDS:
            begin = time.perf_counter()
            work()
            taken.append(time.perf_counter() - begin)
        rates.append(count / min(taken) / 1e6)
    return rates


def _work(case: Case, data: Input) -> Callable[[], object]:
    """An encoding's operation over the data, all that comes out added up, in blocks that stay in a core's cache."""
    encoding = ENCODINGS[str(case.encoding)]
    function = {"encode": encoding.encode, "decode": encoding.decode}[case.operation]
    size = encoding.components + encoding.sign_bits

    def total(given: Any, view: Vec3):
        def step(carry, block):
            return carry + sum(function(*block)), None

        blocks = jax.tree.map(lambda a: a.reshape(-1, FAST_BLOCK), (given, view))
        return jax.lax.scan(step, jnp.zeros(FAST_BLOCK, jnp.float32), blocks)[0].reshape(-1, LANES).sum()

    call = compiled(total)

    def shard(n: Vec3, view: Vec3) -> float:
        given = n if case.operation == "encode" or size == 3 else Vec2(n.x, n.y)
        return float(call(given, view))

    return lambda: on_all_cores(shard, data)
