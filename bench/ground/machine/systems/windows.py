"""Windows calls that Python does not provide: jobs, which hold processes, and whether a process is running.

https://learn.microsoft.com/windows/win32/procthread/job-objects
"""

from __future__ import annotations

import ctypes
import sys
from ctypes import wintypes

assert sys.platform == "win32"

_kernel = ctypes.WinDLL("kernel32", use_last_error=True)
_kernel.CreateJobObjectW.restype = wintypes.HANDLE
_kernel.OpenProcess.restype = wintypes.HANDLE
_kernel.GetCurrentProcess.restype = wintypes.HANDLE

# winnt.h: what a job limits, and what a process is opened for.
PROCESS_TIME, PROCESS_MEMORY, DIE_ON_UNHANDLED_EXCEPTION, KILL_ON_JOB_CLOSE = 0x2, 0x100, 0x400, 0x2000
EXTENDED_LIMITS = 9
SET_QUOTA, TERMINATE, SYNCHRONIZE = 0x0100, 0x0001, 0x00100000
WAIT_TIMEOUT = 0x102
# A job counts time in steps of 100 ns.
TICKS = 10_000_000
ACCESS_DENIED = 5
# The status of a process that its job ended: STATUS_CONTROL_C_EXIT of ntstatus.h, as if it were interrupted.
ENDED = 0xC000013A


class _Basic(ctypes.Structure):
    """JOBOBJECT_BASIC_LIMIT_INFORMATION of winnt.h."""

    _fields_ = (
        ("per_process_user_time_limit", ctypes.c_int64),
        ("per_job_user_time_limit", ctypes.c_int64),
        ("limit_flags", wintypes.DWORD),
        ("minimum_working_set_size", ctypes.c_size_t),
        ("maximum_working_set_size", ctypes.c_size_t),
        ("active_process_limit", wintypes.DWORD),
        ("affinity", ctypes.c_size_t),
        ("priority_class", wintypes.DWORD),
        ("scheduling_class", wintypes.DWORD),
    )


class _Extended(ctypes.Structure):
    """JOBOBJECT_EXTENDED_LIMIT_INFORMATION of winnt.h."""

    _fields_ = (
        ("basic", _Basic),
        ("counters", ctypes.c_uint64 * 6),
        ("process_memory_limit", ctypes.c_size_t),
        ("job_memory_limit", ctypes.c_size_t),
        ("peak_process_memory_used", ctypes.c_size_t),
        ("peak_job_memory_used", ctypes.c_size_t),
    )


# Handles of jobs by the processes that they were made for. A job ends with its last handle, and so do its processes.
_jobs: dict[int, int] = {}
# Of this process.
_own: list[int] = []


def hold(process: int) -> None:
    """Put a process, and all processes that it starts from now on, into a job that ends when this process ends.
    Ignore a process that has ended.

    Raises:
        OSError: Windows refuses.
    """
    handle = _checked(_kernel.OpenProcess(SET_QUOTA | TERMINATE | SYNCHRONIZE, False, process))
    try:
        _jobs[process] = _job_of(handle, _Extended(_Basic(limit_flags=KILL_ON_JOB_CLOSE)))
    except OSError:
        if _waits(handle):
            raise
    finally:
        _kernel.CloseHandle(wintypes.HANDLE(handle))


def end(process: int) -> None:
    """End the remaining processes in the job that `hold` made for a process; do nothing if it made no job."""
    if job := _jobs.pop(process, None):
        _kernel.TerminateJobObject(wintypes.HANDLE(job), wintypes.UINT(ENDED))
        _kernel.CloseHandle(wintypes.HANDLE(job))


def limit_this_process(memory: int, seconds: int = 0) -> None:
    """Limit this process's memory, in bytes, and its processor time, in seconds; 0 seconds for no limit. From then
    on, a crash shows no window.

    Raises:
        OSError: Windows refuses.
    """
    limits = _Extended(_Basic(limit_flags=PROCESS_MEMORY | DIE_ON_UNHANDLED_EXCEPTION), process_memory_limit=memory)
    if seconds:
        limits.basic.limit_flags |= PROCESS_TIME
        limits.basic.per_process_user_time_limit = seconds * TICKS
    # As long as the process: with its last handle the job would be gone.
    _own.append(_job_of(_kernel.GetCurrentProcess(), limits))


def _job_of(process: int, limits: _Extended) -> int:
    """Return the handle of a new job with these limits and a process in it. Raises OSError."""
    job = _checked(_kernel.CreateJobObjectW(None, None))
    size = ctypes.sizeof(limits)
    try:
        _checked(_kernel.SetInformationJobObject(wintypes.HANDLE(job), EXTENDED_LIMITS, ctypes.byref(limits), size))
        _checked(_kernel.AssignProcessToJobObject(wintypes.HANDLE(job), wintypes.HANDLE(process)))
    except OSError:
        _kernel.CloseHandle(wintypes.HANDLE(job))
        raise
    return job


def _checked(result: int) -> int:
    """Return the result of a call. Raises OSError if the result is 0."""
    if not result:
        raise ctypes.WinError(ctypes.get_last_error())
    return result


def is_running(process: int) -> bool:
    """Whether a process with this number is running."""
    handle = _kernel.OpenProcess(SYNCHRONIZE, False, process)
    if not handle:
        # Another user's.
        return ctypes.get_last_error() == ACCESS_DENIED
    try:
        return _waits(handle)
    finally:
        _kernel.CloseHandle(wintypes.HANDLE(handle))


def _waits(handle: int) -> bool:
    """Whether a process, given its handle, is still running."""
    return _kernel.WaitForSingleObject(wintypes.HANDLE(handle), 0) == WAIT_TIMEOUT
