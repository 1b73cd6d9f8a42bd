"""A dask scheduler on this machine and the workers that joined it, started as a user starts them."""

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
        """Start a scheduler; at the same port, it replaces another scheduler."""
        words = [port if word == "0" else word for word in SCHEDULER]
        self.scheduler = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
        lines = iter(self.scheduler.stderr.readline, "")
        self.address = next(match[1] for line in lines if (match := re.search(r"Scheduler at:\s+(\S+)", line)))

    def join(self, variables: Mapping[str, str] = os.environ) -> subprocess.Popen[str]:
        """Start a worker."""
        command = [sys.executable, "-m", "normalbench", "worker", self.address]
        self.workers.append(subprocess.Popen(command, stderr=subprocess.DEVNULL, text=True, env=dict(variables)))
        return self.workers[-1]

    def end(self) -> None:
        """End all processes, by force if that takes too long; another test checks that a worker ends when told to."""
        for process in (*self.workers, self.scheduler):
            process.terminate()
        for process in (*self.workers, self.scheduler):
            try:
                process.communicate(timeout=30)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()


@contextmanager
def scheduled(*workers: Mapping[str, str]) -> Iterator[Scheduled]:
    """Yield a scheduler with a worker for each set of variables."""
    cluster = Scheduled()
    try:
        for variables in workers:
            cluster.join(os.environ | variables)
        yield cluster
    finally:
        cluster.end()
