"""Rows of vendors' compilers, compiled once for all tests and their processes."""

import fcntl
import json
import os
from contextlib import contextmanager

import pytest


@pytest.fixture(scope="session")
def shared(tmp_path_factory):
    """A context manager for a locked folder that all workers share."""
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "cost"
    folder.mkdir(exist_ok=True)

    @contextmanager
    def locked(name: str):
        with (folder / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            yield folder

    return locked


@pytest.fixture(scope="session")
def vendor_rows(request, shared):
    """A function that returns a vendor's rows, compiled from an empty cache: some on one family per compiler, or
    every encoding and packing on all families."""

    def rows(vendor, is_every: bool) -> list[dict]:
        request.getfixturevalue(vendor.name)
        name = f"{vendor.name}-{'every' if is_every else 'some'}"
        with shared(name) as folder, pytest.MonkeyPatch.context() as patch:
            path = folder / f"{name}.json"
            if not path.exists():
                patch.setenv("XDG_CACHE_HOME", str(folder / name))
                path.write_text(json.dumps(vendor.rows(is_every)))
        return json.loads(path.read_text())

    return rows
