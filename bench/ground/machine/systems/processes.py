"""Processes with their own groups, how they end, limits on their resources, and the cores of this machine."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import Any, NoReturn


@dataclass(frozen=True)
class FileOfChild:
    """A file that another process writes.

    Attributes:
        path: the path to pass to the process.
        descriptors: the descriptors that the process must be given, as `pass_fds` of `subprocess`.
        content: a function that reads what the process wrote.
    """

    path: str
    descriptors: Sequence[int]
    content: Callable[[], bytes]


if sys.platform == "win32":
    from . import windows

    # Of what Windows ends a process with, in words. Other statuses from 0xC0000000 on are said as they are.
    _ENDINGS = {
        1816: "the processor time limit",  # ERROR_NOT_ENOUGH_QUOTA of winerror.h
        0xC0000005: "an access violation",
        0xC0000017: "a lack of memory",
        0xC000001D: "an illegal instruction",
        0xC0000094: "an integer division by 0",
        0xC00000FD: "a stack overflow",
        0xC000013A: "an interruption",
        0xC0000374: "a corrupted heap",
        0xC0000409: "a failed check of its own",
    }

    def started(command: Sequence[str], **how: Any) -> subprocess.Popen[Any]:
        """Start a process in its own job: an interruption of this process does not reach it, and `end_group` ends it
        with all processes that it started. The process ends when this process ends."""
        process = subprocess.Popen(command, creationflags=subprocess.CREATE_NEW_PROCESS_GROUP, **how)
        windows.hold(process.pid)
        return process

    def end_group(process: subprocess.Popen[Any]) -> None:
        """End a process from `started`, and the processes that it started."""
        windows.end(process.pid)

    def end_this_group() -> NoReturn:
        """End this process; its job, which is held by the process that started it, ends the others."""
        os._exit(1)

    def signal_name(status: int) -> str:
        """Return the reason why the system ended a process, given its status; empty if the process ended by
        itself."""
        status &= 0xFFFFFFFF
        return _ENDINGS.get(status, f"0x{status:08X}" if status >= 0xC0000000 else "")

    def limit(seconds: int, _: int, memory: int) -> None:
        """Limit this process to seconds of processor time and bytes of memory. File sizes are not limited on
        Windows."""
        windows.limit_this_process(memory, seconds)

    def limit_memory(most: int) -> None:
        """Limit this process's memory, in bytes."""
        windows.limit_this_process(most)

    limit_addresses = limit_memory

    @contextmanager
    def file_of_child() -> Iterator[FileOfChild]:
        """Yield a file for another process to write, in a folder that is removed afterwards."""
        with TemporaryDirectory(prefix="normalbench-", ignore_cleanup_errors=True) as folder:
            path = Path(folder, "written")
            yield FileOfChild(str(path), (), lambda: path.read_bytes() if path.exists() else b"")

    def is_running(process: int) -> bool:
        """Whether a process with this number exists."""
        return windows.is_running(process)

    def most_addresses() -> int | None:
        """Return None, because this system does not limit the address space of this process."""
        return None

    def on_fork(call: Callable[[], None]) -> None:
        """Do nothing, because this system does not fork processes, in which the function would be called."""

else:
    import resource
    import signal

    def started(command: Sequence[str], **how: Any) -> subprocess.Popen[Any]:
        """Start a process in its own group: an interruption of this process does not reach it, and `end_group` ends
        it with all processes that it started."""
        return subprocess.Popen(command, start_new_session=True, **how)

    def end_group(process: subprocess.Popen[Any]) -> None:
        """End a process from `started`, and the processes that it started."""
        end_group_of(process.pid)

    def end_this_group() -> NoReturn:
        """End this process and its group."""
        end_group_of(0)
        raise AssertionError("it has ended")

    def end_group_of(number: int) -> None:
        """End a group of processes by its number; 0 for this process's own group."""
        try:
            os.killpg(number, signal.SIGKILL)
        except ProcessLookupError:
            return

    def signal_name(status: int) -> str:
        """Return the name of the signal that ended a process, such as SIGSEGV; empty if no signal did."""
        return signal.Signals(-status).name if status < 0 else ""

    def limit(seconds: int, file: int, memory: int) -> None:
        """Limit this process to `seconds` of processor time, `file` bytes per file and `memory` bytes of data.

        Exceeding a limit ends this process and no other, without a core dump.
        """
        _limit({resource.RLIMIT_CPU: seconds, resource.RLIMIT_FSIZE: file, resource.RLIMIT_CORE: 0})
        limit_memory(memory)

    def limit_memory(most: int) -> None:
        """Limit this process's data, in bytes."""
        _limit({resource.RLIMIT_DATA: most})

    def limit_addresses(most: int) -> None:
        """Limit the address space of this process, in bytes."""
        _limit({resource.RLIMIT_AS: most})

    def most_addresses() -> int | None:
        """Return the limit on this process's address space, in bytes; None if the address space is not limited."""
        most = resource.getrlimit(resource.RLIMIT_AS)[0]
        return None if most == resource.RLIM_INFINITY else most

    def _limit(limits: Mapping[int, int]) -> None:
        """Set resource limits in bytes or seconds, by their numbers in `resource`, but not above the hard limits."""
        for number, most in limits.items():
            hard = resource.getrlimit(number)[1]
            resource.setrlimit(number, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))

    @contextmanager
    def file_of_child() -> Iterator[FileOfChild]:
        """Yield a file for another process to write. The file has no name, so that nothing of it remains, however
        this process ends."""
        with TemporaryFile() as file:

            def content() -> bytes:
                file.seek(0)
                return file.read()

            yield FileOfChild(f"/dev/fd/{file.fileno()}", (file.fileno(),), content)

    def is_running(process: int) -> bool:
        """Whether a process with this number exists."""
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return False
        except OSError:
            return True
        return True

    def on_fork(call: Callable[[], None]) -> None:
        """Arrange for a function to be called in each process that is forked from this process."""
        os.register_at_fork(after_in_child=call)


def usable_cores() -> int:
    """Return the number of cores that this process may use."""
    if sys.platform == "linux":
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
