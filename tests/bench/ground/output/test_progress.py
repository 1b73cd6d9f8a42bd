"""One progress bar for a run, with the number of the table and the steps of all tables."""

import re
import sys
import time

import pytest

from normalbench.bench.ground.output import progress as module
from normalbench.bench.ground.output.progress import PAGE, progress, progress_of_all, spoken


@pytest.fixture
def bars(monkeypatch):
    """The calls of every bar: its total number of steps, then each advance and its description."""
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


def test_bars_of_tables_are_part_of_the_bar_of_the_run(bars):
    """Steps are weighted by duration, and finished steps do not count; work other than tables has a separate bar."""
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


def test_a_single_table_has_its_own_bar(bars):
    with progress(1, "cost") as tick:
        tick("navi21")
    assert bars == [(1, "in all"), (1, "navi21")]


def test_the_remaining_time_combines_expected_and_measured_times(monkeypatch):
    """The first estimate is the expected time; on a machine half as fast, measured times gradually correct it."""
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


def test_a_run_without_a_terminal_prints_its_progress(capsys, monkeypatch):
    monkeypatch.setattr(module, "EVERY", 0.05)
    monkeypatch.delenv(module.OFF)
    # The bar first: it imports what draws it, which may take longer than a line is away.
    with progress_of_all({"quality": (3, 100.0)}), spoken(), progress(3, "quality") as tick:
        tick("octahedral/rg8")
        time.sleep(0.5)
    time.sleep(0.1)
    stderr = capsys.readouterr().err
    assert re.search(
        r"^normalbench: 0.05 s, 33%, about \d:\d\d left, table 1 of 1, quality: octahedral/rg8$", stderr, re.M
    )
    assert len(stderr.splitlines()) >= 3
    time.sleep(0.2)
    assert not capsys.readouterr().err, "it goes on after the run"
    monkeypatch.setenv(module.OFF, "1")
    with spoken(), progress_of_all({"quality": (3, 1.0)}):
        time.sleep(0.2)
    assert not capsys.readouterr().err, "it speaks though it is not to"


def test_a_run_in_a_terminal_shows_only_its_bar(capsys, monkeypatch):
    monkeypatch.setattr(module, "EVERY", 0.05)
    monkeypatch.delenv(module.OFF)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with spoken(), progress_of_all({"quality": (3, 1.0)}):
        time.sleep(0.3)
    assert " left, " not in capsys.readouterr().err
