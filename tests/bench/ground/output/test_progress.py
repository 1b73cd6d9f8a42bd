"""One bar for a run: which table of how many, and the steps of all."""

import sys
import time

import pytest

from normalbench.bench.ground.output import progress as module
from normalbench.bench.ground.output.progress import progress, progress_of_all, spoken


@pytest.fixture
def bars(monkeypatch):
    """What every bar is told: its steps in all, then each advance and what is under way."""
    told: list[tuple[int, str]] = []

    class Recorded:
        def __init__(self, *_, **__):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *_):
            pass

        def add_task(self, _, total):
            told.append((total, "in all"))
            return 0

        def update(self, _, advance, description):
            told.append((advance, description))

    monkeypatch.setattr("rich.progress.Progress", Recorded)
    return told


def test_the_bars_of_tables_are_part_of_the_one_of_their_run(bars):
    """Steps that are there count at once; a bar of something else is its own."""
    with progress_of_all(10, 2):
        with progress(1, "quality") as tick:
            tick("octahedral/rg8")
        with progress(2, "render", there=7) as tick:
            tick("gloss")
            with progress(3) as other:
                other("gate")
            tick("room")
    first, second = "table 1 of 2, quality: ", "table 2 of 2, render: "
    assert bars == [
        *((10, "in all"), (0, first), (1, f"{first}octahedral/rg8"), (7, second), (1, f"{second}gloss")),
        *((3, "in all"), (1, "gate"), (1, f"{second}room")),
    ]


def test_a_table_alone_has_a_bar_of_its_own(bars):
    with progress(1, "cost") as tick:
        tick("navi21")
    assert bars == [(1, "in all"), (1, "navi21")]


def test_a_run_without_a_terminal_says_how_far_it_is(capsys, monkeypatch):
    monkeypatch.setattr(module, "EVERY", 0.05)
    monkeypatch.delenv(module.OFF)
    # The bar first: it imports what draws it, which may take longer than a line is away.
    with progress_of_all(3, 1), spoken(), progress(3, "quality") as tick:
        tick("octahedral/rg8")
        time.sleep(0.5)
    time.sleep(0.1)
    said = capsys.readouterr().err
    assert "normalbench: 0.05 s, 1 of 3 steps, table 1 of 1, quality: octahedral/rg8\n" in said
    assert len(said.splitlines()) >= 3
    time.sleep(0.2)
    assert not capsys.readouterr().err, "it goes on after the run"
    monkeypatch.setenv(module.OFF, "1")
    with spoken(), progress_of_all(3, 1):
        time.sleep(0.2)
    assert not capsys.readouterr().err, "it speaks though it is not to"


def test_a_run_with_a_terminal_shows_its_bar_alone(capsys, monkeypatch):
    monkeypatch.setattr(module, "EVERY", 0.05)
    monkeypatch.delenv(module.OFF)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with spoken(), progress_of_all(3, 1):
        time.sleep(0.3)
    assert " steps, " not in capsys.readouterr().err
