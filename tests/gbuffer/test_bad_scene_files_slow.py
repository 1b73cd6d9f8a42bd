"""Bad mesh files: each is refused in one line, and nothing is read outside its folder."""

from damaged import refusal
from written import ply


def test_what_is_too_large_is_refused_before_it_is_read(tmp_path, run):
    """A file of a terabyte that holds nothing, and a PLY header that promises more than there is room for."""
    with (tmp_path / "a.glb").open("wb") as file:
        file.truncate(2**40)
    assert "1099511627776 bytes" in refusal(run, tmp_path / "a.glb")
    head = ply("binary_little_endian", [[0, 1, 2]]).replace(b"vertex 3", b"vertex 8388608")
    with (tmp_path / "a.ply").open("wb") as file:
        file.write(head)
        file.truncate(2**28)
    assert "8388608 vertices" in refusal(run, tmp_path / "a.ply")
