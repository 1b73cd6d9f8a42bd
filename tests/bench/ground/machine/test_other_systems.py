"""What the type checker says that Windows and macOS lack of Linux's Python."""

import pytest
from other_systems import SYSTEMS, is_gone, lacking


@pytest.mark.parametrize("system", SYSTEMS)
def test_the_list_of_what_a_system_lacks_is_the_type_checkers(system):
    assert "pidfd_open" in lacking("os", system) and "sched_getaffinity" in lacking("os", system)
    assert is_gone("fcntl", system) == ("flock" in lacking("fcntl", system)) == (system == "win32")
    assert ("SIGALRM" in lacking("signal", system)) == (system == "win32")
    assert not lacking("os", system) & {"getpid", "replace", "environ"}
