"""Results folders: rows kept for good as they finish, so that a stopped run goes on and one that ended is read.

A folder holds `run.json`, what was asked for and where it is measured, and `rows.jsonl`, a line for each finished step:
the table, the key of everything that determines the rows, and the rows. Tables for others are written from those.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..output.errors import UsageError
from ..output.journal import Journal, journal, read_lines
from ..output.writing import check_folder, whole_file

Row = dict[str, Any]
RUN, ROWS = "run.json", "rows.jsonl"
ROOMS = ("encodings", "gbuffer", "bench", "reports")


@dataclass(frozen=True)
class Step:
    """What is measured at once.

    Attributes:
        table: which its rows belong to.
        key: everything that determines them, beside the machine and the sources; plain values.
        measure: gives the rows.
    """

    table: str
    key: Row
    measure: Callable[[], list[Row]]

    @property
    def name(self) -> str:
        return " ".join([self.table, *(str(value) for value in self.key.values() if isinstance(value, str))])


@dataclass(frozen=True)
class Done:
    """A folder's content: what run.json says, and the finished steps in their order, each `table`, `key` and `rows`."""

    facts: Row
    steps: list[Row]

    @property
    def tables(self) -> dict[str, list[Row]]:
        """The rows of each table."""
        found: dict[str, list[Row]] = {}
        for step in self.steps:
            found.setdefault(step["table"], []).extend(step["rows"])
        return found

    @property
    def finished(self) -> bool:
        """Whether every step has its rows."""
        return bool(self.facts.get("finished"))


def sources() -> str:
    """A fingerprint of everything that computes: each source file of the package."""
    root, digest = Path(__file__).parents[2], hashlib.sha256()
    for room in ROOMS:
        for path in sorted((root / room).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def read_run(folder: Path) -> Done:
    """A results folder; nothing is written.

    Raises:
        UsageError: it is none, or cannot be read.
    """
    lines = read_lines(folder / ROWS)
    odd = next((at for at, line in enumerate(lines, 1) if not _is_step(line)), None)
    if odd:
        raise UsageError(f"{folder / ROWS}: line {odd} is no step of a run; take the line out, or run again")
    return Done(_facts(folder), lines)


def _facts(folder: Path) -> Row:
    try:
        facts = json.loads((folder / RUN).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise UsageError(f"{folder} is no results folder: {RUN} cannot be read ({error})") from error
    if not isinstance(facts, dict):
        raise UsageError(f"{folder} is no results folder: {RUN} holds no facts")
    return facts


def _steps(lines: list[Row]) -> list[Row]:
    return [line for line in lines if _is_step(line)]


def _is_step(line: Row) -> bool:
    kinds = {"table": str, "key": dict, "rows": list}
    is_one = all(isinstance(line.get(name), kind) for name, kind in kinds.items())
    return is_one and all(isinstance(row, dict) for row in line["rows"])


class Run:
    """A results folder being written; make it with `opened`."""

    def __init__(self, folder: Path, facts: Row, kept: Journal):
        self.folder, self.facts, self._journal = folder, facts, kept
        self._kept = {_text(step["table"], step["key"]): step["rows"] for step in _steps(kept.lines)}

    @property
    def kept(self) -> int:
        """How many steps have their rows in the file, which a signal may stop a moment after it was written."""
        return len(_steps(read_lines(self.folder / ROWS)))

    def rows(self, step: Step) -> list[Row]:
        """A step's rows: those that are kept, or measured now and kept for good.

        Raises:
            UsageError: they cannot be written; what was kept before stays.
        """
        text = _text(step.table, step.key)
        if text not in self._kept:
            rows = _plain(step.measure())
            self._journal.add({"table": step.table, "key": step.key, "rows": rows})
            self._kept[text] = rows
        return self._kept[text]

    def finish(self) -> None:
        """Every step has its rows."""
        self.facts["finished"] = True
        _write_facts(self.folder, self.facts)


def _plain(rows: Sequence[Row]) -> list[Row]:
    """Rows as JSON gives them back."""
    return json.loads(json.dumps(rows, default=lambda number: number.item()))


def _text(table: str, key: Row) -> str:
    return json.dumps([table, key], sort_keys=True)


def _write_facts(folder: Path, facts: Row) -> None:
    with whole_file(folder / RUN) as partial:
        partial.write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")


def same_work(facts: Row, others: Row) -> bool:
    """Whether two runs ask for the same of the same sources on the same machine."""
    return all(facts.get(name) == others.get(name) for name in ("request", "sources", "machine"))


def unfinished(parent: Path, facts: Row) -> Path | None:
    """The newest folder in `parent` with a run of the same work that was stopped."""
    candidates = sorted((path.parent for path in parent.glob(f"*/{RUN}")), reverse=True)
    for folder in candidates:
        try:
            kept = _facts(folder)
        except UsageError:
            continue
        if not kept.get("finished") and same_work(kept, facts):
            return folder
    return None


def _holds_something_else(folder: Path) -> bool:
    """Whether there is anything but a run, which may have been stopped before it said what it is."""
    try:
        names = {path.name for path in folder.iterdir()} if folder.exists() else set()
    except OSError:
        return True
    return RUN not in names and any(name != ROWS and not name.startswith(f".{RUN}.") for name in names)


@contextmanager
def opened(folder: Path, facts: Row) -> Iterator[Run]:
    """A results folder to write: a new one, or one with the same work that was stopped.

    Args:
        facts: `request`, `sources` and `machine` decide whether it is the same work.

    Raises:
        UsageError: there is something else, the run in it is finished or another process writes it, or nothing can be
            written.
    """
    if _holds_something_else(folder):
        raise UsageError(f"{folder} exists already and holds no run; name a folder that does not")
    check_folder(folder)
    with journal(folder / ROWS) as kept:
        yield Run(folder, _begun(folder, facts), kept)


def _begun(folder: Path, facts: Row) -> Row:
    """The facts of a folder, written if it is new. Raises UsageError where it holds other work."""
    if not (folder / RUN).exists():
        _write_facts(folder, facts)
        return dict(facts)
    kept = _facts(folder)
    if kept.get("finished"):
        raise UsageError(f"{folder} exists already, with a finished run; name a folder that does not")
    if not same_work(kept, facts):
        raise UsageError(f"{folder} holds a run of other options, sources or machine; name another folder")
    return kept
