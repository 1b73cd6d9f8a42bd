"""Choices for the page's script: the codecs for each question, judged by everything that a reader cannot change.

The script contains only the ranking rule of `answer.py`, applied with the reader's limits instead of the requested
ones.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ....encodings.codecs.codec import fewer_bits
from ....reports.page.codec_key import CodecKey
from ....reports.page.verdict import MADE_FOR
from ...ground.options.gpu_families import FAMILIES
from ...measures.images.turns import INDISTINGUISHABLE_DB, VIEW_SPACE
from ..mix.table import USES
from . import answer
from .answer import Row, asked_of, groups, largest, largest_mixed, loss_db, mean, why_unfit
from .charts import FOUND, chart_name, spread_name
from .sentences import around_gain, axis_text, called, constraints, not_held, question
from .table import TABLE

# The constants of the rule, by their names there.
CONSTANTS = {
    "hidden": answer.HIDDEN_SLOTS,
    "affordable": answer.AFFORDABLE,
    "step": answer.STEP,
    "same": answer.SAME_PRICE,
    "least": answer.LEAST_DB,
    "much": answer.MUCH_BETTER_DB,
    "needless": answer.NEEDLESS,
    "hole": answer.HOLE,
    "lost": answer.LOST_DEG,
    "errors": answer.ERRORS,
    "equal": INDISTINGUISHABLE_DB,
}
# What a reader may ask for otherwise.
ASKED = (
    *("most_instructions", "readers", "worth", "enough", "accept_holes", "accept_lengths", "look_ups"),
    *("mixing", "family"),
)


def extras(_folder: Path, tables: Mapping[str, Sequence[Row]], _remarks: list[str]) -> Mapping[str, Any]:
    """Return {"choices": {constants, questions, found}} for the page, without questions about cost alone; an empty dict
    if no question is left."""
    asked = enumerate(groups(tables[TABLE.name]).values())
    questions = [
        _question(group) | {"chart": chart_name(index), "spread": spread_name(index)}
        for index, group in asked
        if group[0]["aim"] != "cost"
    ]
    return {"choices": {"constants": CONSTANTS, "questions": questions, "found": FOUND}} if questions else {}


def _question(group: Sequence[Row]) -> dict[str, Any]:
    first = group[0]
    asked = {name: first.get(name) for name in ASKED} | {"look_ups": first.get("look_ups") is not False}
    unpriced = {"length": answer.LENGTH_SAID, "hole": answer.HOLE_SAID, "price": answer.LOOPS_SAID}
    texts = {**unpriced, "figure": f"{answer.NO_FIGURE} {first['aim']}", "table": answer.TABLE_SAID}
    about = {"where": question(first), "of": asked_of(first), "on": _on(first), "needs": _needs_text(first)}
    about |= {"aim": first["aim"], "asked": asked, "said": texts}
    codes = [_code(row) for row in group]
    counted = dict.fromkeys(name for code in codes for name in code["families"] or ())
    families = {name: f"{FAMILIES[name].title} ({name})" if name in FAMILIES else name for name in counted}
    return {
        **about,
        "uses": list(USES) if any(code["uses"] for code in codes) else [],
        "families": families,
        "codes": codes,
    }


def _on(first: Row) -> str:
    """Return the set of normals, followed by the normals that an encoding must represent, unless these are all."""
    held = MADE_FOR.get(first["needs"] or "")
    return f"{first['normals']}: {held}" if held else first["normals"]


def _needs_text(first: Row) -> Sequence[str]:
    """Return the constraints of a question that a reader cannot change on the page, in words."""
    return constraints({**first, "most_instructions": None, "mixing": None})


def _edge_text(row: Row) -> str:
    return answer.EDGE_SAID if row["mixed_across"] and answer.edges_decide(row["needs"]) else ""


def _code(row: Row) -> dict[str, Any]:
    fixed = {**row, "accept_lengths": True}
    is_long = not why_unfit(fixed) and bool(why_unfit({**row, "accept_lengths": False}))
    begin, end = around_gain(row, "{mean}")
    return {
        "name": called(row),
        "codec": CodecKey.of(row).label,
        "storage": row["storage"],
        "unfit": why_unfit(fixed),
        "long": is_long,
        "cannot": str(row["cannot_mix"] or "").partition(":")[0] or _edge_text(row),
        "uses": _read(row.get("by_use")),
        "families": _read(row.get("by_family")),
        "plain": [row["angle_mean_deg"], largest(row)],
        "loss": _finite(loss_db(row)),
        "turns": _turns(row),
        "met": largest(row),
        "largest": largest_mixed(row),
        "sampled": row["angle_sup_deg"] is None,
        "mean": mean(row),
        "encode": row["encode_slots"],
        "decode": row["decode_slots"],
        "once": row["slots_once"],
        "priced": row["slots"] is not None,
        "bits": row["bits"],
        "codes": fewer_bits(row["bits"], row["code_bits"]),
        "free": row["free_bits"],
        "table": bool(row["table"]),
        "image": answer.image_db(row),
        "pole": axis_text(row["image_pole"]) if row.get("image_pole") else "",
        "beside": row["beside"],
        "packed": row["packed"],
        "lost": " ".join(not_held(row)),
        "begin": begin,
        "end": end,
    }


def _turns(row: Row) -> list[list[float]]:
    """Return a list for each image with its errors by yaw, at the encoding's pole."""
    errors = _read(row.get("image_errors")) or {}
    return [by_pole[row["image_pole"] or VIEW_SPACE] for by_pole in errors.values()]


def _read(text: str | None) -> Any:
    """Return the parsed value of a JSON column; None if it was not measured."""
    return json.loads(text) if text else None


def _finite(value: float) -> float | None:
    """Return a loss; None if it is not finite, because JSON cannot store such a number."""
    return value if math.isfinite(value) else None
