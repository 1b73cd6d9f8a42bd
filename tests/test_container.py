"""Dockerfile: its lines run in a chroot of Debian end in the rows of this machine."""

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from containers import DOCKERFILE, Container, context, instructions, missing, suite
from manual import PAGES, README

ROW = ("quality", "--encoding", "octahedral", "--storage", "rg8", "--normals", "axes", "--backend", "jax,glsl")
WORDS = (*ROW, "--format", "json")
# Who `--user` says: the image knows nobody of that number.
NOBODY = "4321"


def test_the_dockerfile_has_only_what_the_chroot_can_do():
    lines = instructions(DOCKERFILE.read_text())
    assert lines[0][0] == "FROM" and suite(lines[0][1]) == "bookworm"
    assert all(hasattr(Container, f"_{word.lower()}") for word, _ in lines[1:])
    assert [text for word, text in lines if word == "USER"] == ["bench"], "it runs as somebody who is not root"


def test_the_readme_has_its_two_commands():
    shown = [line.lstrip("# ") for line in DOCKERFILE.read_text().splitlines() if line.startswith("#     docker ")]
    assert len(shown) == 2 and all(f"    {line}\n" in PAGES[README] for line in shown)


def test_docker_gets_the_package_and_no_tests():
    names = context()
    assert {"pyproject.toml", "README.md", "LICENSE", ".ci/setup", "encodings/catalogue.py"} <= set(names)
    assert not [name for name in names if name.startswith(("tests/", "docs/", ".git/"))]


@pytest.fixture
def container():
    """A chroot in which the Dockerfile's lines were run."""
    if why := missing():
        pytest.skip(why)
    root = Path(tempfile.mkdtemp(prefix="normalbench-container-"))
    root.chmod(0o755)
    made = Container(root)
    if made.make().returncode:
        pytest.skip("debootstrap reaches no mirror of Debian")
    made.build()
    yield made
    shutil.rmtree(root)


@pytest.mark.usefixtures("gl")
@pytest.mark.nightly("test_container.py::test_the_dockerfile_has_only_what_the_chroot_can_do")
def test_the_container_ends_in_the_rows_of_this_machine(container):
    """Measured by somebody who is not root. Another one leaves a run with its page, without the caches of the first."""
    assert "Usage" in container.run().stdout
    done = container.run(*WORDS)
    assert done.returncode == 0 and not done.stderr, done.stderr
    here = subprocess.run([sys.executable, "-m", "normalbench", *WORDS], capture_output=True, text=True, check=True)
    same = [{name: value for name, value in row.items() if name not in ("device", "glsl_device")} for row in rows(here)]
    assert [{name: row[name] for name in one} for one, row in zip(same, rows(done), strict=True)] == same
    (container.root / "work").chmod(0o777)
    small = ("run", "--tables", "quality,cost", "--encoding", "octahedral", "--storage", "rg8", "-o", "small")
    done = container.run(*small, user=NOBODY)
    assert done.returncode == 0, done.stderr
    assert (container.root / "work/small/report.html").stat().st_uid == int(NOBODY)


def rows(done):
    return json.loads(done.stdout)
