"""Results folders: rows are stored as they are measured, so that a stopped run can continue and a finished run can be
read.

A folder contains `run.json` with the request and the machine, and `rows.jsonl` with a line for each finished step:
the table, the key (everything that determines the rows) and the rows. Tables in other formats are written from these
rows.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from threading import Lock

from ...encodings.codecs.files import file_json
from ..ground.output.errors import UsageError, tell
from ..ground.output.sources import sources
from ..ground.output.writing import check_folder, whole_file
from ..tables.registry import TABLES
from ..tables.table import PART, Role, Row, Step
from .journal import Journal, data_of, journal, read_lines
from .plain import key_text, plain

RUN, ROWS = "run.json", "rows.jsonl"
# How many facts that differ a message names, and how many letters of each value it shows.
MOST_FACTS, SHORT = 3, 40


def _identified(step: Row) -> list[tuple[str, Row]]:
    """Return the rows of a step, each with text that identifies its subject and its conditions."""
    table = TABLES[step["table"]]
    names = [c.name for c in table.of_role(Role.KEY, Role.HOW)]
    rows = map(table.as_now, step["rows"])
    return [(json.dumps([row.get(name) for name in names], sort_keys=True), row) for row in rows]


@dataclass(frozen=True)
class Done:
    """The content of a results folder.

    Attributes:
        facts: the content of run.json.
        steps: the finished steps in order, each with `table`, `key` and `rows`.
        damage: a message if rows of a finished run were changed or may be missing; otherwise empty.
        parts: the finished parts of unfinished steps, in the same form.
        whole: the finished rows by table, for the tables that `finished_rows` was called for.
        identified: a function that returns a step's rows, each with text that identifies its subject and its
            conditions.
    """

    facts: Row
    steps: list[Row]
    damage: str = ""
    parts: Sequence[Row] = ()
    whole: dict[str, list[Row]] = field(default_factory=dict)
    identified: Callable[[Row], list[tuple[str, Row]]] = _identified

    @cached_property
    def tables(self) -> dict[str, list[Row]]:
        """The rows of each table that this version has, as they were measured, by table. A row that was measured
        again replaces the older row."""
        by_table: dict[str, list[Row]] = {}
        last: dict[tuple[str, str], int] = {}
        numbered_rows: list[tuple[int, str, str, Row]] = []
        for index, step in enumerate(self.steps):
            if (name := step["table"]) not in TABLES:
                continue
            by_table.setdefault(name, [])
            for identity, row in self.identified(step):
                last[name, identity] = index
                numbered_rows.append((index, name, identity, row))
        for index, name, identity, row in numbered_rows:
            if last[name, identity] == index:
                by_table[name].append(row)
        return by_table

    def finished_rows(self, name: str) -> list[Row]:
        """Return the finished rows of a table. Rows are finished only here, on demand, and once per table.

        Raises:
            one of UNEXPECTED: the rows are not what this version writes.
        """
        if name not in self.whole:
            rows = self.tables.get(name)
            self.whole[name] = TABLES[name].work.finish(rows) if rows else []
        return self.whole[name]

    @staticmethod
    def remedy(name: str) -> str:
        """Return the advice for rows of a table that are not what this version writes."""
        return f"measure them again: normalbench run --tables {name}"

    @property
    def left_out(self) -> str:
        """A sentence, without its full stop, about the rows that `tables` leaves out; empty if it has all rows."""
        names = dict.fromkeys(step["table"] for step in self.steps if step["table"] not in TABLES)
        return f"Rows of {', '.join(names)} are left out, because this version has no such table" if names else ""

    @property
    def finished(self) -> bool:
        """Whether every step has its rows, for all requests that were made for the folder."""
        before = self.facts.get("before")
        requests = [facts for facts in before if isinstance(facts, dict)] if isinstance(before, list) else []
        # The same request may have been made again since.
        last = {json.dumps(facts.get("request"), sort_keys=True): facts for facts in [*requests, self.facts]}
        return all(facts.get("finished") for facts in last.values())


def facts_of(command: Sequence[str]) -> Row:
    """Return the facts that a run records before anything is measured: the command, the sources and the machine."""
    from .machine import machine

    return {"command": list(command), "sources": sources(), "machine": machine()}


class Shared:
    """Data that several runs share, so that a line in many of them is parsed, checked and identified only once."""

    def __init__(self):
        self.lines: dict[bytes, Row] = {}
        self.checked: set[int] = set()
        self._identified: dict[int, list[tuple[str, Row]]] = {}

    def identified(self, step: Row) -> list[tuple[str, Row]]:
        """Return what `Done.identified` returns for a step in `lines`, as the same objects on every call."""
        if id(step) not in self._identified:
            self._identified[id(step)] = _identified(step)
        return self._identified[id(step)]


def read_run(folder: Path, shared: Shared | None = None) -> Done:
    """Return the content of a results folder, without writing to it.

    Args:
        shared: the data that runs share, if several are read.

    Raises:
        UsageError: the folder is not a results folder, or cannot be read.
    """
    facts, lines = _facts(folder), read_lines(folder / ROWS, shared and shared.lines)
    _check_steps(folder, lines, shared.checked if shared else set())
    whole = [line for line in lines if PART not in line["key"]]
    parts = [line for line in lines if PART in line["key"]]
    identified = shared.identified if shared else _identified
    return Done(facts, whole, _damage_text(folder, facts), parts, identified=identified)


def read_to_show(folder: Path, shared: Shared | None = None, needs_rows: bool = False) -> Done:
    """Return the content of a results folder to show to people, and report problems with its rows on standard error.

    Raises:
        UsageError: as for `read_run`; or the folder has no rows although `needs_rows` is true.
    """
    done = read_run(folder, shared)
    if needs_rows and not done.steps:
        why = done.damage or f"{folder} has no rows: none of its steps was finished"
        raise UsageError(f"{why}; measure it again, or name another run")
    for line in filter(None, (done.damage, done.left_out and f"{folder}: {done.left_out}")):
        tell(line)
    return done


def _check_steps(folder: Path, lines: Sequence[Row], checked: set[int]) -> None:
    """Raise UsageError if a line is invalid. Lines whose ids are in `checked` are skipped; the other ids are added."""
    from .schema import Keys, check_step

    keys: Keys = {}
    for number, line in enumerate(lines, 1):
        if id(line) in checked:
            continue
        checked.add(id(line))
        try:
            check_step(line, f"{folder / ROWS}, line {number}", keys)
        except UsageError as error:
            raise UsageError(f"{error}; correct the line, or delete it to measure it again") from None


def _seal_columns(data: bytes) -> Row:
    """Return the number of lines and the SHA-256 digest of rows, which reveal changes to a finished run."""
    return {"lines": data.count(b"\n"), "digest": hashlib.sha256(data).hexdigest()}


def _damage_text(folder: Path, facts: Row) -> str:
    if not facts.get("finished"):
        return ""
    if not {"lines", "digest"} <= facts.keys():
        return f"{folder / RUN} does not say how many rows the run had when it finished: some may be missing"
    now = _seal_columns((folder / ROWS).read_bytes())
    if now["digest"] in (facts["digest"], facts.get("next", {}).get("digest")):
        return ""
    if now["lines"] != facts["lines"]:
        return f"{folder / ROWS} has {now['lines']} of the {facts['lines']} lines that it had when the run finished"
    return f"{folder / ROWS} was changed after the run finished"


def _facts(folder: Path) -> Row:
    from .schema import check_facts

    try:
        facts = file_json(folder / RUN)
    except (OSError, ValueError) as error:
        raise UsageError(f"{folder} is not a results folder: {RUN} cannot be read ({error})") from error
    check_facts(facts, str(folder / RUN))
    return facts


class Run:
    """A results folder that is being written; created by `opened`."""

    def __init__(self, folder: Path, facts: Row, kept: Journal):
        self.folder, self.facts, self._journal, self._lock = folder, facts, kept, Lock()
        _check_steps(folder, kept.lines, set())
        self._kept = {key_text(step["table"], step["key"]): step["rows"] for step in kept.lines}

    @property
    def kept(self) -> int:
        """The number of lines of rows, counted in the file because a signal may arrive just after a write."""
        return len(read_lines(self.folder / ROWS))

    def find(self, table: str, step: Step) -> list[Row] | None:
        """Return the stored rows of a step; None if it has not been stored."""
        return self._kept.get(key_text(table, step.key))

    def keep(self, table: str, step: Step, rows: Sequence[Row]) -> list[Row]:
        """Store the rows of a step, and return them as they are read back from JSON.

        Raises:
            UsageError: the rows cannot be written; rows that were stored before are kept.
        """
        text, kept = key_text(table, step.key), plain(rows)
        # Those of the second process come in a thread of their own.
        with self._lock:
            self._journal.add({"table": table, "key": plain([step.key])[0], "rows": kept})
            self._kept[text] = kept
        return kept

    def arrange(self, steps: Iterable[tuple[str, Step]]) -> None:
        """Sort the rows by a request's steps, given as pairs of table and step: workers return them in any order.
        Rows of earlier requests stay in front; rows of parts are removed if their step is complete. Raises
        UsageError."""
        place = {key_text(table, step.key): index for index, (table, step) in enumerate(steps)}
        # As they lie in the file, with those that were kept since it was opened.
        before = read_lines(self.folder / ROWS)
        whole = {key_text(line["table"], line["key"]) for line in before}
        kept = (line for line in before if PART not in line["key"] or _step_of(line) not in whole)
        lines = sorted(kept, key=lambda line: place.get(key_text(line["table"], line["key"]), -1))
        if lines != before:
            self._journal.replace(lines)

    def finish(self) -> None:
        """Record that every step has its rows, together with the number of lines and the digest of the rows."""
        self.facts |= {"finished": True, **_seal_columns((self.folder / ROWS).read_bytes())}
        _write_facts(self.folder, self.facts)


def _step_of(part: Row) -> str:
    """Return text that identifies the step to which a part's line belongs, as `key_text` does."""
    return key_text(part["table"], {name: value for name, value in part["key"].items() if name != PART})


def _write_facts(folder: Path, facts: Row) -> None:
    from .schema import SCHEMA

    with whole_file(folder / RUN) as partial:
        partial.write_text(json.dumps({"schema": SCHEMA, **facts}, indent=1) + "\n", encoding="utf-8", newline="\n")


class Amended:
    """A run whose rows may be replaced; created by `amended`.

    Attributes:
        lines: the finished steps, each with `table`, `key` and `rows`.
        sources: the fingerprint of the sources that computed the rows; empty if unknown.
    """

    def __init__(self, folder: Path, facts: Row, kept: Journal):
        self._folder, self._facts, self._journal = folder, facts, kept
        self.sources = str(facts.get("sources") or "")
        _check_steps(folder, kept.lines, set())
        self.lines: Sequence[Row] = kept.lines

    def replace(self, lines: Sequence[Row]) -> None:
        """Replace all steps with the given steps, or none if writing fails. Raises UsageError."""
        seal = _seal_columns(data_of(lines)) if self._facts.get("finished") else {}
        # Whoever is killed between two of these leaves a run that is whole: its rows are the old or the next ones.
        if seal:
            _write_facts(self._folder, self._facts | {"next": seal})
        self._journal.replace(lines)
        self.lines = lines
        if seal:
            self._facts |= seal
            _write_facts(self._folder, self._facts)


@contextmanager
def amended(folder: Path) -> Iterator[Amended]:
    """Yield an existing run whose rows may be replaced, whatever its sources and its machine.

    Raises:
        UsageError: the run is missing, another process is writing it, or its rows were changed after it finished.
    """
    # First, because a journal is made where there is none.
    _facts(folder)
    check_folder(folder)
    with journal(folder / ROWS) as kept:
        facts = _facts(folder)
        if damage := _damage_text(folder, facts):
            raise UsageError(f"{damage}; nothing was added to the run")
        yield Amended(folder, _settled(folder, facts), kept)


def _settled(folder: Path, facts: Row) -> Row:
    """Return the facts that belong to the rows in the folder. If a process was killed while it replaced the rows,
    the facts are updated and written."""
    if "next" in facts:
        facts = {name: value for name, value in facts.items() if name != "next"} | _seal_columns(
            (folder / ROWS).read_bytes()
        )
        _write_facts(folder, facts)
    return facts


def same_work(facts: Row, others: Row) -> bool:
    """Whether two runs have the same request, sources and machine."""
    return all(facts.get(name) == others.get(name) for name in ("request", "sources", "machine"))


def _other_place(facts: Row, others: Row) -> str:
    """Return a text about how a run differs from the run that is to be added to it: in its sources, or in facts about
    the machine, with the values of both; empty if neither differs."""
    reasons = (
        [f"from other sources ({_there_and_here(facts, others, 'sources')})"]
        if _is_different(facts, others, "sources")
        else []
    )
    there, here = (run_facts.get("machine") or {} for run_facts in (facts, others))
    names = [name for name in {**there, **here} if _is_different(there, here, name)]
    fact_texts = [f"{name} ({_there_and_here(there, here, name)})" for name in names[:MOST_FACTS]]
    more = [f"{len(names) - MOST_FACTS} more"] if len(names) > MOST_FACTS else []
    reasons += [f"from another machine: {', '.join([*fact_texts, *more])}"] if names else []
    return " and ".join(reasons)


def _is_different(facts: Row, others: Row, name: str) -> bool:
    return facts.get(name) != others.get(name)


def _there_and_here(facts: Row, others: Row, name: str) -> str:
    there, here = (str(run_facts.get(name, "not recorded")) for run_facts in (facts, others))
    return f"{_short_text(there, here)} there, {_short_text(here, there)} here"


def _short_text(text: str, other: str) -> str:
    """Return a text unchanged if it is short, else SHORT characters of it around the first difference from the
    other text, with "..." where it is cut."""
    differing = (i for i, (letter, another) in enumerate(zip(text, other, strict=False)) if letter != another)
    apart = next(differing, min(len(text), len(other)))
    start = max(0, min(apart - SHORT // 4, len(text) - SHORT))
    end = start + SHORT
    return f"{'...' * (start > 0)}{text[start:end]}{'...' * (end < len(text))}"


def unfinished(parent: Path, facts: Row) -> Path | None:
    """Return the newest folder in `parent` that contains an unfinished run of the same work, or None."""
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
    """Whether a folder holds files but no run, not even an interrupted run without facts; True if it cannot be
    read."""
    try:
        names = {path.name for path in folder.iterdir()} if folder.exists() else set()
    except OSError:
        return True
    return RUN not in names and any(name != ROWS and not name.startswith(f".{RUN}.") for name in names)


@contextmanager
def opened(folder: Path, facts: Row) -> Iterator[Run]:
    """Yield the run in a results folder, which continues, or a new run if the folder has none.

    Args:
        facts: `sources` and `machine` decide whether a run may continue; a different `request` is added to it.

    Raises:
        UsageError: the folder contains something else, its run has different sources or is from a different machine,
            another process is writing it, or nothing can be written.
    """
    if _holds_something_else(folder):
        raise UsageError(f"{folder} already exists and contains no run; name a new folder")
    check_folder(folder)
    with journal(folder / ROWS) as kept:
        yield Run(folder, _begun_facts(folder, facts), kept)


def _begun_facts(folder: Path, facts: Row) -> Row:
    """Return the facts of a folder; write them if the folder is new or the request is different. Raises UsageError if
    the folder's run has different sources or is from a different machine, or its rows were changed."""
    if not (folder / RUN).exists():
        _write_facts(folder, facts)
        return dict(facts)
    kept = _facts(folder)
    if apart := _other_place(kept, facts):
        raise UsageError(f"{folder} holds a run {apart}; name another folder")
    if damage := _damage_text(folder, kept):
        raise UsageError(f"{damage}; name another folder")
    # Rows that are there are those of the files as they are now, whatever commit they were measured at.
    commit = {name: facts[name] for name in ("commit",) if name in facts}
    return kept | commit if same_work(kept, facts) else _extended_facts(folder, kept, facts)


def _extended_facts(folder: Path, kept: Row, facts: Row) -> Row:
    """Write and return the facts of a run that continues with a different request; earlier requests are kept."""
    before = [*kept.get("before", ()), {name: kept.get(name) for name in ("request", "command", "time", "finished")}]
    new_facts = facts | {"before": before, "finished": False}
    _write_facts(folder, new_facts)
    return new_facts
