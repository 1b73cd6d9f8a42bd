"""The data for the page's cards of codecs: facts about each codec, and the columns with its figures."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ..sheets import Column, Role, Row
from .codec_key import CodecKey
from .found import Found
from .packing import packed
from .sections import TableSection, whole
from .verdict import is_number

# What the list of codecs shows of each, the first of these columns that a row has.
MEAN, LARGEST, SLOTS = ("angle_mean_deg",), ("angle_sup_deg", "angle_max_deg"), ("slots_once",)
# Figures that the whole texel decides, and not only the numbers that are stored.
OF_TEXELS = ("bytes_per_pixel", "bits_per_texel", "free_bits")
# Of a codec's keys, what names it or is the same figure measured again.
OWN = ("encoding", "storage", "rounding", "backend")


def block(run: Found, names: Sequence[str]) -> str:
    """Return the packed data that cards.js reads; empty if the run has no codecs.

    Args:
        names: names of the codecs that the page shows.
    """
    about = run.cards
    if not about or not names:
        return ""
    sections = sections_of(run)
    codecs = codecs_of(run, names)
    shown = set(map(of_encoding, names))
    encodings = {name: encoding for name, encoding in about["encodings"].items() if name in shown}
    tables = [_table(section, about["takes"][section.key]) for section in sections]
    content = {"codecs": codecs, "encodings": encodings, "tables": tables, "code": _code(run, names)}
    return packed(json.dumps(content, allow_nan=False, separators=(",", ":")))


def sections_of(run: Found) -> list[TableSection]:
    """Return the sections of tables whose rows are about codecs of normals."""
    return [section for section in run.sections if section.rows and section.key in run.cards["takes"]]


def codecs_of(run: Found, names: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Return the facts about each codec by name: its storage, and the figures by which codecs are compared."""
    known = run.cards["codecs"]
    first = _first_rows(sections_of(run), known)
    return {name: first.get(name, {}) | known.get(name, {}) for name in names}


def of_encoding(codec: str) -> str:
    """Return the encoding in a codec's name: the part before the first space."""
    return codec.partition(" ")[0]


def _table(section: TableSection, takes: Sequence[str]) -> dict[str, Any]:
    """Return the facts about a table that a card needs: the columns that distinguish its rows, its figures with the
    most important first, the figures that depend on the whole texel, and the columns of reasons."""
    columns = [section.column(name) for name in whole(section.rows)[0]]
    keys = [column.name for column in columns if column.role is Role.KEY and column.name not in OWN]
    figures = sorted(filter(is_figure, columns), key=lambda column: column.drops > 0)
    table = {"key": section.key, "title": section.about.title, "view": section.about.view, "takes": list(takes)}
    table |= {"keys": keys, "figures": [column.name for column in figures]}
    table |= {"texel": [column.name for column in figures if section.about.of_texels or column.name in OF_TEXELS]}
    return table | {"reasons": [column.name for column in columns if column.role is Role.REASON]}


def is_figure(column: Column) -> bool:
    """Whether codecs are compared by a column: it is a displayed figure, and either more or less is better."""
    return bool(column.better) and column.shown and column.role is Role.FIGURE


def _first_rows(sections: Sequence[TableSection], known: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the headline figures of each codec by name, from its own row or the row of a codec that stores the same
    numbers. Rows on normals that the encoding can represent come first, then rows of an answer, then the codec's own.
    `of` is the set of normals."""
    rows: dict[tuple[str, str], list[tuple[bool, bool, str, Row]]] = {}
    labels: dict[str, None] = {}
    for section in sections:
        for row in section.rows:
            key = CodecKey.said_by(row)
            if key and _first(row, MEAN) is not None:
                labels.setdefault(key.label)
                entry = (bool(row.get("lost_percent")), not section.about.leads, key.label, row)
                rows.setdefault(_stored(key.label, known), []).append(entry)
    return {label: _headline(_best_row(label, rows[_stored(label, known)])) for label in labels}


def _best_row(label: str, rows: Sequence[tuple[bool, bool, str, Row]]) -> Row:
    return min(rows, key=lambda candidate: (*candidate[:2], candidate[2] != label))[3]


def _stored(label: str, known: Mapping[str, Any]) -> tuple[str, str]:
    """Return a key that codecs share if they store the same numbers: the encoding, and the stored numbers or, if
    these are not known, the codec's name."""
    return of_encoding(label), known[label]["numbers"] if label in known else label


def _headline(row: Row) -> dict[str, Any]:
    figures: Row = {"mean": _first(row, MEAN), "largest": _first(row, LARGEST), "slots": _first(row, SLOTS)}
    figures |= {"sampled": _first(row, LARGEST[:1]) is None or None}
    figures |= {"bits": _first(row, ("bits",)), "of": str(row.get("normals"))}
    return {name: value for name, value in figures.items() if value is not None}


def _first(row: Row, names: Sequence[str]) -> float | None:
    values = (row[name] for name in names if is_number(row.get(name)))
    return next((value for value in values if math.isfinite(value)), None)


def _code(run: Found, names: Sequence[str]) -> dict[str, Any]:
    """Return the run's shader code for these codecs, with only the pieces of text that it needs; empty collections if
    the run has no code."""
    kept = run.code
    if not kept:
        return {"languages": {}, "pieces": [], "codecs": {}}
    codecs = {name: kept["codecs"][name] for name in names if name in kept["codecs"]}
    # Sorted, so that what is alike lies close together and packs small.
    places = {piece: i for i, piece in enumerate(sorted(set(_places(codecs)), key=kept["pieces"].__getitem__))}
    texts = {
        name: codec | {"texts": {word: [places[piece] for piece in text] for word, text in codec["texts"].items()}}
        for name, codec in codecs.items()
    }
    return {"languages": kept["languages"], "pieces": [kept["pieces"][piece] for piece in places], "codecs": texts}


def _places(codecs: Mapping[str, Any]) -> Iterator[int]:
    for codec in codecs.values():
        for text in codec["texts"].values():
            yield from text
