"""Work shared among the cores. Imports nothing heavy."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from .systems.processes import on_fork, usable_cores

T = TypeVar("T")
Item = TypeVar("Item")


def cores() -> int:
    """Return the number of cores that this process may use."""
    return usable_cores()


# Threads that wait for the next call, by how many there are: to start and end them takes as long as a chunk of normals.
_waiting: dict[int, list[ThreadPoolExecutor]] = {}
# A forked process has none of them.
on_fork(_waiting.clear)


def on_all_cores(
    function: Callable[[Item], T], items: Iterable[Item], stop: Callable[[], None] = lambda: None
) -> Iterator[T]:
    """Yield a function's result for each item, in order. Only a few items are in progress at once, so that memory
    stays constant for any number of items. The calling thread iterates over the items. If that thread is interrupted,
    call `stop`, which may cut the work in progress short, and wait for this work to end."""
    # Half of the threads wait: for the kernel to clear memory, and for the one that asks for the results.
    threads, ahead = 2 * cores(), deque()
    others = _waiting.setdefault(threads, [])
    pool = others.pop() if others else ThreadPoolExecutor(threads)
    try:
        for item in items:
            ahead.append(pool.submit(function, item))
            if len(ahead) >= threads:
                yield ahead.popleft().result()
        while ahead:
            yield ahead.popleft().result()
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        stop()
        pool.shutdown()
        raise
    others.append(pool)
