"""A run's report for a pull request, without links: the answer, or shortened tables if the run has no answer."""

from __future__ import annotations

import html
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from .. import tables
from ..sheets import Row
from .found import Found
from .page import remarks
from .sections import whole

# What GitHub takes of a comment, less room for a word of one's own.
LONGEST = 60_000
CUT = "The tables do not fit in a comment; `normalbench report` shows them all.\n"


def markdown(run: Found) -> str:
    """Return a run's report as Markdown, cut between blocks to at most LONGEST characters."""
    safe = replace(
        run,
        name=_plain(run.name),
        tables={name: _rows(rows) for name, rows in run.tables.items()},
    )
    text = ""
    for block in _blocks(safe):
        if len(text) + len(block) > LONGEST - len(CUT):
            return text + CUT
        text += block + "\n"
    return text.rstrip() + "\n"


def _blocks(run: Found) -> Iterator[str]:
    yield f"## normalbench: {run.name}\n"
    for remark in remarks(run):
        yield f"> {_plain(remark)}\n"
    answers = [sheet for section in run.sections if section.about.leads for sheet in section.summary if sheet.said]
    for sheet in answers:
        first, *rest = map(tables.markdown_sentence, sheet.said)
        yield "\n".join([f"**{first}**\n", *(f"- {line}" for line in rest), ""])
    if agreement := run.agreement:
        yield f"{tables.markdown_sentence(agreement)}\n"
    # Nobody reads the tables of a whole run in a comment: its page has them.
    summaries = () if answers else (sheet for section in run.sections for sheet in section.summary if sheet.rows)
    for sheet in summaries:
        heading = f"<details><summary>{html.escape(sheet.title)}</summary>\n"
        yield "\n".join([heading, tables.to_markdown(_rows(whole(sheet.rows))), "</details>\n"])
    if answers:
        yield f"For tables, charts and images, open the page that {tables.code_text('normalbench report')} writes.\n"
    machine = [run.machine.get(name) for name in ("processor", "GL", "RADV") if run.machine.get(name)]
    versions = [f"{name} {run.machine[name]}" for name in ("normalbench", "jax", "python") if name in run.machine]
    yield f"Measured by {tables.code_text(run.command)}: {_plain(', '.join(map(str, [*machine, *versions])))}.\n"


def _rows(rows: Sequence[Row]) -> list[Row]:
    return [{_plain(name): _value(value) for name, value in row.items()} for row in rows]


def _value(value: Any) -> Any:
    return _plain(value) if isinstance(value, str) else value


def _plain(text: Any) -> str:
    return tables.markdown_text(str(text))
