"""Whoever writes files and is killed leaves the old ones or the new ones, and the next one leaves what it should."""

import ast
import json
import shutil
import subprocess
import sys

import killing
import pytest
from manual import ROOT

from normalbench.bench.shaders.isa import null_device

# By the module that puts a file in its place, a writer that is killed there.
MODULES = {
    "ground/machine/systems/files.py": "table",
    "ground/machine/systems/locks.py": "import",
    "ground/output/cache.py": "cache",
    "ground/output/writing.py": "table",
    "shaders/isa/null_device.py": "library",
    "show/site_files.py": "site",
}


def test_every_module_that_puts_a_file_in_its_place_has_a_writer():
    """They are the ones that call `Path.replace`, which takes one argument, or `moved_over`."""
    assert set(MODULES.values()) <= set(killing.WRITERS)
    found = set()
    for path in (ROOT / "bench").rglob("*.py"):
        calls = (node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call))
        if any(_puts_a_file(call) for call in calls):
            found.add(str(path.relative_to(ROOT / "bench")))
    assert found == set(MODULES)


def _puts_a_file(call: ast.Call) -> bool:
    is_replace = isinstance(call.func, ast.Attribute) and call.func.attr == "replace" and len(call.args) == 1
    if isinstance(call.func, ast.Name) and call.func.id == "moved_over":
        return True
    # A journal and a run have one of their own, which takes lines.
    return is_replace and "lines" not in ast.unparse(call)


# Each landing kills the one that puts rows in place of others.
WRITERS = [pytest.param(name, marks=() if name == "import" else pytest.mark.drawn(3)) for name in killing.WRITERS]


@pytest.mark.parametrize("writer", WRITERS)
def test_a_writer_killed_before_any_of_its_changes_leaves_whole_files(tmp_path, writer):
    """Its partial files are halved, rows lose their end, and it is killed. The same writer then ends with the files of
    one that nobody disturbed, and nothing else."""
    if writer == "library" and not shutil.which(null_device.COMPILER):
        pytest.skip("no C compiler")
    command = [sys.executable, killing.__file__, writer, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) >= 3, "it was hardly killed"
