"""The `compare` command."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..ground.machine.settings import ROWS_BY
from ..ground.output.errors import tell
from ..ground.output.writing import without
from .change_lines import in_short, total, what_matters
from .comparison import GONE, compared, measured_otherwise
from .row_files import write
from .runs import read_to_show

# What begins the names of such facts: see `machine.settings`.
SETTING = "setting "
# How many conditions a line names that rows were measured under otherwise.
MOST_NAMED = 3
FOR_PROGRAMS = ("severity", "keys", "unit")
# What makes `--fail-on` fail.
FAILS = {"never": (), "worse": ("worse", GONE), "change": ("worse", "better", GONE, "")}


def compare_command(before: Path, after: Path, fail_on: str, format: str, output: Path | None) -> int:
    """Write the changes from one results folder to another; if nothing changed, report that on standard error.

    Returns:
        the exit status: 1 if something changed that `fail_on` names.
    """
    ours, theirs = (read_to_show(folder, needs_rows=True) for folder in (before, after))
    changes = compared(ours, theirs)
    if ours.facts.get("machine") != theirs.facts.get("machine"):
        tell("the machines differ, so timings are not compared")
    if apart := _settings_apart(ours.facts.get("machine") or {}, theirs.facts.get("machine") or {}):
        tell(f"figures may differ because settings changed: {'; '.join(apart)}")
    if otherwise := measured_otherwise(ours, theirs):
        more = f"; and {len(otherwise) - MOST_NAMED} other conditions" if len(otherwise) > MOST_NAMED else ""
        tell(f"figures may differ because conditions changed: {'; '.join(otherwise[:MOST_NAMED])}{more}")
    if not changes:
        tell(f"no change in {len(ours.steps)} steps")
    if format in ("table", "markdown"):
        lines = in_short(changes)
        is_each_of_one = all(line["rows"] == 1 for line in lines)
        shown = without(lines, ("rows",) if is_each_of_one else ())
        lead = "\n".join(what_matters(ours, theirs, changes))
        write(shown, format, output, lead=lead, total=total(changes))
    else:
        write(without(changes, FOR_PROGRAMS), format, output)
    failing = [change for change in changes if change["verdict"] in FAILS[fail_on]]
    return int(bool(failing))


def _settings_apart(earlier: Mapping[str, Any], other: Mapping[str, Any]) -> list[str]:
    """Return a text for each external setting that differs between two runs: "NAME was VALUE and is VALUE"."""
    names = sorted(name for name in {*earlier, *other} if name.startswith(SETTING) or name == ROWS_BY)
    values = ((name.removeprefix(SETTING), earlier.get(name, "not set"), other.get(name, "not set")) for name in names)
    return [f"{name} was {before} and is now {after}" for name, before, after in values if before != after]
