"""A scheduler of dask for this machine alone.

python -m normalbench.bench.run.workers.scheduler [PORT]
"""

from __future__ import annotations

import asyncio
import signal
import sys

from .worker import HTTP, end_now, end_with_parent, own_dask_folder, quiet

HOST = "127.0.0.1"


async def _run(port: int) -> None:
    from dask import config
    from distributed import Scheduler

    config.set(temporary_directory=own_dask_folder())
    async with Scheduler(host=HOST, port=port, dashboard=False, dashboard_address=HTTP) as scheduler:
        print(scheduler.address, flush=True)
        await scheduler.finished()


def main(words: list[str]) -> None:
    """Serve until standard input ends; the address is the first line of standard output."""
    signal.signal(signal.SIGTERM, end_now)
    end_with_parent()
    quiet()
    asyncio.run(_run(int(words[0]) if words else 0))


if __name__ == "__main__":
    main(sys.argv[1:])
