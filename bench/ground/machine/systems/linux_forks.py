"""Processes for untrusted code, forked from a process that has done their imports. Imports nothing heavy.

Importing JAX takes longer than most work in such a process. Therefore one process imports once, runs nothing, and
forks for each request.

    python -m normalbench.bench.ground.machine.systems.linux_forks DESCRIPTOR

is that process, which receives requests through a socket.
"""

from __future__ import annotations

import atexit
import gc
import importlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import traceback
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import IO, Any, NoReturn

from .. import children
from . import processes
from .preload import LOADERS_VARIABLES

assert sys.platform == "linux"

# A process that nobody has asked for this long ends; the next request starts another one.
IDLE_S, START_S = 60.0, 60.0
LONGEST = 1 << 20
KILLED = (-signal.SIGKILL).to_bytes(4, "little", signed=True)
# What Python, JAX and the loader read once, when they start or are imported; other variables go with each request.
READ_AT_THE_START = ("PYTHON", "JAX_", "XLA_", LOADERS_VARIABLES, "OMP_", "OPENBLAS_")


def finished(module: str, words: list[str], seconds: float) -> subprocess.CompletedProcess[str]:
    """Run `main(words)` of a module of this program in a process, and return its output and status.

    Raises:
        TimeoutExpired: the process took longer; the error has the output until then.
    """
    command = children.python(module, *words)
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        try:
            status = _ended(module, words, (out, err), seconds)
        except OSError:
            return children.finished(command, seconds)
        outputs = [children.text_of(file) for file in (out, err)]
    if status is None:
        raise subprocess.TimeoutExpired(command, seconds, *outputs)
    return subprocess.CompletedProcess(command, status, *outputs)


def _ended(module: str, words: list[str], files: tuple[IO[bytes], IO[bytes]], seconds: float) -> int | None:
    """Run `main(words)` of a module, with its output in two files. Return the process's status as Popen does; None
    if the process was ended after `seconds`."""
    given = {"module": module, "words": words, "folder": str(Path.cwd()), "variables": children.environment()}
    with _asked(json.dumps(given).encode(), files) as answer:
        process = int.from_bytes(answer.recv(4), "little")
        answer.settimeout(seconds)
        _under_way.add(answer)
        try:
            # Nothing comes where somebody killed the process that waits for it.
            return int.from_bytes(answer.recv(4) or KILLED, "little", signed=True)
        except TimeoutError:
            return None
        finally:
            _under_way.discard(answer)
            # What it started as well, which may outlive it.
            processes.end_group_of(process)


# What other threads wait for.
_under_way: set[socket.socket] = set()


def stop() -> None:
    """End the processes that are running; their callers see them as killed."""
    for answer in [*_under_way]:
        with suppress(OSError):
            answer.shutdown(socket.SHUT_RDWR)


def _command(descriptor: int) -> list[str]:
    return children.python("normalbench.bench.ground.machine.systems.linux_forks", str(descriptor))


@dataclass
class _Forking:
    """The process that forks, started when it is needed; threads share it."""

    link: socket.socket | None = None
    process: subprocess.Popen[bytes] | None = None
    started_with: Any = None

    def start(self) -> socket.socket:
        """Start a new process in place of the previous one, and return the socket for requests."""
        self.end()
        self.link, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            self.process = processes.started(
                _command(theirs.fileno()),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                env=children.environment(),
                pass_fds=[theirs.fileno()],
            )
        self.started_with = _read_at_the_start()
        return self.link

    def end(self) -> None:
        """End the process by closing the socket for its requests."""
        if self.link and self.process:
            self.link.close()
            self.process.wait()
        self.link = self.process = None


_forking, _lock = _Forking(), Lock()
atexit.register(_forking.end)


def _read_at_the_start() -> dict[str, str]:
    return {name: value for name, value in children.environment().items() if name.startswith(READ_AT_THE_START)}


def _asked(request: bytes, files: tuple[IO[bytes], IO[bytes]]) -> socket.socket:
    """Request a process, and return the socket that has received its number and will receive its status. Try twice,
    because the process that forks may have ended.

    Raises:
        OSError: the process that forks does not keep running.
    """
    for _ in range(2):
        answer, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        answer.settimeout(START_S)
        with theirs, suppress(OSError), _lock:
            link = _forking.link if _forking.started_with == _read_at_the_start() else None
            socket.send_fds(link or _forking.start(), [request], [theirs.fileno(), *(file.fileno() for file in files)])
        with suppress(OSError):
            if answer.recv(4, socket.MSG_PEEK):
                return answer
        answer.close()
        with _lock:
            _forking.end()
    raise OSError("the process that forks does not stay")


def _serve(link: socket.socket) -> None:
    """Fork for each request, until the other end of the socket is closed or no request has arrived for a long
    time."""
    # Who waits for the process that was asked for is itself waited for by nobody.
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    link.settimeout(IDLE_S)
    while True:
        try:
            request, (answer, *files), _, _ = socket.recv_fds(link, LONGEST, 3)
        except (TimeoutError, ValueError):
            return
        given = json.loads(request)
        module = importlib.import_module(given["module"])
        gc.freeze()
        if not os.fork():
            link.close()
            _watch(module, given, answer, files)
        for descriptor in (answer, *files):
            os.close(descriptor)


def _watch(module: Any, given: dict[str, Any], answer: int, files: list[int]) -> NoReturn:
    """Fork again, and report how the child ended; kill the child if the caller is gone."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    if not (process := os.fork()):
        _run(module, given, answer, files)
    try:
        # Nobody writes there: it can be read once the other end is closed.
        if answer in select.select([os.pidfd_open(process), answer], [], [])[0]:
            os.kill(process, signal.SIGKILL)
            os.killpg(process, signal.SIGKILL)
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
        os.write(answer, status.to_bytes(4, "little", signed=True))
    finally:
        # Who asked may not wait any more.
        os._exit(0)


def _run(module: Any, given: dict[str, Any], answer: int, files: list[int]) -> NoReturn:
    """Run the module's `main` in the request's folder with the request's variables, and end this process with its
    status."""
    status = 1
    try:
        # By this number it is ended, with what it starts: it is known before anything of the user's is run.
        os.setpgid(0, 0)
        os.write(answer, os.getpid().to_bytes(4, "little"))
        os.close(answer)
        for descriptor, file in zip((1, 2), files, strict=True):
            os.dup2(file, descriptor)
            os.close(file)
        os.chdir(given["folder"])
        os.environ.clear()
        os.environ.update(given["variables"])
        module.main(given["words"])
        status = 0
    except SystemExit as error:
        status = error.code if isinstance(error.code, int) else int(error.code is not None)
    except BaseException:
        traceback.print_exc()
    finally:
        # Nothing of the process that it was forked from is to be tidied up.
        with suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(status)


if __name__ == "__main__":
    _serve(socket.socket(fileno=int(sys.argv[1])))
    # Nothing was begun that must be ended.
    os._exit(0)
