"""The memory that a process keeps and needs."""

import subprocess
import sys

import pytest

ALLOCATE = """
import resource
import numpy as np
from normalbench.bench.ground.machine.memory import keep_what_is_freed
keep_what_is_freed()
np.ones(10**7, np.uint8), np.ones(10**7, np.uint8)
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(100):
    np.ones(10**7, np.uint8)
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="glibc's heap")
def test_freed_memory_is_not_cleared_again_by_the_system():
    """Clearing 10 MB 100 times would cause 244,000 page faults."""
    done = subprocess.run([sys.executable, "-c", ALLOCATE], capture_output=True, text=True, check=True)
    assert int(done.stdout) < 5000
