"""A worker: joins a scheduler of dask, and measures what it is sent, one task at a time in the main thread.

Where the scheduler goes away, the worker waits for it to come back. What it compiled stays.
"""

from __future__ import annotations

import asyncio
import logging
import queue
import socket
import tempfile
import threading
import time
import warnings
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from typing import Any
from urllib.parse import urlsplit

from ...ground.machine.memory import keep_what_is_freed
from ...ground.output.errors import UsageError, tell
from .words import checked_address, require_dask

# What a scheduler knows normalbench's workers by.
RESOURCE = "normalbench"
# What dask serves over HTTP is read by nobody; it listens all the same, so it listens here.
HTTP = "127.0.0.1:0"
# Dask's own variables.
TLS, ENCRYPTED = "DASK_DISTRIBUTED__COMM__TLS__", "DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION"
# How long a worker waits for its scheduler, and how often it asks, in seconds.
PATIENCE_S, AGAIN_S = 60.0, 0.5
# How long a worker sleeps at most while it waits for a job.
LOOKS_S = 1.0

Job = tuple["Future[Any]", Callable[..., Any], tuple[Any, ...], dict[str, Any]]


class MainThread(Executor):
    """Runs what it is given in the thread that calls `serve`: a GL context belongs to one thread for good, and dask
    makes new ones."""

    def __init__(self) -> None:
        self._jobs: queue.SimpleQueue[Job | None] = queue.SimpleQueue()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        self._jobs.put((future, fn, args, kwargs))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Nothing: the next connection goes on with the same thread."""

    def serve(self) -> None:
        """Run jobs until `end`."""
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
        """Take no further jobs."""
        self._jobs.put(None)


class Connection(threading.Thread):
    """Keeps the worker joined to its scheduler; ends the main thread's work where that is gone for good."""

    def __init__(self, address: str, executor: MainThread):
        super().__init__(daemon=True)
        self._address, self._executor = address, executor
        self.joined = False

    def run(self) -> None:
        asyncio.run(self._joined_again_and_again())
        self._executor.end()

    async def _joined_again_and_again(self) -> None:
        seen = time.monotonic()
        while time.monotonic() - seen < PATIENCE_S:
            with suppress(Exception):
                await self._join()
                seen = time.monotonic()
            await asyncio.sleep(AGAIN_S)

    async def _join(self) -> None:
        from distributed import Worker

        worker = Worker(
            self._address,
            host=interface_towards(self._address),
            nthreads=1,
            executor=self._executor,
            resources={RESOURCE: 1},
            local_directory=tempfile.gettempdir(),
            memory_limit=0,
            dashboard=False,
            dashboard_address=HTTP,
            death_timeout=AGAIN_S * 10,
        )
        async with worker:
            self.joined = True
            await worker.finished()


def check_certificates(option: str, address: str, role: str) -> None:
    """Raises UsageError where an address asks for TLS and dask's configuration has no certificate to show, or the
    configuration wants TLS and the address does not.

    Args:
        option: what the address was given to.
        role: client or worker, as dask's configuration says.
    """
    from distributed.security import Security

    given = Security()
    if not address.startswith("tls://"):
        if given.require_encryption:
            raise UsageError(f"{option} {address}: {ENCRYPTED} is set, which wants an address such as tls://HOST:PORT")
        return
    names = (f"{TLS}{name}" for name in ("CA_FILE", f"{role.upper()}__CERT", f"{role.upper()}__KEY"))
    named = f"{', '.join(names)} (docs/secure-workers.md)"
    try:
        is_there = given.get_connection_args(role).get("ssl_context") is not None
    except OSError as error:
        raise UsageError(f"{option} {address}: these files cannot be read: {named}: {error}") from error
    if not is_there:
        raise UsageError(f"{option} {address}: no certificates; set {named}")


def interface_towards(address: str) -> str:
    """The IP address of this machine from which a scheduler is reached: a worker listens on it and on no other.

    Dask by itself listens on all of them, and runs whatever reaches its port.

    Args:
        address: of the scheduler, such as tcp://10.0.0.5:8786.

    Raises:
        OSError: the scheduler's name is unknown, or no network leads to it.
    """
    scheduler = urlsplit(address)
    family, _, _, _, where = socket.getaddrinfo(scheduler.hostname, scheduler.port, type=socket.SOCK_DGRAM)[0]
    # Nothing is sent: connecting a datagram socket only chooses the interface.
    with socket.socket(family, socket.SOCK_DGRAM) as chosen:
        chosen.connect(where)
        found = chosen.getsockname()[0]
    return f"[{found}]" if family == socket.AF_INET6 else found


def serve(address: str) -> bool:
    """Join a scheduler and measure until it is gone; whether it was there at all."""
    from .tasks import probe

    keep_what_is_freed()
    # What it and dask write goes with it; dask may be writing as it ends.
    with tempfile.TemporaryDirectory(prefix="normalbench-", ignore_cleanup_errors=True) as tempfile.tempdir:
        # What takes seconds is done before anybody waits for it.
        probe()
        executor = MainThread()
        connection = Connection(address, executor)
        connection.start()
        executor.serve()
    return connection.joined


def worker_command(address: str) -> int:
    """`normalbench worker`: measure for whoever asks the scheduler.

    Raises:
        UsageError: the address is none, or nobody answers.
        MissingError: dask.distributed is not installed.
    """
    checked = checked_address("worker", address)
    require_dask()
    quiet()
    check_certificates("worker", checked, "worker")
    warnings.simplefilter("ignore")
    tell(f"joins {checked}; interrupt it to end it")
    if not serve(checked):
        raise UsageError(f"{checked}: nobody answers; start a scheduler there: dask scheduler")
    tell(f"{checked} is gone")
    return 0


def quiet() -> None:
    """Dask says nothing of lost connections: they are seen to."""
    # Its import sets levels of its own.
    import distributed  # noqa: F401

    # asyncio's complaints are of dask's own tasks, which end with a lost scheduler.
    for name in ("asyncio", "distributed", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed"):
            logging.getLogger(name).setLevel(logging.CRITICAL)
