"""A writer that is killed leaves the old or the new files, and the next writer completes them."""

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


def test_every_module_that_replaces_a_file_has_a_writer():
    """Such modules call `moved_over`, or `Path.replace` with one argument."""
    assert set(MODULES.values()) <= set(killing.WRITERS)
    modules = set()
    for path in (ROOT / "bench").rglob("*.py"):
        calls = (node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call))
        if any(_puts_a_file(call) for call in calls):
            modules.add(str(path.relative_to(ROOT / "bench")))
    assert modules == set(MODULES)


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
    """Before each kill, partial files are halved and rows lose their end. The same writer then ends with exactly the
    files of an undisturbed writer."""
    if writer == "library" and not shutil.which(null_device.COMPILER):
        pytest.skip("no C compiler")
    command = [sys.executable, killing.__file__, writer, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) >= 3, "it was hardly killed"
