"""A scheduler and worker processes on this machine. Whichever of them ends is started again."""

from __future__ import annotations

import subprocess
import tempfile
from typing import IO

from ...ground.machine.children import environment, python
from ...ground.machine.posix.processes import OWN_GROUP
from ...ground.output.errors import UsageError, tell
from .worker import ENCRYPTED

START_S, END_S = 60.0, 5.0
# Workers that end by themselves, one for each that there should be, this often: none will stay.
MOST_FAILURES = 3


class Process:
    """A process that ends when this one does, or is told to."""

    def __init__(self, module: str, *words: str):
        self._errors: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 # as long as the process
        self.popen = subprocess.Popen(
            python(f"{__package__}.{module}", *words),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            # Nothing of them leaves this machine, and certificates may name another one.
            env=environment() | {ENCRYPTED: "False"},
            **OWN_GROUP,
            text=True,
        )

    @property
    def is_there(self) -> bool:
        return self.popen.poll() is None

    @property
    def said(self) -> str:
        """The last line that it wrote to standard error."""
        self._errors.seek(0)
        lines = self._errors.read().decode(errors="replace").strip().splitlines()
        return lines[-1].strip() if lines else f"exit status {self.popen.poll()}"

    def first_line(self) -> str:
        assert self.popen.stdout
        return self.popen.stdout.readline().strip()

    def end(self) -> None:
        """Ask it to end; `wait` sees to it that it does."""
        self.popen.terminate()

    def wait(self) -> None:
        try:
            self.popen.wait(END_S)
        except subprocess.TimeoutExpired:
            self.popen.kill()
            self.popen.wait()
        for stream in filter(None, (self.popen.stdin, self.popen.stdout, self._errors)):
            stream.close()


class LocalProcesses:
    """So many workers and their scheduler.

    Raises:
        UsageError: they do not start.
    """

    def __init__(self, count: int):
        self._failures = 0
        self.scheduler = Process("scheduler")
        self.workers: list[Process] = []
        try:
            self.address = self.scheduler.first_line()
            if not self.address:
                self.scheduler.popen.wait(START_S)
                raise UsageError(f"--on local: the scheduler does not start: {self.scheduler.said}")
            self.workers += [Process("worker", self.address) for _ in range(count)]
        except BaseException:
            self.close()
            raise

    def look_after(self) -> bool:
        """Start again what has ended; whether that was the scheduler. Raises UsageError where nothing stays."""
        self.workers = [one if one.is_there else self._again(one) for one in self.workers]
        if self.scheduler.is_there:
            return False
        tell("the scheduler was lost; another one is started")
        self.scheduler.wait()
        self.scheduler = Process("scheduler", self.address.rpartition(":")[2])
        return True

    def _again(self, ended: Process) -> Process:
        said, status = ended.said, ended.popen.returncode
        ended.wait()
        self._failures += status > 0
        if self._failures >= MOST_FAILURES * len(self.workers):
            raise UsageError(f"--on local: the workers do not stay: {said}")
        return Process("worker", self.address)

    def close(self) -> None:
        """End all of them."""
        processes = [*self.workers, self.scheduler]
        for one in processes:
            one.end()
        for one in processes:
            one.wait()
