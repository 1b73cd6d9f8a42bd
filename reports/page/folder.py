"""The page on the encodings of normals that were found in a folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from .. import tables
from .page import base, template


class Head(NamedTuple):
    """The heading of a column."""

    title: str
    numeric: bool


def folder_html(folder: str, lead: str, rows: Sequence[Mapping[str, Any]], lines: Sequence[str], patch: str) -> str:
    """Return the HTML of a page with a sentence, a table of rows, findings and a patch, each possibly empty."""
    shown = [dict(row) for row in rows]
    heads = [Head(tables.title_of(name), tables.is_numeric(shown, name)) for name in (shown[0] if shown else ())]
    cells = [[tables.text_of(value) for value in row.values()] for row in shown]
    about = {"folder": folder, "lead": lead, "heads": heads, "shown": cells, "lines": lines, "patch": patch}
    return template("folder.html.j2").render(about | base(["tables.js"]))
