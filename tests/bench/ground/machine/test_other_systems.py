"""The parts of Linux's Python that Windows and macOS lack, according to the type checker's stubs."""

import pytest
from other_systems import SYSTEMS, is_gone, lacking


@pytest.mark.parametrize("system", SYSTEMS)
def test_names_missing_from_a_system_come_from_the_type_checker(system):
    assert "pidfd_open" in lacking("os", system) and "sched_getaffinity" in lacking("os", system)
    assert is_gone("fcntl", system) == ("flock" in lacking("fcntl", system)) == (system == "win32")
    assert ("SIGALRM" in lacking("signal", system)) == (system == "win32")
    assert not lacking("os", system) & {"getpid", "replace", "environ"}
