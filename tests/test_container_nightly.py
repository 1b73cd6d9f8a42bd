"""Dockerfile: its instructions, run in a Debian chroot, yield the same rows as this machine."""

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from containers import Container, missing

ROW = ("quality", "--encoding", "octahedral", "--storage", "rg8", "--normals", "axes", "--backend", "jax,glsl")


WORDS = (*ROW, "--format", "json")


# Who `--user` says: the image knows nobody of that number.
NOBODY = "4321"


@pytest.fixture
def container():
    """A chroot in which the instructions of the Dockerfile were run."""
    if why := missing():
        pytest.skip(why)
    root = Path(tempfile.mkdtemp(prefix="normalbench-container-"))
    root.chmod(0o755)
    chroot = Container(root)
    if chroot.make().returncode:
        pytest.skip("debootstrap reaches no mirror of Debian")
    chroot.build()
    yield chroot
    shutil.rmtree(root)


@pytest.mark.usefixtures("gl")
def test_the_container_measures_the_same_rows_as_this_machine(container):
    """A user other than root measures the rows. A second user, without the first's caches, writes a run and page."""
    assert "Usage" in container.run().stdout
    done = container.run(*WORDS)
    assert done.returncode == 0 and not done.stderr, done.stderr
    here = subprocess.run([sys.executable, "-m", "normalbench", *WORDS], capture_output=True, text=True, check=True)
    same = [{name: value for name, value in row.items() if name not in ("device", "glsl_device")} for row in rows(here)]
    assert [{name: row[name] for name in expected} for expected, row in zip(same, rows(done), strict=True)] == same
    (container.root / "work").chmod(0o777)
    small = ("run", "--tables", "quality,cost", "--encoding", "octahedral", "--storage", "rg8", "-o", "small")
    done = container.run(*small, user=NOBODY)
    assert done.returncode == 0, done.stderr
    assert (container.root / "work/small/report.html").stat().st_uid == int(NOBODY)


def rows(done):
    return json.loads(done.stdout)
