"""Rows of vendors' compilers, compiled once for all tests and their processes."""

import fcntl
import json
import os

import pytest


@pytest.fixture(scope="session")
def vendor_rows(request, tmp_path_factory):
    """A function that gives a vendor's rows, compiled from an empty cache: some on a family for each of its compilers,
    or every encoding and packing on all of its families."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def rows(vendor, is_every: bool) -> list[dict]:
        request.getfixturevalue(vendor.name)
        path = shared / f"{vendor.name}-{'every' if is_every else 'some'}.json"
        with path.with_suffix(".lock").open("w") as lock, pytest.MonkeyPatch.context() as patch:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not path.exists():
                patch.setenv("XDG_CACHE_HOME", str(path.with_suffix(".cache")))
                path.write_text(json.dumps(vendor.rows(is_every)))
        return json.loads(path.read_text())

    return rows
