"""Arrays are computed once per key, and again if the kept file is damaged, open to other users or unusable."""

import io

import numpy as np
import pytest

from normalbench.bench.ground.output import cache
from normalbench.bench.ground.output.kept_arrays import kept_arrays

KEY = "cd" + "0" * 62


@pytest.fixture
def made(own_cache, monkeypatch):
    """A list with an item per computation, a function that returns the kept arrays, and the path of their file."""
    monkeypatch.delenv(cache.OFF, raising=False)
    times = []

    def make():
        times.append(1)
        return {"fine": np.arange(24, dtype=np.float32).reshape(2, 3, 4) / 7, "coarse": np.ones(3)}

    return times, lambda: kept_arrays(KEY, make), own_cache / "normalbench" / "arrays" / f"{KEY}.npz"


def test_arrays_are_computed_once_and_are_bit_identical(made):
    times, ask, path = made
    first, second = ask(), ask()
    assert len(times) == 1 and path.is_file() and cache.is_private(path)
    for name in ("fine", "coarse"):
        assert first[name].dtype == second[name].dtype and np.array_equal(first[name], second[name])


def emptied(data):
    return data[:0]


def cut_off(data):
    return data[: len(data) // 2]


def changed(data):
    return data[:200] + bytes([data[200] ^ 1]) + data[201:]


def another_kind(data):
    array = io.BytesIO()
    np.save(array, np.ones(len(data)))
    return array.getvalue()


@pytest.mark.parametrize("damage", [emptied, cut_off, changed, another_kind])
def test_arrays_in_a_damaged_file_are_computed_again(made, damage):
    times, ask, path = made
    ask()
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    assert ask()["fine"][1, 2, 3] == np.float32(23 / 7) and len(times) == 2
    ask()
    assert len(times) == 2, "what was made anew is kept"


def test_a_file_that_others_may_write_is_not_read(made):
    times, ask, path = made
    ask()
    path.chmod(0o666)
    ask()
    assert len(times) == 2


def test_a_cache_that_is_off_or_not_writable_is_not_an_error(made, monkeypatch):
    times, ask, path = made
    path.parent.parent.mkdir(parents=True)
    path.parent.write_text("a file where the folder would be")
    assert ask()["coarse"].sum() == 3 and ask() and len(times) == 2
    monkeypatch.setenv(cache.OFF, "1")
    path.parent.unlink()
    assert ask() and len(times) == 3 and not path.parent.exists()
