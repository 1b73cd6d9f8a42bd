"""The cost table for people: what each family's compiler makes of an operation, beside the article's own figures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations

from ...measures.metrics import published
from .measure import Row, listings_of
from .table import TABLE


def article_rows(encodings: Iterable[str], operations: Iterable[str]) -> list[Row]:
    """The article's figures of encodings that it has: instruction slots, and registers and cycles by GPU."""
    operations = tuple(operations)
    rows = []
    for key in ((encoding, operation) for encoding in encodings for operation in operations):
        if key not in published.SLOTS:
            continue
        row = TABLE.empty() | {"measure": "article", "encoding": key[0], "operation": key[1]}
        rows.append(row | {"instructions": sum(published.SLOTS[key]), "compiler": published.SLOTS_BY})
        for (gpu, compiler), (registers, cycles) in zip(published.GPUS.items(), published.CYCLES[key], strict=True):
            rows.append(row | {"device": gpu, "vgprs": registers, "cycles": cycles, "compiler": compiler})
    return rows


def isa_sheet(rows: Sequence[Row], article: Sequence[Row]) -> list[Row]:
    """A line for each stage and operation: the families' instructions side by side, and SPIR-V's and the article's."""
    slots = {(r["encoding"], r["operation"]): r["instructions"] for r in article if not r["device"]}
    lines: dict[tuple, Row] = {}
    for row in rows:
        if row["operation"] is None:
            continue
        what = row["encoding"] or row["storage"]
        line = lines.setdefault(
            (row["stage"], what, row["operation"]),
            {"stage": row["stage"], "what": what, "operation": row["operation"]}
            | ({"article": slots.get((row["encoding"], row["operation"]))} if article else {})
            | {"spirv": row["spirv_instructions"]},
        )
        if row["family"]:
            line[row["family"]] = row["instructions"]
    columns = dict.fromkeys(column for line in lines.values() for column in line)
    return [{column: line.get(column) for column in columns} for line in lines.values()]


def article_sheet(article: Sequence[Row]) -> list[Row]:
    """A line for each operation: the article's slots, and its cycles by GPU."""
    lines: dict[tuple, Row] = {}
    for row in article:
        key = (row["encoding"], row["operation"])
        line = lines.setdefault(key, {"encoding": key[0], "operation": key[1], "slots": row["instructions"]})
        if row["device"]:
            line[row["device"]] = row["cycles"]
    return list(lines.values())


def order_notes(listed: Sequence[tuple[Row, str]], article: Sequence[Row]) -> list[str]:
    """Where the article's order by instruction slots is not the order by instructions, and what the listings hold.

    Args:
        listed: rows and their disassembly, of which one stage and family are compared: the first.
    """
    slots = {(r["encoding"], r["operation"]): r["instructions"] for r in article if not r["device"]}
    known = [(r, t) for r, t in listed if (r["encoding"], r["operation"]) in slots and r["instructions"] is not None]
    if not known:
        return []
    stage, family = known[0][0]["stage"], known[0][0]["family"]
    notes = []
    for operation in dict.fromkeys(row["operation"] for row, _ in known):
        chosen = [(r, t) for r, t in known if (r["stage"], r["family"], r["operation"]) == (stage, family, operation)]
        ordered = sorted(chosen, key=lambda one: slots[one[0]["encoding"], operation])
        said = ", ".join(f"{r['encoding']} {slots[r['encoding'], operation]}/{r['instructions']}" for r, _ in ordered)
        notes.append(f"{operation}, ps_3_0 slots / {family} {stage} instructions: {said}")
        notes += _turned_lines(ordered, {name: count for (name, of), count in slots.items() if of == operation})
    return notes


def _turned_lines(ordered: Sequence[tuple[Row, str]], slots: dict[str, int]) -> list[str]:
    """Which pairs of rows, in the order of their slots, change places, and a line on each row of such a pair."""
    pairs = [
        (cheap, dear)
        for cheap, dear in combinations(ordered, 2)
        if slots[cheap[0]["encoding"]] < slots[dear[0]["encoding"]]
        and cheap[0]["instructions"] > dear[0]["instructions"]
    ]
    if not pairs:
        return []
    said = ", ".join(f"{cheap[0]['encoding']} and {dear[0]['encoding']}" for cheap, dear in pairs)
    rows = [one for one in ordered if any(one in pair for pair in pairs)]
    return [f"  the other way round: {said}", *(_holding_line(row, text, slots[row["encoding"]]) for row, text in rows)]


def _holding_line(row: Row, text: str, slots: int) -> str:
    """One line about what a row's listing holds."""
    read = listings_of(row["family"])
    guards = sum(name.startswith(read.GUARDS) for name in read.names(text))
    held = f"{guards} to compare, choose or clamp, {row['transcendental'] or 0} transcendental"
    return f"  {row['encoding']}: {row['instructions']} instructions for {slots} slots, of them {held}"
