"""Child processes for untrusted code and files. Imports nothing heavy.

They import nothing from the current folder. Processes that run users' code limit their own resources.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any

from .systems.processes import end_group, limit, signal_name, started

# Of a process that runs users' code: bytes of memory, seconds of processor time, bytes of a file.
MEMORY, SECONDS, FILE = 1536 << 20, 10, 16 << 20


def python(module: str, *words: str) -> list[str]:
    """Return the command that runs a module of this program with arguments; `-P` keeps the current folder out of
    the search path."""
    return [sys.executable, "-P", "-m", module, *words]


def environment() -> dict[str, str]:
    """Return the environment of this process, without relative folders in PYTHONPATH."""
    folders = [word for word in os.environ.get("PYTHONPATH", "").split(os.pathsep) if Path(word).is_absolute()]
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | (
        {"PYTHONPATH": os.pathsep.join(folders)} if folders else {}
    )


def limit_this_process() -> None:
    """Limit this process's memory, processor time and files. Exceeding a limit ends this process and no other."""
    limit(SECONDS, FILE, MEMORY)


# What other threads wait for.
_under_way: set[subprocess.Popen[Any]] = set()


def stop() -> None:
    """End the commands that are running; their callers see them as killed."""
    for process in [*_under_way]:
        end_group(process)


def finished(command: Sequence[str], seconds: float, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder, and return its status and its output. The command, and all processes that it
    started, are ended after at most `seconds`.

    The output is written to files; the command itself limits their size.

    Raises:
        TimeoutExpired: the command took longer; the error has the output until then.
    """
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        files = {"stdin": subprocess.DEVNULL, "stdout": out, "stderr": err}
        process = started(command, **files, env=environment(), cwd=folder)
        _under_way.add(process)
        try:
            status = process.wait(seconds)
        except subprocess.TimeoutExpired:
            status = None
        finally:
            # Those of its group as well that are left.
            end_group(process)
            process.wait()
            _under_way.discard(process)
        outputs = [text_of(file) for file in (out, err)]
    if status is None:
        raise subprocess.TimeoutExpired(command, seconds, *outputs)
    return subprocess.CompletedProcess(list(command), status, *outputs)


def how_it_ended(done: subprocess.CompletedProcess[str]) -> str:
    """Return text on how a process that limits its own resources ended: the signal and the limits, or the exit status
    and the last line that the process printed to standard error."""
    limits = f"its limits were {MEMORY >> 20} MiB of memory and {SECONDS} s of processor time"
    if name := signal_name(done.returncode):
        return f"killed the process ({name}); {limits}"
    last = [line.strip() for line in done.stderr.splitlines() if line.strip()][-1:]
    return f"ended the process with status {done.returncode}" + (f": {last[0][:200]}" if last else "")


def text_of(file: IO[bytes]) -> str:
    """Return the text that a process wrote to a file."""
    file.seek(0)
    return file.read().decode(errors="replace")
