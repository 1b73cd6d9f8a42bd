"""`normalbench pick`: its answer follows from its rows, whatever is asked, and what it says is what the rows say."""

import pytest
import test_pick_slow
from test_pick_slow import EXPECTED, SOME


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("words", [words for words in EXPECTED if words not in SOME])
def test_the_answer_is_what_an_expert_expects_of_any_question(run, words):
    test_pick_slow.test_the_answer_is_what_an_expert_expects(run, words)
