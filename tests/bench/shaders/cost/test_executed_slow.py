"""Issue slots as they are executed: how often loops run, and what that makes of a listing."""

import pytest

from normalbench.bench.tables.cost import measure
from normalbench.encodings.catalogue import ENCODINGS


@pytest.mark.usefixtures("gl", "radv")
def test_a_search_over_128_lengths_is_priced_as_one():
    """A static count says 50 slots; it runs its 32 slots of the loop 128 times."""
    encodings = [ENCODINGS["best_fit_searched"], ENCODINGS["octahedral"]]
    found = measure.counted(measure.cases(encodings, (), measure.OPERATIONS), "navi21", "fragment")
    search, plain = found["best_fit_searched", "encode"], found["octahedral", "encode"]
    assert plain["executed_slots"] == plain["issue_slots"] == 14
    per_turn = (search["executed_slots"] - search["issue_slots"]) / 127
    assert search["issue_slots"] < 60 and per_turn == pytest.approx(32, abs=2), search["executed_slots"]
