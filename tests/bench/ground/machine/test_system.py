"""The user's home folder, which the program needs before anything else."""

import os
import subprocess
import sys
from pathlib import Path

NOBODY = """
import os, pwd, sys
os.environ.pop("HOME", None), os.environ.pop("XDG_CACHE_HOME", None)
def unknown(*_):
    raise KeyError("uid not found")
pwd.getpwuid = unknown
"""


def as_nobody(code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run code as a user whom the system does not know, with a folder for temporary files."""
    ours = {name: value for name, value in os.environ.items() if not name.startswith("JAX_")}
    variables = ours | {"TMPDIR": str(folder)}
    return subprocess.run([sys.executable, "-c", NOBODY + code], capture_output=True, text=True, env=variables)


def test_a_home_folder_made_by_another_user_is_not_used(tmp_path):
    planted = tmp_path / f"normalbench-home-{os.geteuid()}"
    planted.mkdir()
    planted.chmod(0o777)
    code = "from normalbench.bench.ground.machine.system import prepare; prepare(); print(os.environ['HOME'])"
    home = Path(as_nobody(code, tmp_path).stdout.strip())
    assert home.parent == tmp_path and home != planted and home.stat().st_mode & 0o777 == 0o700
