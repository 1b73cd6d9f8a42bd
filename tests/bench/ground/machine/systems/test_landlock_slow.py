"""A process behind a wall of Landlock, and what it starts, get at nothing but what is named."""

import os

import pytest
import test_landlock
from test_landlock import SECRET, tried

from normalbench.bench.ground.machine.systems import landlock

pytestmark = pytest.mark.skipif(
    not landlock.is_available() and not os.environ.get("CI"), reason="this kernel has no Landlock"
)
place = test_landlock.place


def test_python_behind_a_wall_imports_and_writes_its_folder(place):
    """This program and what it needs; a folder that is read is not written."""
    line = f"import numpy, normalbench; open({str(place / 'made')!r}, 'w').write('1')"
    assert tried(place, line).returncode == 0 and (place / "made").read_text() == "1"
    outside = place.parent / "outside"
    read = tried(place, f"print(open({str(outside / 'secret')!r}).read())", str(outside))
    assert read.stdout == f"{SECRET}\n", read.stderr
    assert "PermissionError" in tried(place, f"open({str(outside / 'new')!r}, 'w')", str(outside)).stderr
