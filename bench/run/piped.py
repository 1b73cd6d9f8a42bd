"""A child process that calls the functions sent to it, one after the other, in its main thread.

    python -m normalbench.bench.run.piped

starts it. Calls arrive through its standard input, and values that functions send leave through its standard output,
as consecutive pickles. The process ends when its standard input ends, for example because the process that started it
was killed. The module imports nothing heavy.
"""

from __future__ import annotations

import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable
from contextlib import suppress
from queue import SimpleQueue
from threading import Event, Thread
from types import FrameType
from typing import IO, Any

from ..ground.machine.children import environment, python, text_of
from ..ground.machine.memory import look_for_garbage_seldom
from ..ground.machine.systems.files import TEMPORARY
from ..ground.machine.systems.processes import end_group, end_this_group, started
from ..ground.output.errors import MissingError, UsageError

# How long a process may take to end by itself, in seconds.
END_S = 5.0
Send = Callable[[Any], None]


class Piped:
    """The child process, for use by the process that started it.

    Args:
        first: called in the child immediately, for example to import modules.
        take: called in a thread with each value that a function sends, and with the exception if a function raised
            one.

    Attributes:
        ended: set when no more values come.
    """

    def __init__(self, first: Callable[[Send], None], take: Callable[[Any], None]):
        self.ended = Event()
        self._folder = tempfile.mkdtemp(prefix="normalbench-")
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 # as long as the process
        self._process = started(
            python(__name__),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            env=environment() | dict.fromkeys(TEMPORARY, self._folder),
        )
        self.call(first)
        self._reader = Thread(target=self._read, args=(take,), daemon=True)
        self._reader.start()

    @property
    def status(self) -> int | None:
        """The exit status of the process, negative for a signal; None while it is running."""
        return self._process.poll()

    def call(self, function: Callable[..., None], *arguments: Any) -> None:
        """Have the child process call a function, and return immediately. The function's first argument is a function
        that sends values here; `arguments` follow. A process that has ended ignores the call."""
        # Bytes within a pickle: importing what they name is left to its main thread.
        call = pickle.dumps(pickle.dumps((function, arguments)))
        assert self._process.stdin
        with suppress(OSError, ValueError):
            self._process.stdin.write(call)
            self._process.stdin.flush()

    def _read(self, take: Callable[[Any], None]) -> None:
        assert self._process.stdout
        # A process that is killed may send a part of a pickle.
        with suppress(EOFError, pickle.UnpicklingError):
            while True:
                take(pickle.load(self._process.stdout))
        self.ended.set()

    def end(self) -> None:
        """Ask the process to end, without waiting for it; `wait` makes sure that it has ended."""
        assert self._process.stdin
        with suppress(OSError):
            self._process.stdin.close()

    def wait(self) -> list[str]:
        """End the process and all processes that it started, delete its folder, and return the lines that it wrote to
        standard error."""
        self.end()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(END_S)
        end_group(self._process)
        self._process.wait()
        self._reader.join()
        shutil.rmtree(self._folder, ignore_errors=True)
        with self._process, self._errors:
            return text_of(self._errors).splitlines()


def _end_now(*_: int | FrameType | None) -> None:
    """End this process immediately, even during a computation, with all that it started, and delete its folder."""
    shutil.rmtree(os.environ[TEMPORARY[0]], ignore_errors=True)
    end_this_group()


def _own_ends() -> tuple[IO[bytes], IO[bytes]]:
    """Return the streams for calls and for values. Afterwards standard input is empty, and standard output goes to
    standard error."""
    calls, values = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    return calls, values


def _take(calls: IO[bytes], waiting: SimpleQueue[bytes]) -> None:
    """Queue calls as they arrive, and end this process when the stream of calls ends."""
    with suppress(EOFError, pickle.UnpicklingError):
        while True:
            waiting.put(pickle.load(calls))
    _end_now()


def _call(call: bytes, send: Send) -> None:
    """Call a pickled function with `send` and its arguments, and send any error that it raises."""
    try:
        function, arguments = pickle.loads(call)
        function(send, *arguments)
    except (UsageError, MissingError) as error:
        send(error)
    except Exception as error:
        send(RuntimeError(f"{type(error).__name__}: {error}\n{traceback.format_exc()}"))


def main() -> None:
    """Call the functions that arrive through standard input, until the input ends and this process with it."""
    look_for_garbage_seldom()
    signal.signal(signal.SIGTERM, _end_now)
    calls, values = _own_ends()
    waiting = SimpleQueue[bytes]()
    Thread(target=_take, args=(calls, waiting), daemon=True).start()

    def send(value: Any) -> None:
        # As a whole: what cannot be sent raises before a part of it was.
        values.write(pickle.dumps(value))
        values.flush()

    while True:
        _call(waiting.get(), send)


if __name__ == "__main__":
    sys.exit(main())
