"""Checks for sufficient memory, and ways to return memory to the system. Imports nothing heavy."""

from __future__ import annotations

import atexit
import gc
import sys

from ..output.errors import MissingError
from .systems.files import c_function
from .systems.processes import most_addresses

# Bytes of addresses. On two cores JAX alone started with 1.6 GB, `quality` by OpenGL with 2.0 and `budget` with 2.5.
LEAST = 2_500_000_000
# mallopt's names in glibc's malloc.h; by itself glibc has up to eight heaps for each core, each with its own holes.
M_ARENA_MAX, ARENAS = -8, 2
# By itself glibc gives back what a chunk of normals needed, and the system clears it anew for the next, which takes a
# quarter of the time. The first is the most that mallopt takes in 64 bits.
M_MMAP_THRESHOLD, LARGEST_IN_HEAPS = -3, 2**25
M_TRIM_THRESHOLD, KEPT = -1, 2**30


def require_memory() -> None:
    """Raise MissingError if JAX and a graphics driver would not start for lack of address space: their libraries would
    then end the process without a message from normalbench."""
    if why := lack_of_memory():
        raise MissingError(why)


def lack_of_memory() -> str:
    """Return a message with advice if this process is limited to too little memory; empty if it is not."""
    most = most_addresses()
    if most is None or most >= LEAST:
        return ""
    limit = f"this process may use {most / 1e9:.2g} GB of address space, but JAX and OpenGL need {LEAST / 1e9:g} GB"
    return f"not enough memory: {limit}; raise the limit: ulimit -v {LEAST // 1000}"


def have_few_heaps() -> None:
    """Make all threads share two heaps from now on; this has no effect unless the C library is glibc."""
    _mallopt(M_ARENA_MAX, ARENAS)


def keep_what_is_freed() -> None:
    """Keep freed memory in this process for reuse; this has no effect unless the C library is glibc."""
    _mallopt(M_MMAP_THRESHOLD, LARGEST_IN_HEAPS)
    _mallopt(M_TRIM_THRESHOLD, KEPT)


def _mallopt(name: int, value: int) -> None:
    if mallopt := c_function("mallopt"):
        mallopt(name, value)


def give_back_what_is_freed() -> None:
    """Return freed memory within the heaps to the system: tens of megabytes after a frame, in a few milliseconds."""
    if trim := c_function("malloc_trim"):
        trim(0)


def give_back_what_a_table_needed() -> None:
    """Free unreferenced objects and compiled programs: hundreds of megabytes. The next table reads the programs that
    it shares with earlier tables from the cache."""
    gc.collect()
    if jax := sys.modules.get("jax"):
        jax.clear_caches()
    give_back_what_is_freed()


def look_for_garbage_seldom() -> None:
    """Make the garbage collector run after 50,000 new objects instead of 700. Imports and JAX create a million
    objects, and nearly all of them are kept."""
    gc.set_threshold(50_000, 10, 10)


def keep_what_is_imported() -> None:
    """Exclude all objects that exist now from garbage collection: with JAX, a million objects would be examined
    repeatedly for nothing."""
    gc.collect()
    gc.freeze()
    # At the end it is let go like all else, or libraries in C++ complain of leaks.
    atexit.register(gc.unfreeze)
