"""Processes that are forked from one that has imported what they need behave as processes of their own."""

import sys

import pytest

from normalbench.bench.ground.machine.systems import forks, linux_forks

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each process imports for itself")


def test_one_that_does_not_stay_is_done_without(monkeypatch):
    """Each process then imports for itself."""
    linux_forks._forking.end()
    monkeypatch.setattr(linux_forks, "_command", lambda _: ["false"])
    done = forks.finished("normalbench.bench.subjects.codecs.first_look", ["gone.glsl"], 60.0)
    assert "there is no such file" in done.stdout
