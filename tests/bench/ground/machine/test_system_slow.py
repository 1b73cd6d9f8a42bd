"""What the program needs of a user before anything else is used."""

from other_systems import START
from test_system import as_nobody


def test_a_user_without_a_home_is_served(tmp_path):
    """By a command that keeps compiled programs."""
    check_served(tmp_path, ["quality", "--encoding", "xy", "--normals", "axes", "--backend", "jax"])


def check_served(folder, words) -> None:
    """Nothing is said, and what is kept lies in a folder that is this user's alone."""
    done = as_nobody(f"sys.argv = ['normalbench', *{words}]\n{START}", folder)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    (home,) = [path for path in folder.iterdir() if "home" in path.name]
    assert home.stat().st_mode & 0o777 == 0o700 and (home / ".cache/normalbench").is_dir(), home
