"""The cost table as displayed: instructions of each operation by compiler, next to the article's own figures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ...measures.metrics import published
from .measure import Row
from .table import TABLE


def article_rows(encodings: Iterable[str], operations: Iterable[str]) -> list[Row]:
    """Return the article's figures for these operations, if it has them: for each operation a row with instruction
    slots, then a row for each GPU with registers and cycles."""
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
    """Return a row for each stage and operation, with instructions in a column for each family, a column for SPIR-V
    and, unless `article` is empty, a column for the article."""
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
    """Return a row for each operation in `article`: its slots, and its cycles in a column for each GPU."""
    lines: dict[tuple, Row] = {}
    for row in article:
        key = (row["encoding"], row["operation"])
        line = lines.setdefault(key, {"encoding": key[0], "operation": key[1], "slots": row["instructions"]})
        if row["device"]:
            line[row["device"]] = row["cycles"]
    return list(lines.values())
