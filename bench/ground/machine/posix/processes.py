"""Processes with a group of their own, how a signal ended one, and what a process may use."""

from __future__ import annotations

import os
import resource
import signal
from collections.abc import Mapping
from typing import IO, TypedDict


class _OwnGroup(TypedDict):
    start_new_session: bool


# What `subprocess` is given: an interruption of this process does not reach the other one, and `end_group` ends it with
# all that it started.
OWN_GROUP = _OwnGroup(start_new_session=True)
# The status of a process that divided a whole number by 0.
DIVIDED_BY_ZERO = -signal.SIGFPE
KILLED = -signal.SIGKILL


def end_group(process: int) -> None:
    """End a process that has a group of its own, by its number, and what is left of those that it started. By 0, this
    process and its group."""
    try:
        os.killpg(process, signal.SIGKILL)
    except ProcessLookupError:
        return


def signal_name(status: int) -> str:
    """The name of the signal that ended a process, such as SIGSEGV; empty where none did."""
    return signal.Signals(-status).name if status < 0 else ""


def limit(seconds: int, file: int, memory: int) -> None:
    """Limit this process to seconds of processor time, and to bytes of a file and of data.

    What goes beyond ends it, and no other; it leaves no image of its memory.
    """
    _limit({resource.RLIMIT_CPU: seconds, resource.RLIMIT_FSIZE: file, resource.RLIMIT_CORE: 0})
    limit_memory(memory)


def limit_memory(most: int) -> None:
    """Limit this process's data, in bytes."""
    _limit({resource.RLIMIT_DATA: most})


def limit_addresses(most: int) -> None:
    """Limit all memory that this process has addresses for, in bytes."""
    _limit({resource.RLIMIT_AS: most})


def _limit(limits: Mapping[int, int]) -> None:
    """Set limits by their numbers; none becomes higher than it was."""
    for number, most in limits.items():
        hard = resource.getrlimit(number)[1]
        resource.setrlimit(number, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


def name_of(file: IO[bytes]) -> str:
    """A path by which a process that is given the file's descriptor opens it, though it has no name."""
    return f"/dev/fd/{file.fileno()}"


def owner() -> int:
    """The number of the user that this process acts for."""
    return os.geteuid()
