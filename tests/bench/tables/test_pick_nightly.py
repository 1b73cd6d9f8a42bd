"""`normalbench pick`: the answer to any question follows from the rows, and the sentences agree with the rows."""

import random

import pytest
import test_pick
import test_pick_slow
from test_pick_slow import EXPECTED, SOME, check_a_question

rows = test_pick.rows


def test_answers_to_100_random_questions_match_brute_force(rows):
    chance = random.Random(0)
    for _ in range(100):
        check_a_question(rows, chance)


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("words", [words for words in EXPECTED if words not in SOME])
def test_the_answer_to_any_question_is_what_an_expert_expects(run, words):
    test_pick_slow.test_the_answer_is_what_an_expert_expects(run, words)
