"""Runs in the order of their commits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path

from ..ground.output.errors import UsageError, leave_out
from ..tables.table import Row
from .commit import short_name
from .runs import RUN, Done, Shared, read_to_show

# The year 3000, in seconds.
LATEST = 32503680000


@dataclass(frozen=True)
class Past:
    """A run in the history.

    Attributes:
        name: the name of its commit; without a commit, the name of its folder.
        commit: the recorded facts about its commit; empty if none were recorded.
        seconds: when the commit was made; without a commit, when the run was made.
        ran: when the run was made.
        done: the content of its folder.
    """

    name: str
    commit: Row
    seconds: float
    ran: float
    done: Done

    @property
    def day(self) -> str:
        """The day (UTC) of the run's commit or, without a commit, of the run, as YYYY-MM-DD."""
        return datetime.fromtimestamp(self.seconds, UTC).strftime("%Y-%m-%d")

    @property
    def full_name(self) -> str:
        """The commit's name for programs, with the full hash; without a commit, the name of the run's folder."""
        return str(self.commit.get("name", self.name))

    @property
    def subject(self) -> str:
        """The first line of the commit's message; empty without a commit."""
        return str(self.commit.get("subject", ""))

    @property
    def order(self) -> tuple[float, int, float]:
        """The key that sorts runs: the time of the commit, its rank, and the time of the run."""
        return self.seconds, int(_number(self.commit.get("rank"), 0)), self.ran


def past_runs(folders: Sequence[Path]) -> list[Past]:
    """Return the runs in some folders, ordered by commit and, for the same commit, by date. Runs without rows are
    left out, unless no run has rows.

    Raises:
        UsageError: a folder has no run, or a run cannot be read.
    """
    shared = Shared()
    run_folders = dict.fromkeys(run for folder in folders for run in _run_folders(folder))
    runs = sorted((_past(run, read_to_show(run, shared)) for run in run_folders), key=lambda past: past.order)
    for past in runs:
        if not past.done.steps:
            leave_out(f"{past.name}: it has no rows")
    return [past for past in runs if past.done.steps] or runs


def _run_folders(folder: Path) -> list[Path]:
    """Return the folder itself if it holds a run, else the folders of the runs up to two levels below it. Raises
    UsageError if no run is found."""
    if (folder / RUN).exists():
        return [folder]
    runs = sorted(path.parent for pattern in ("*", "*/*") for path in folder.glob(f"{pattern}/{RUN}"))
    if not runs:
        raise UsageError(f"{folder} contains no run: no {RUN} in it or in its subfolders")
    return runs


def _past(folder: Path, done: Done) -> Past:
    commit: Row = done.facts.get("commit") or {}
    ran = _seconds(str(done.facts.get("time", "")))
    name = short_name(commit) if commit.get("name") else folder.name
    return Past(name, commit, _number(commit.get("time"), ran), ran, done)


def _number(value: object, usual: float) -> float:
    """Return a value as a float if it is a number of seconds before the year 3000, else `usual`: people may have
    edited the file."""
    return float(value) if isinstance(value, int | float) and 0 <= value < LATEST else usual


def _seconds(text: str) -> float:
    """Return the time of a date in the format of `run`, in seconds since 1970; 0 if the text is not such a date."""
    try:
        return max(0.0, datetime.strptime(text, "%Y-%m-%dT%H:%M:%S%z").timestamp())
    except ValueError:
        return 0.0


def named_apart(runs: Sequence[Past]) -> Iterator[str]:
    """Yield for each run a text that names what differs from the previous run, besides the commit: facts about the
    machine, and normalbench itself. The text is empty for the first run, and if nothing differs."""
    yield ""
    for previous, other in pairwise(runs):
        there, here = (past.done.facts.get("machine") or {} for past in (previous, other))
        names = [name for name in dict.fromkeys([*there, *here]) if there.get(name) != here.get(name)]
        is_another = previous.done.facts.get("sources") != other.done.facts.get("sources")
        yield ", ".join([*["normalbench"] * is_another, *(name for name in names if name != "normalbench")])
