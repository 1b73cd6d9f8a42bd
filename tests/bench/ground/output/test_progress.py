"""One bar for a run: which table of how many, and the steps of all."""

import re
import sys
import time

import pytest

from normalbench.bench.ground.output import progress as module
from normalbench.bench.ground.output.progress import PAGE, progress, progress_of_all, spoken


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

        def add_task(self, _, total, **__):
            told.append((total, "in all"))
            return 0

        def update(self, _, completed, description, **__):
            told.append((completed, description))

    monkeypatch.setattr("rich.progress.Progress", Recorded)
    return told


def test_the_bars_of_tables_are_part_of_the_one_of_their_run(bars):
    """Steps count by how long they take, those that are there not at all; a bar of something else is its own."""
    with progress_of_all({"quality": (1, 5.0), "render": (9, 0.5), PAGE: (1, 12.0)}):
        with progress(1, "quality") as tick:
            tick("octahedral/rg8")
        with progress(2, "render", there=7) as tick:
            tick("gloss")
            with progress(3) as other:
                other("gate")
            tick("room")
        with progress(1, PAGE):
            pass
    first, second = "table 1 of 2, quality: ", "table 2 of 2, render: "
    assert bars == [
        *((21.5, "in all"), (0, first), (5, f"{first}octahedral/rg8"), (5, second), (5.5, f"{second}gloss")),
        *((3, "in all"), (1, "gate"), (6, f"{second}room"), (6, "writing the page")),
    ]


def test_a_table_alone_has_a_bar_of_its_own(bars):
    with progress(1, "cost") as tick:
        tick("navi21")
    assert bars == [(1, "in all"), (1, "navi21")]


def test_the_time_that_is_left_goes_by_what_was_expected_and_by_what_was_measured(monkeypatch):
    """At first as expected; a machine that takes twice as long is believed as it goes on."""
    now = [0.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    left = []
    with progress_of_all({"quality": (10, 6.0)}), progress(10, "quality") as tick:
        for step in range(10):
            left.append(module._whole[-1].says().split(",")[1])
            now[0] = 12.0 * (step + 1)
            tick("")
        left.append(module._whole[-1].says())
    assert left[0] == " about 1:00 left" and left[1] == " about 1:21 left" and left[9] == " about 0:11 left"
    assert left[10].startswith("100%, about 0:00 left")


def test_a_run_without_a_terminal_says_how_far_it_is(capsys, monkeypatch):
    monkeypatch.setattr(module, "EVERY", 0.05)
    monkeypatch.delenv(module.OFF)
    # The bar first: it imports what draws it, which may take longer than a line is away.
    with progress_of_all({"quality": (3, 100.0)}), spoken(), progress(3, "quality") as tick:
        tick("octahedral/rg8")
        time.sleep(0.5)
    time.sleep(0.1)
    said = capsys.readouterr().err
    assert re.search(
        r"^normalbench: 0.05 s, 33%, about \d:\d\d left, table 1 of 1, quality: octahedral/rg8$", said, re.M
    )
    assert len(said.splitlines()) >= 3
    time.sleep(0.2)
    assert not capsys.readouterr().err, "it goes on after the run"
    monkeypatch.setenv(module.OFF, "1")
    with spoken(), progress_of_all({"quality": (3, 1.0)}):
        time.sleep(0.2)
    assert not capsys.readouterr().err, "it speaks though it is not to"


def test_a_run_with_a_terminal_shows_its_bar_alone(capsys, monkeypatch):
    monkeypatch.setattr(module, "EVERY", 0.05)
    monkeypatch.delenv(module.OFF)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with spoken(), progress_of_all({"quality": (3, 1.0)}):
        time.sleep(0.3)
    assert " left, " not in capsys.readouterr().err
