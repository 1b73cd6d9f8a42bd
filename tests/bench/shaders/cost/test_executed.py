"""Issue slots as they are executed: how often loops run, and what that makes of a listing."""

import numpy as np
import pytest

from normalbench.bench.subjects.codecs.names import encodings_named
from normalbench.bench.tables.cost import executed
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.codecs.loops import turns_made

# A loop whose turns depend on the normal, with an `if` without braces before it, one in it that runs twice, one behind
# its body, and text in a comment that is no loop.
LOOPS = """// components: 2
// for (;;) while (true)
vec2 looped_encode(vec3 n, vec3 view) {
    float x = n.x;
    if (n.z > 0.0) for (int i = 0; i < 3 + (n.x > 0.0 ? 4 : 0); ++i)
        for (int k = 0; k < 2; ++k) x += 1e-9 * float(i + k);
    int left = 5;
    do { x -= 1e-9; --left; } while (left > 0);
    return vec2(x, n.y);
}
vec3 looped_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(0.0, 1.0 - dot(e, e)))); }
"""


def normals(count: int = 512) -> np.ndarray:
    n = np.zeros((count, 4), np.float32)
    n[:, :3] = np.random.default_rng(3).normal(size=(count, 3))
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def test_turns_are_counted_loop_by_loop_and_normal_by_normal(gl, tmp_path):
    (tmp_path / "looped.glsl").write_text(LOOPS)
    (encoding,) = encodings_named(str(tmp_path / "looped.glsl"))
    n = normals()
    encoded, decoded = turns_made(gl, encoding, n, np.zeros_like(n))
    outer = np.where(n[:, 2] > 0, np.where(n[:, 0] > 0, 7, 3), 0)
    assert encoded.shape == (512, 3) and not decoded.any()
    assert (encoded == np.stack([outer, 2 * outer, np.full(512, 5)], axis=1)).all()


def test_the_bisection_of_optimised_rings_takes_eight_turns(gl):
    """180 rings: log2 of them, rounded up, for most codes."""
    n = normals()
    _, decoded = turns_made(gl, ENCODINGS["optimised_rings"], n, np.zeros_like(n))
    bisected = decoded[:, -1]
    assert set(np.unique(bisected)) == {7.0, 8.0} and bisected.mean() == pytest.approx(7.9, abs=0.1)


def test_a_loop_takes_its_slots_as_often_as_it_runs():
    """By hand: 1 + 2 outside, an outer loop of 3 slots that runs 4 times, around one of 2 slots that runs 12 times."""
    kinds, rates = ["a", "b", "a", "c", "a", "b"], {"a": 1, "b": 2}
    loops = [range(1, 5), range(2, 5)]
    assert executed.executed_slots(kinds, rates, [], []) == 7
    assert executed.executed_slots(kinds, rates, loops, [[4.0, 0.5], [12.0, 0.5]]) == 1 + 4 * 2 + 12 * 2 + 2
    # What the text has more was unrolled: what runs longest and varies stays.
    turns = [[3.0, 0.0], [4.0, 0.5], [12.0, 0.5]]
    assert executed.executed_slots(kinds, rates, loops, turns) == 35
    assert executed.executed_slots(kinds, rates, loops, turns[:1]) is None
