"""How this process's memory is given back. Imports nothing heavy."""

from __future__ import annotations

import ctypes

# Of glibc's malloc.h: mallopt's names, and what they are set to, in bytes or as a number.
M_TRIM_THRESHOLD, M_MMAP_THRESHOLD, M_ARENA_MAX = -1, -3, -8
LARGE, ARENAS = 1 << 20, 2


def give_back_what_is_freed() -> None:
    """Have large arrays be the system's again once they are freed; elsewhere than on glibc nothing is done.

    By itself glibc raises the size from which it does so with each that is freed, and has as many heaps as eight for
    each core: after a minute of images there are hundreds of megabytes of holes.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt:
        for name, value in ((M_MMAP_THRESHOLD, LARGE), (M_TRIM_THRESHOLD, 16 * LARGE), (M_ARENA_MAX, ARENAS)):
            mallopt(name, value)
