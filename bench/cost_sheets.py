"""The cost table for people: what each family's compiler makes of an operation, beside the article's own figures."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise

from ..encodings.codec import Codec
from ..reports.pareto import Point
from . import seeds
from .cost import COLUMNS, PACKING_OPERATIONS, Row
from .disassembly import names

# What chooses between two numbers or keeps one within bounds.
GUARDS = ("v_cmp", "v_cndmask", "v_min", "v_max", "v_med")


def article_rows(encodings: Iterable[str], operations: Iterable[str]) -> list[Row]:
    """The article's figures of encodings that it has: instruction slots, and registers and cycles by GPU."""
    operations = tuple(operations)
    rows = []
    for key in ((encoding, operation) for encoding in encodings for operation in operations):
        if key not in seeds.SLOTS:
            continue
        row = dict.fromkeys(COLUMNS) | {"measure": "article", "encoding": key[0], "operation": key[1]}
        rows.append(row | {"instructions": sum(seeds.SLOTS[key]), "compiler": seeds.SLOTS_BY})
        for (gpu, compiler), (registers, cycles) in zip(seeds.GPUS.items(), seeds.CYCLES[key], strict=True):
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
    """Where the article's order by instruction slots is not the order by instructions, and why, from the disassembly.

    Args:
        listed: rows and their disassembly, of which one stage and family are compared: the first.
    """
    slots = {(r["encoding"], r["operation"]): r["instructions"] for r in article if not r["device"]}
    known = [(row, text) for row, text in listed if row["encoding"] and row["instructions"] is not None]
    if not known:
        return []
    stage, family = known[0][0]["stage"], known[0][0]["family"]
    notes = []
    for operation in dict.fromkeys(row["operation"] for row, _ in known):
        found = {
            row["encoding"]: (row, text)
            for row, text in known
            if (row["stage"], row["family"], row["operation"]) == (stage, family, operation)
            and (row["encoding"], operation) in slots
        }
        ordered = sorted(found, key=lambda name: slots[name, operation])
        said = ", ".join(f"{n} {slots[n, operation]}/{found[n][0]['instructions']}" for n in ordered)
        notes.append(f"{operation}, ps_3_0 slots / {family} {stage} instructions: {said}")
        notes += [
            _why(found[cheap], found[dear], slots)
            for cheap, dear in pairwise(ordered)
            if slots[cheap, operation] < slots[dear, operation]
            and found[cheap][0]["instructions"] > found[dear][0]["instructions"]
        ]
    return notes


def _why(cheap: tuple[Row, str], dear: tuple[Row, str], slots: dict) -> str:
    """One line about two encodings that change places."""
    parts = []
    for row, text in (cheap, dear):
        guards = sum(name.startswith(GUARDS) for name in names(text))
        kinds = f"{guards} of them to choose or to clamp, {row['transcendental'] or 0} transcendental"
        slot = slots[row["encoding"], row["operation"]]
        parts.append(f"  {row['encoding']}: {row['instructions']} ({kinds}) for {slot} slots")
    return "\n".join(["  another order, for a slot computes up to four numbers, an instruction here one:", *parts])


def points(rows: Sequence[Row], column: str, operation: str, errors: Mapping[Codec, float | None]) -> Iterator[Point]:
    """Each codec: what its encoding and its storage take together, as far as both are known."""
    costs = {(row.get("encoding"), row.get("storage"), row.get("operation")): row[column] for row in rows}
    for codec, error in errors.items():
        bits = ":".join(map(str, codec.storage.bits[: max(codec.encoding.components, 2)]))
        packing = (None, f"{codec.storage.name} {bits}", PACKING_OPERATIONS[operation])
        own = costs.get((codec.encoding.name, None, operation))
        if own is not None and error is not None and math.isfinite(error):
            yield codec.encoding.name, own + (costs.get(packing) or 0), error, codec.bits
