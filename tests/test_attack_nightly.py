"""A short form of `python -m tests.attack`: every kind that needs no separate process, with the first seeds."""

import pytest
import test_attack_slow
from test_attack_slow import BY_DAY, COSTLY, FEW, of


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind, count", of((k for k in FEW if k.name in COSTLY), 1))
def test_the_slowest_damaged_input_is_measured_or_refused_in_one_line(kind, count, tmp_path, monkeypatch, opened):
    test_attack_slow.test_damaged_input_is_measured_or_refused_in_one_line(kind, count, tmp_path, monkeypatch, opened)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("seed", [seed for seed in range(12) if seed not in BY_DAY])
def test_more_programs_mean_the_same_in_every_language(seed, tmp_path, monkeypatch):
    """Together with the daily tests, three programs are read in each language."""
    test_attack_slow.test_programs_mean_the_same_in_every_language(seed, tmp_path, monkeypatch)
