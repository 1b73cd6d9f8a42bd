"""Whoever writes files and is killed leaves the old ones or the new ones, and the next one leaves what it should."""

import json
import shutil
import subprocess
import sys

import killing
import pytest

from normalbench.bench.shaders.isa import null_device


@pytest.mark.parametrize("writer", killing.WRITERS)
def test_a_writer_killed_before_any_of_its_changes_leaves_whole_files(tmp_path, writer):
    """Its partial files are halved, rows lose their end, and it is killed. The same writer then ends with the files of
    one that nobody disturbed, and nothing else."""
    if writer == "library" and not shutil.which(null_device.COMPILER):
        pytest.skip("no C compiler")
    command = [sys.executable, killing.__file__, writer, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) >= 3, "it was hardly killed"
