"""`normalbench pick`: its answer follows from its rows, whatever is asked, and what it says is what the rows say."""

import json
import random

import pytest
import test_pick_slow
from test_pick_slow import CODES, EXPECTED, SOME

SMALL = ("pick", "--encoding", CODES, "--count", "4096", "--aim", "image")


@pytest.fixture(scope="module")
def rows(gl, radv, tmp_path_factory):  # noqa: ARG001 # they skip where this machine lacks them
    """What the command measures of a dozen codes: with --aim image all that qualify have an image."""
    from normalbench.bench.door.cli import app

    output = tmp_path_factory.mktemp("pick") / "rows.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["normalbench", *SMALL, "--format", "json", "-o", str(output)])
        assert app.main() == 0
    return json.loads(output.read_text())


def test_the_answer_to_100_random_questions_of_measured_rows_is_that_of_brute_force(rows):
    chance = random.Random(0)
    for _ in range(100):
        test_pick_slow.check_a_question(rows, chance)


@pytest.mark.usefixtures("gl", "radv")
@pytest.mark.parametrize("words", [words for words in EXPECTED if words not in SOME])
def test_the_answer_is_what_an_expert_expects_of_any_question(run, words):
    test_pick_slow.test_the_answer_is_what_an_expert_expects(run, words)
