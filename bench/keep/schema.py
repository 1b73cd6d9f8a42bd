"""Schemas for the files of runs and baselines. People edit these files, so an error names the place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, NotRequired

from pydantic import AfterValidator, ConfigDict, JsonValue, TypeAdapter, ValidationError, with_config
from typing_extensions import TypedDict

from ..ground.output.errors import UsageError
from ..tables.registry import TABLES
from ..tables.table import Role, Row

# A float holds whole numbers below this: storages of 64 bits have more codes than fit a whole number of NumPy's.
LARGEST = 2**1000
# Raised where rows or their keys mean something else than before; runs of another are refused.
SCHEMA = 3


def _checked_scalar(value: Any) -> Any:
    if isinstance(value, list | dict):
        raise ValueError("is neither text nor a number")
    if isinstance(value, int) and not -LARGEST <= value < LARGEST:
        raise ValueError("is too large")
    return value


def _checked_number(value: Any) -> Any:
    if isinstance(value, str):
        raise ValueError("is not a number")
    return _checked_scalar(value)


Scalar = Annotated[Any, AfterValidator(_checked_scalar)]
Number = Annotated[Any, AfterValidator(_checked_number)]
STRICT = ConfigDict(strict=True)


@with_config(STRICT)
class StepLine(TypedDict):
    """A line of `rows.jsonl`."""

    table: str
    key: dict[str, JsonValue]
    rows: list[dict[str, JsonValue]]


@with_config(STRICT)
class RunFacts(TypedDict, total=False):
    """The contents of `run.json` that are read."""

    schema: int
    request: dict[str, JsonValue]
    command: list[str]
    sources: str
    machine: dict[str, Scalar]
    time: str
    finished: bool
    lines: int
    digest: str
    next: dict[str, Scalar]
    before: list[dict[str, JsonValue]]
    commit: dict[str, Scalar]


@with_config(STRICT)
class BaselineEntry(TypedDict):
    """A row of a baseline."""

    table: str
    key: dict[str, JsonValue]
    row: dict[str, JsonValue]
    listing: NotRequired[list[str]]


@with_config(STRICT)
class KeptLine(TypedDict):
    """A line of the rows that are kept next to an output file until the file is written."""

    step: str
    rows: list[dict[str, JsonValue]]


STEP, FACTS, ENTRY = TypeAdapter(StepLine), TypeAdapter(RunFacts), TypeAdapter(BaselineEntry)
KEPT = TypeAdapter(KeptLine)
NUMBERS, SCALARS = TypeAdapter(dict[str, Number]), TypeAdapter(dict[str, Scalar])
# By pydantic's names of what is wrong.
WRONG = {
    "string_type": "is not text",
    "list_type": "is not a list",
    "dict_type": "is not an object",
    "bool_type": "is neither true nor false",
    "int_type": "is not a whole number",
}


def check_facts(facts: Any, place: str) -> None:
    """Raise UsageError if `facts`, the parsed `run.json`, is malformed or has a different schema version."""
    _check(FACTS, facts, [place])
    if facts.get("schema") != SCHEMA:
        raise UsageError(f"{place}: another version of normalbench measured this run; measure it again")


# By table and column, whether a key is text, and a place that says so.
Keys = dict[tuple[str, str], tuple[bool, str]]


def check_step(line: Any, place: str, keys: Keys) -> None:
    """Raise UsageError if a parsed line of `rows.jsonl` is not a step, a figure or a time is not a number, or a key
    is text in one row and a number in another.

    Args:
        place: the place that messages begin with.
        keys: the keys of earlier lines; the keys of this line are added.
    """
    _check(STEP, line, [place])
    for number, row in enumerate(line["rows"], 1):
        _check_row(line["table"], row, [place, f"row {number}"])
        _check_keys(line["table"], row, f"{place}, row {number}", keys)


def _check_keys(name: str, row: Row, place: str, keys: Keys) -> None:
    table = TABLES.get(name)
    for column in table.of_role(Role.KEY) if table else ():
        value = row.get(column.name)
        is_text, where = keys.setdefault((name, column.name), (isinstance(value, str), place)) if value else (False, "")
        if value and is_text != isinstance(value, str):
            kinds = ("text", "a number") if is_text else ("a number", "text")
            raise UsageError(f"{place}, {column.name}: {_short_text(value)} is {kinds[1]}; in {where} it is {kinds[0]}")


def check_kept(line: Any, place: str) -> None:
    """Raise UsageError if a line of a file of kept rows is not a step."""
    _check(KEPT, line, [place])


def check_entry(entry: Any, place: str) -> None:
    """Raise UsageError if a parsed entry of a baseline is malformed, or a figure or a time is not a number."""
    _check(ENTRY, entry, [place])
    _check_row(entry["table"], entry["row"], [place])


def _check_row(name: str, row: Row, place: Sequence[str]) -> None:
    """Raise UsageError if a column holds an invalid value: a list, an object, too large an integer, or text for a
    figure or a time. Columns that the table does not have may hold anything."""
    table = TABLES.get(name)
    known = {name: column for name in row if (column := table.column(name))} if table else {}
    roles = {name: column.role for name, column in known.items()}
    _check(SCALARS, {name: row[name] for name in roles}, place)
    _check(NUMBERS, {name: row[name] for name, role in roles.items() if role in (Role.FIGURE, Role.TIME)}, place)


def _check(adapter: TypeAdapter[Any], value: Any, place: Sequence[str]) -> None:
    try:
        adapter.validate_python(value)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
    else:
        return
    loc = [f"row {part + 1}" if isinstance(part, int) else str(part) for part in first["loc"] if part != "rows"]
    where = ", ".join([*place, *loc])
    if first["type"] == "missing":
        raise UsageError(f"{where} is missing")
    wrong = first.get("ctx", {}).get("error") or WRONG.get(first["type"]) or first["msg"]
    raise UsageError(f"{where}: {_short_text(first['input'])} {wrong}")


def _short_text(value: Any) -> str:
    """Return the first 40 characters of a value's `repr`, with an ellipsis if it is longer; "a number" for an integer
    with more digits than Python prints."""
    try:
        text = repr(value)
    except ValueError:
        return "a number"
    return text if len(text) <= 40 else f"{text[:40]}…"
