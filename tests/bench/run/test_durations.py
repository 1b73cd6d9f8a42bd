"""The expected duration of a run."""

from dataclasses import dataclass, field

import pytest

from normalbench.bench.ground.output.progress import PAGE
from normalbench.bench.run import durations
from normalbench.bench.run.measuring import Asked
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Step


@dataclass(frozen=True)
class Options:
    words: tuple[str, ...] = field(default=("a",))


def asked(name: str, steps: int, *words: str) -> Asked:
    return Asked(TABLES[name], Options(words), None, [Step({"word": n}, None, "") for n in range(steps)])


@pytest.mark.usefixtures("own_cache")
def test_a_question_is_expected_to_take_as_long_as_before():
    """A question that was never asked is expected to take the table's default time per step."""
    durations.keep(asked("quality", 10, "a"), 10, 25.0)
    forecast = durations.expected([asked("quality", 4, "a"), asked("render", 2, "a")], ())
    assert forecast == {"quality": (4, 2.5), "render": (2, TABLES["render"].step_s), PAGE: (1, durations.PAGE_S)}
    assert durations.expected([asked("quality", 4, "b")], ())["quality"] == (4, TABLES["quality"].step_s)


@pytest.mark.usefixtures("own_cache")
def test_only_the_excess_time_of_the_second_process_counts():
    durations.keep(asked("render", 10), 10, 30.0)
    durations.keep(asked("cost", 1), 1, 40.0)
    ask, other = asked("render", 10), asked("cost", 1)
    assert durations.expected([ask, other], [other])["cost"] == (1, pytest.approx(10.0))
    durations.keep(asked("cost", 1), 1, 20.0)
    assert durations.expected([ask, other], [other])["cost"] == (1, 0.0)
