"""Work shared among the cores. Imports nothing heavy."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

T = TypeVar("T")
Item = TypeVar("Item")


def cores() -> int:
    """The cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


# Threads that wait for the next call, by how many there are: to start and end them takes as long as a chunk of normals.
_waiting: dict[int, list[ThreadPoolExecutor]] = {}
# A forked process has none of them.
os.register_at_fork(after_in_child=_waiting.clear)


def on_all_cores(
    function: Callable[[Item], T], items: Iterable[Item], stop: Callable[[], None] = lambda: None
) -> Iterator[T]:
    """What a function makes of each item, in order; few items are under way at once, so that any number of them is
    constant memory. The iterable is run in the calling thread. Where that is interrupted, what is under way is waited
    for, after `stop`, which may cut it short."""
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
