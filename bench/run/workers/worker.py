"""A worker, which joins a dask scheduler and measures the tasks that it receives, one by one in the main thread.

If the scheduler goes away, the worker waits for it to come back, for up to a minute. What it has compiled is kept.
"""

from __future__ import annotations

import asyncio
import logging
import queue
import tempfile
import threading
import time
import warnings
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from typing import Any

from ...ground.machine.memory import keep_what_is_freed
from ...ground.output.errors import UsageError, tell
from .about import marks
from .words import checked_address, require_dask

# What dask raises where it is not set up for an address, as without certificates for TLS.
MISCONFIGURED = (RuntimeError, TypeError, ValueError)
# What dask serves over HTTP is read by nobody; it listens all the same, so it listens here.
HTTP = "127.0.0.1:0"
# How long a worker waits for its scheduler, and how often it asks, in seconds.
PATIENCE_S, AGAIN_S = 60.0, 0.5
# How long a worker sleeps at most while it waits for a job.
LOOKS_S = 1.0

Job = tuple["Future[Any]", Callable[..., Any], tuple[Any, ...], dict[str, Any]]


class MainThread(Executor):
    """An executor that runs jobs in the thread that calls `serve`, because an OpenGL context stays with one thread
    and dask starts new threads."""

    def __init__(self) -> None:
        self._jobs: queue.SimpleQueue[Job | None] = queue.SimpleQueue()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self._jobs.put((future, fn, args, kwargs))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Do nothing: the next connection uses the same thread."""

    def serve(self) -> None:
        """Run jobs in this thread, one after the other, until `end` is called."""
        while job := self._next_job():
            future, function, arguments, named = job
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(function(*arguments, **named))
            except Exception as error:
                future.set_exception(error)

    def _next_job(self) -> Job | None:
        # A signal that another thread was given does not wake this one, which alone can act on it: it looks by itself.
        while True:
            with suppress(queue.Empty):
                return self._jobs.get(timeout=LOOKS_S)

    def end(self) -> None:
        """Make `serve` return after the jobs that are already queued."""
        self._jobs.put(None)


class Connection(threading.Thread):
    """A thread that keeps the worker joined to its scheduler, and ends the main thread's work if the scheduler is
    gone for good.

    Attributes:
        why: why the worker has not joined; empty once it has.
    """

    def __init__(self, address: str, executor: MainThread):
        super().__init__(daemon=True)
        self._address, self._executor = address, executor
        self.why = "the worker has not joined yet"

    def run(self) -> None:
        asyncio.run(self._joined_again_and_again())
        self._executor.end()

    async def _joined_again_and_again(self) -> None:
        seen = time.monotonic()
        while time.monotonic() - seen < PATIENCE_S:
            try:
                await self._join()
                seen = time.monotonic()
            except Exception as error:
                # Dask's own error has no more than that the worker did not start.
                cause = error.__cause__ or error
                self.why = self.why and why(cause)
                if self.why and isinstance(cause, MISCONFIGURED):
                    return
            await asyncio.sleep(AGAIN_S)

    async def _join(self) -> None:
        from distributed import Worker
        from distributed.comm.addressing import get_local_address_for

        worker = Worker(
            self._address,
            # The interface that leads to the scheduler. Dask by itself listens on all, and runs whatever reaches its
            # port.
            host=get_local_address_for(self._address),
            nthreads=1,
            executor=self._executor,
            resources=dict.fromkeys(marks().values(), 1),
            local_directory=tempfile.gettempdir(),
            memory_limit=0,
            dashboard=False,
            dashboard_address=HTTP,
            death_timeout=AGAIN_S * 10,
        )
        async with worker:
            self.why = ""
            await worker.finished()


def why(error: BaseException) -> str:
    """Return why a scheduler could not be reached, from the error of an attempt: advice, and the error's own text."""
    nobody = "" if isinstance(error, MISCONFIGURED) else "no scheduler responded; start one there with: dask scheduler"
    return ": ".join(filter(None, (nobody, str(error))))


def serve(address: str) -> str:
    """Join a scheduler and measure until it is gone. Return why it could not be joined; empty if it was joined."""
    keep_what_is_freed()
    # What it and dask write goes with it; dask may be writing as it ends.
    with tempfile.TemporaryDirectory(prefix="normalbench-", ignore_cleanup_errors=True) as tempfile.tempdir:
        # What takes seconds is done before anybody waits for it.
        marks()
        executor = MainThread()
        connection = Connection(address, executor)
        connection.start()
        executor.serve()
    return connection.why


def worker_command(address: str) -> int:
    """Run `normalbench worker`: measure for all clients of the scheduler, until it is gone, and return exit status 0.

    Raises:
        UsageError: the address is invalid, or no scheduler responds.
        MissingError: dask.distributed is not installed.
    """
    checked = checked_address("worker", address)
    require_dask()
    quiet()
    warnings.simplefilter("ignore")
    tell(f"joining {checked}; interrupt the worker to end it")
    if reason := serve(checked):
        raise UsageError(f"worker {checked}: {reason}")
    tell(f"the scheduler {checked} is gone")
    return 0


def quiet() -> None:
    """Silence dask's messages, such as warnings about lost connections, versions and large tasks."""
    # Its import sets levels of its own.
    import distributed  # noqa: F401

    # asyncio's complaints are of dask's own tasks, which end with a lost scheduler.
    for name in ("asyncio", "distributed", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
    warnings.filterwarnings("ignore", module="distributed")
