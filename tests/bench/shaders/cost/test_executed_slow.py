"""Executed issue slots: loop iterations and the totals that follow from a listing."""

import numpy as np
import pytest
from test_executed import normals
from typed import encodings_named

from normalbench.bench.tables.cost import measure
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


def test_turns_are_counted_per_loop_and_per_normal(gl, tmp_path):
    (tmp_path / "looped.glsl").write_text(LOOPS)
    (encoding,) = encodings_named(str(tmp_path / "looped.glsl"))
    n = normals()
    encoded, decoded = turns_made(gl, encoding, n, np.zeros_like(n))
    outer = np.where(n[:, 2] > 0, np.where(n[:, 0] > 0, 7, 3), 0)
    assert encoded.shape == (512, 3) and not decoded.any()
    assert (encoded == np.stack([outer, 2 * outer, np.full(512, 5)], axis=1)).all()


@pytest.mark.usefixtures("gl", "radv")
def test_search_over_128_lengths_counts_every_turn():
    """The static count is below 60 slots, but about 32 slots run 128 times."""
    encodings = [ENCODINGS["best_fit_searched"], ENCODINGS["octahedral"]]
    counts = measure.counted(measure.cases(encodings, (), measure.OPERATIONS), "navi21", "fragment")
    search, plain = counts["best_fit_searched", "encode"], counts["octahedral", "encode"]
    assert plain["executed_slots"] == plain["issue_slots"] == 14
    per_turn = (search["executed_slots"] - search["issue_slots"]) / 127
    assert search["issue_slots"] < 60 and per_turn == pytest.approx(32, abs=2), search["executed_slots"]
