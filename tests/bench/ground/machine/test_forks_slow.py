"""Processes that are forked from a process with the needed imports behave like separate processes."""

import sys

import pytest

from normalbench.bench.ground.machine.systems import forks, linux_forks

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each process imports for itself")


def test_work_continues_if_the_forking_process_ends(monkeypatch):
    """Each process then does its own imports."""
    linux_forks._forking.end()
    monkeypatch.setattr(linux_forks, "_command", lambda _: ["false"])
    done = forks.finished("normalbench.bench.subjects.codecs.first_look", ["gone.glsl"], 60.0)
    assert "there is no such file" in done.stdout
