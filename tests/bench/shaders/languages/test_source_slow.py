"""A file with its includes: the folders that may be read, and the original position of each line."""

import contextlib
import time

import pytest
from test_source import written
from typed import Source

from normalbench.bench.ground.output.errors import UsageError


@pytest.mark.parametrize("part", ["", "x\n", "\n" * 10**5, "y" * 10**6])
def test_an_include_bomb_is_refused_at_once(tmp_path, part):
    for number in range(40):
        written(tmp_path, part + f'#include "{number + 1}.hlsli"\n' * 2, f"{number}.hlsli")
    written(tmp_path, "z", "40.hlsli")
    began = time.process_time()
    with pytest.raises(UsageError, match=r"with its includes|are included more than"):
        Source(tmp_path / "0.hlsli")
    assert time.process_time() - began < 4, f"{time.process_time() - began:.1f} s"


@pytest.mark.parametrize("text", ["/* " * 10**6, '\\"' * 10**6, '"' * 10**6, "#include" * 10**5, " " * 10**6 + "#"])
def test_reading_time_grows_only_with_the_length_of_the_text(tmp_path, text):
    """No text is scanned repeatedly; reading happens before any limit applies."""
    path = written(tmp_path, text)
    began = time.process_time()
    with contextlib.suppress(UsageError):
        Source(path)
    assert time.process_time() - began < 2, f"{time.process_time() - began:.1f} s"


def test_includes_that_are_nested_too_deeply_are_refused(tmp_path):
    for number in range(2000):
        written(tmp_path, f'#include "{number + 1}.hlsli"', f"{number}.hlsli")
    with pytest.raises(UsageError, match="nested too deeply"):
        Source(tmp_path / "0.hlsli")
