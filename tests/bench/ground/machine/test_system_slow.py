"""The user's home folder, which the program needs before anything else."""

from other_systems import START
from test_system import as_nobody


def test_commands_work_for_a_user_without_a_home(tmp_path):
    """The command keeps compiled programs."""
    check_served(tmp_path, ["quality", "--encoding", "xy", "--normals", "axes", "--backend", "jax"])


def check_served(folder, words) -> None:
    """Check that a command prints no message, and keeps its files in a folder that only this user can read."""
    done = as_nobody(f"sys.argv = ['normalbench', *{words}]\n{START}", folder)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    (home,) = [path for path in folder.iterdir() if "home" in path.name]
    assert home.stat().st_mode & 0o777 == 0o700 and (home / ".cache/normalbench").is_dir(), home
