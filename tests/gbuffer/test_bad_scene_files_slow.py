"""Bad mesh files: each is a one-line error, and nothing outside its folder is read."""

from damaged import refusal
from written import ply


def test_large_files_are_refused_before_they_are_read(tmp_path, run):
    """An empty file of a terabyte, and a PLY header that declares too many vertices."""
    with (tmp_path / "a.glb").open("wb") as file:
        file.truncate(2**40)
    assert "1099511627776 bytes" in refusal(run, tmp_path / "a.glb")
    head = ply("binary_little_endian", [[0, 1, 2]]).replace(b"vertex 3", b"vertex 8388608")
    with (tmp_path / "a.ply").open("wb") as file:
        file.write(head)
        file.truncate(2**28)
    assert "8388608 vertices" in refusal(run, tmp_path / "a.ply")
