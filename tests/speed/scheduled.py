"""A scheduler of dask on this machine and workers that joined it, as a user starts them."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

HOST = "127.0.0.1"
SCHEDULER = [sys.executable, "-m", "dask", "scheduler", "--host", HOST, "--port", "0", "--no-dashboard"]


class Scheduled:
    """A scheduler, its address and its workers."""

    def __init__(self):
        self.workers: list[subprocess.Popen[str]] = []
        self.start()

    def start(self, port: str = "0") -> None:
        """Start a scheduler; at the same port, it takes the place of another one."""
        words = [port if word == "0" else word for word in SCHEDULER]
        self.scheduler = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
        said = iter(self.scheduler.stderr.readline, "")
        self.address = next(match[1] for line in said if (match := re.search(r"Scheduler at:\s+(\S+)", line)))

    def join(self, variables: Mapping[str, str] = os.environ) -> subprocess.Popen[str]:
        """Start a worker."""
        command = [sys.executable, "-m", "normalbench", "worker", self.address]
        self.workers.append(subprocess.Popen(command, stderr=subprocess.DEVNULL, text=True, env=dict(variables)))
        return self.workers[-1]

    def end(self) -> None:
        """End all of them, by force where that takes long: that a worker ends when told to has a test of its own."""
        for one in (*self.workers, self.scheduler):
            one.terminate()
        for one in (*self.workers, self.scheduler):
            try:
                one.communicate(timeout=30)
            except subprocess.TimeoutExpired:
                one.kill()
                one.communicate()


@contextmanager
def scheduled(*workers: Mapping[str, str]) -> Iterator[Scheduled]:
    """A scheduler with a worker for each set of variables."""
    found = Scheduled()
    try:
        for variables in workers:
            found.join(os.environ | variables)
        yield found
    finally:
        found.end()
