"""What an encoding costs by the clock in JAX: million normals a second, beside what moving the same numbers gives."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.encoding import Encoding
from ....encodings.vec import Vec2, Vec3
from ...ground.machine.cores import cores
from ...ground.output.errors import MissingError
from .clocks import summary
from .measure import Case, Row

SECONDS = 0.03
CORES = cores()
# Normals of a block, which stays in a core's cache; and the lanes that are summed apart.
BLOCK, LANES = 2**15, 256

Function = Callable[[Any, Vec3], Any]
Work = Callable[[], object]


def jax_rows(chosen: Sequence[Case], count: int, repeats: int, tick: Callable[[str], None]) -> Iterator[Row]:
    """Million normals a second of each encoding's case, and as `ceiling` what adding up the same numbers as they are
    gives: a rate near it is memory's, and says nothing of the encoding.

    Each repetition goes over all cases, so that what else the machine does is spread over all of them.

    Args:
        count: normals, rounded down to whole blocks, one for each core at least.

    Raises:
        MissingError: they do not fit into memory.
    """
    asked = [case for case in chosen if case.encoding is not None]
    try:
        normals = Normals(max(count // (BLOCK * CORES), 1) * BLOCK * CORES)
    except MemoryError as error:
        raise MissingError(f"--count {count}: this machine lacks the memory for that many normals") from error
    with normals:
        works = {size: normals.work(lambda given, _: given, size) for size in sorted({_size(case) for case in asked})}
        made: dict[Case, Work | str] = {}
        for case in asked:
            made[case] = _work_or_why(case, normals)
            tick(case.name)
        every = {**works, **{case: work for case, work in made.items() if not isinstance(work, str)}}
        taken = {key: list[float]() for key in every}
        for number in range(repeats):
            for key, work in every.items():
                taken[key].append(rate(work, normals.count))
            tick(f"repetition {number + 1}")
    facts = {"repeats": repeats, "device": normals.device, "clock": "wall clock", "driver": f"jax {jax.__version__}"}
    for case, work in made.items():
        if isinstance(work, str):
            yield case.row("jax", device=normals.device, skipped=work)
        else:
            ceiling = summary("ceiling", taken[_size(case)])["ceiling"]
            yield case.row("jax", **facts, ceiling=ceiling, **summary("millions_per_second", taken[case]))


def _size(case: Case) -> int:
    """How many numbers the function of a case takes of each normal."""
    encoding = _encoding(case)
    return 3 if case.operation == "encode" else encoding.components + encoding.sign_bits


def _encoding(case: Case) -> Encoding:
    assert case.encoding, "packings are not timed in JAX"
    return case.encoding


def _work_or_why(case: Case, normals: Normals) -> Work | str:
    """A case's work, run once, which compiles it; or why there is none."""
    encoding = _encoding(case)
    try:
        work = normals.work({"encode": encoding.encode, "decode": encoding.decode}[case.operation], _size(case))
        work()
    except Exception as error:  # whatever a user's own code raises
        return f"{case.name}: {type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"
    return work


class Normals:
    """Normals on the device, and what functions make of them; a context manager that ends its threads.

    On a CPU each core has a part, in blocks that stay in its cache; any other device has them all at once.
    """

    def __init__(self, count: int):
        self.count, self._is_cpu = count, jax.default_backend() == "cpu"
        kind = jax.devices()[0].device_kind
        self.device = f"{kind}, {CORES} cores" if self._is_cpu else kind
        shards = random_shards(count)
        self._shards = shards if self._is_cpu else [joined(shards)]
        self._pool = ThreadPoolExecutor(len(self._shards))

    def __enter__(self) -> Normals:
        return self

    def __exit__(self, *_: object) -> None:
        self._pool.shutdown()

    def work(self, function: Function, size: int) -> Work:
        """A function of numbers, `size` to a normal, and views, over all of them."""
        call = jax.jit(partial(total_by_blocks if self._is_cpu else total, function))
        shards = [(n if size == 3 else Vec2(n.x, n.y), view) for n, view in self._shards]
        return lambda: list(self._pool.map(lambda shard: float(call(*shard)), shards))


def random_shards(count: int, seed: int = 0) -> list[tuple[Vec3, Vec3]]:
    """Directions, uniform on the sphere, and positions in front of the eye: planes of float32, a part for each core."""
    rng = np.random.default_rng(seed)
    n = rng.normal(size=(count, 3)).astype(np.float32)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    view = rng.uniform((-1, -1, -2), (1, 1, -1), (count, 3)).astype(np.float32)
    parts = np.array_split(np.arange(count), CORES)
    return [(_planes(n[part]), _planes(view[part])) for part in parts]


def _planes(rows: np.ndarray) -> Vec3:
    return Vec3(*(jnp.asarray(np.ascontiguousarray(plane)) for plane in rows.T))


def joined(shards: Sequence[tuple[Vec3, Vec3]]) -> tuple[Vec3, Vec3]:
    """The planes of all shards, one after the other."""
    return jax.tree.map(lambda *parts: jnp.concatenate(parts), *shards)


def rate(work: Work, count: int, now: Callable[[], float] = time.perf_counter) -> float:
    """Million normals a second: the fastest call of SECONDS.

    Args:
        work: goes over `count` normals.
        now: seconds.
    """
    taken: list[float] = []
    while sum(taken) < SECONDS:
        begin = now()
        work()
        taken.append(now() - begin)
    return count / min(taken) / 1e6


def total(function: Function, given: Any, view: Vec3) -> Any:
    """All that a function makes of planes, added up."""
    added: Any = sum(function(given, view))
    return added.sum()


def total_by_blocks(function: Function, given: Any, view: Vec3) -> Any:
    """All that a function makes of planes, added up block by block: what a core's cache holds."""

    def step(carry, block):
        return carry + sum(function(*block)), None

    blocks = jax.tree.map(lambda a: a.reshape(-1, BLOCK), (given, view))
    return jax.lax.scan(step, jnp.zeros(BLOCK, jnp.float32), blocks)[0].reshape(-1, LANES).sum()
