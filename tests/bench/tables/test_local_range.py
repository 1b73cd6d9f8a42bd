"""Codes that are stored within the range of their patch."""

import numpy as np
import pytest

from normalbench.bench.subjects.codecs.names import codecs_named
from normalbench.bench.subjects.normals.normal_sets import CHUNK, cone
from normalbench.bench.tables.quality import measure as quality

COUNT = 2**16


def folded(n: np.ndarray) -> np.ndarray:
    """The octahedral point of directions with z > 0, float64 of shape (count, 2)."""
    return n[:, :2] / abs(n).sum(axis=1, keepdims=True)


def unfolded(e: np.ndarray) -> np.ndarray:
    n = np.column_stack([e, 1 - abs(e).sum(axis=1)])
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def stored(e: np.ndarray) -> np.ndarray:
    return np.rint((e / 2 + 0.5) * 255) / 255 * 2 - 1


def measured(word: str) -> dict:
    (codec,) = codecs_named(word, "rg8", "nearest", has_patches=True)
    return quality.measure(quality.Case(codec, cone(COUNT), "jax"))


@pytest.mark.parametrize("patch", [16, 64, CHUNK])
def test_a_cone_within_its_ranges_is_as_exact_as_numpy_says(patch):
    """Octahedral 8:8 over 10 degrees: 0.0315 in place of 0.210 degrees where all share one range. NumPy in float64, the
    bounds in 16 bits."""
    n = np.stack([np.asarray(c, np.float64) for c in cone(COUNT).chunk(0).n], axis=1)
    e = folded(n)
    held = e.reshape(-1, patch, 2)
    low = np.floor(held.min(axis=1, keepdims=True) * 32767) / 32767
    high = np.ceil(held.max(axis=1, keepdims=True) * 32767) / 32767
    back = low + (stored((held - low) / (high - low) * 2 - 1) / 2 + 0.5) * (high - low)
    apart = np.linalg.norm(unfolded(back.reshape(-1, 2)) - n, axis=1)[:COUNT]
    row = measured(f"octahedral:range={patch}")
    assert row["angle_mean_deg"] == pytest.approx(np.degrees(2 * np.arcsin(apart / 2)).mean(), rel=0.002)
    assert row["bounds_bits"] == 2 * 2 * 16 * max(COUNT / patch, 1) / COUNT and row["domain"] is None
    if patch == CHUNK:
        assert row["angle_mean_deg"] == pytest.approx(0.0315, rel=0.01)
        assert measured("octahedral")["angle_mean_deg"] == pytest.approx(0.210, rel=0.01)


def test_patches_of_one_direction_come_back():
    """Where both bounds of a number would be one, they are a step apart."""
    (codec,) = codecs_named("octahedral:range=4", "rg8", "nearest", has_patches=True)
    n = np.tile(np.float32([[0.6, 0.0, 0.8], [0.0, 0.0, 1.0]]).repeat(4, axis=0), (2, 1))
    found = quality.round_trip(codec, n, np.zeros_like(n))
    assert abs(found / np.linalg.norm(found, axis=1, keepdims=True) - n).max() < 1e-6


@pytest.mark.parametrize(
    "words, says",
    [
        (["quality", "--encoding", "octahedral:range=5"], "a power of two from 4 to 262144, not '5'"),
        (["quality", "--encoding", "spherical_fibonacci:range=64"], "no parameter 'range'"),
        (["quality", "--encoding", "octahedral:range=64:arithmetic=half"], "leave out one of the two"),
        (["render", "--encoding", "octahedral:range=64"], "measured by quality alone"),
        (["code", "octahedral:range=64"], "measured by quality alone"),
    ],
    ids=["5", "an index", "halves", "render", "code"],
)
def test_what_has_no_ranges_is_one_line(run, words, says):
    code, out, err = run(*words)
    assert code == 2 and not out and says in err and err.count("\n") == 1
