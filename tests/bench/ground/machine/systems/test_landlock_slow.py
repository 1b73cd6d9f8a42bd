"""A process behind a Landlock wall, and its children, can access only the listed files and folders."""

import os

import pytest
import test_landlock
from test_landlock import SECRET, tried

from normalbench.bench.ground.machine.systems import landlock

pytestmark = pytest.mark.skipif(
    not landlock.is_available() and not os.environ.get("CI"), reason="this kernel has no Landlock"
)
place = test_landlock.place


def test_python_behind_a_wall_imports_modules_and_writes_to_its_folder(place):
    """This program and its dependencies can be imported; a folder that may be read cannot be written."""
    line = f"import numpy, normalbench; open({str(place / 'made')!r}, 'w').write('1')"
    assert tried(place, line).returncode == 0 and (place / "made").read_text() == "1"
    outside = place.parent / "outside"
    read = tried(place, f"print(open({str(outside / 'secret')!r}).read())", str(outside))
    assert read.stdout == f"{SECRET}\n", read.stderr
    assert "PermissionError" in tried(place, f"open({str(outside / 'new')!r}, 'w')", str(outside)).stderr
