"""Five ways to write a table."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from typing import Any

GAP = 2
# Longer cells are prose and may break between words.
PROSE = 40
# What no column of whole numbers counts up to.
LARGEST_WHOLE = 2**63
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff\ud800-\udfff]")
# Text that reads as itself in Markdown, and calls nobody.
PLAIN, CODE = re.compile(r"[\w .,+%():;>=<'/-]*"), re.compile(r"`[^`\n]*`")
# What a spreadsheet takes for a formula.
FORMULA = ("=", "+", "-", "@", "\t", "\r")
# What it takes for a number is harmless.
NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?(e[-+]?\d+)?( ?%)?|inf)")


def text_of(value: Any) -> str:
    """Return a value as display text: floats with four digits, None and NaN empty, control characters escaped."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, float) and math.isfinite(value):
        return f"{value:.2e}" if 0 < abs(value) < 1e-3 else f"{value:#.4g}".removesuffix(".")
    return visible(str(value))


# What columns' names say in small letters.
WORDS = {
    "psnr": "PSNR",
    "mse": "MSE",
    "db": "dB",
    "flip": "FLIP",
    "deg": "degrees",
    "glsl": "GLSL",
    "jax": "JAX",
    "gl": "GL",
}


def title_of(name: str) -> str:
    """Return a column's name for display, such as `PSNR dB`."""
    return " ".join(WORDS.get(word, word) for word in name.split("_"))


def visible(text: str) -> str:
    """Return text with control characters, which a terminal would obey, replaced by escapes."""
    return CONTROL.sub(lambda match: match[0].encode("unicode_escape").decode(), text)


def markdown_text(text: str) -> str:
    """Return text unchanged, or as Markdown code if Markdown would interpret it."""
    is_plain = PLAIN.fullmatch(text) and "://" not in text and "www." not in text.lower() and "<" not in text
    return text if is_plain or CODE.fullmatch(text) else code_text(text)


# What Markdown or HTML may read something into: dots and underscores in words and numbers are plain.
MARKED = re.compile(r"[^\w\s.,;:%°()+'?-]|^[-+]|(?<=[a-zA-Z])\.(?=\w)|(?<![^\W_])_|_(?![^\W_])", re.MULTILINE)


def markdown_sentence(text: str) -> str:
    """Return a sentence for Markdown and HTML, with special characters replaced by character references."""
    return re.sub(MARKED, lambda match: f"&#{ord(match[0])};", visible(text))


def code_text(text: str) -> str:
    """Return text as Markdown code, in backticks: backticks in it become apostrophes, white space single spaces."""
    return f"`{' '.join(text.replace('`', chr(39)).split())}`"


def _plain(value: Any) -> Any:
    """Return a value for JSON: None for NaN and infinity (an identical image is marked `exact`), and Python numbers
    for NumPy numbers."""
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def is_numeric(rows: Sequence[dict[str, Any]], column: str) -> bool:
    return all(isinstance(row[column], int | float | None) for row in rows)


def to_json(rows: Sequence[dict[str, Any]]) -> str:
    """Return rows as a JSON list of flat objects, with every control character escaped."""
    text = json.dumps([{k: _plain(v) for k, v in row.items()} for row in rows], indent=1)
    return text.replace("\x7f", "\\u007f") + "\n"


def to_csv(rows: Sequence[dict[str, Any]]) -> str:
    """Return rows as CSV text: a header, and a line for each row."""
    import pandas as pd

    records = [{_no_formula(name): _no_formula(value) for name, value in row.items()} for row in rows]
    return pd.DataFrame(records, dtype=object).to_csv(index=False, lineterminator="\n")


def _no_formula(value: Any) -> Any:
    """Return a value that no spreadsheet evaluates: text that begins like a formula gets a leading apostrophe, unless
    it is a number."""
    text = storable(value)
    is_formula = isinstance(text, str) and text.startswith(FORMULA) and not NUMBER.fullmatch(text)
    return f"'{text}" if is_formula else text


def storable(value: Any) -> Any:
    """Return a value unchanged, except that lone surrogates in text, which file names may contain, are escaped,
    because no file can hold them."""
    return value.encode(errors="backslashreplace").decode() if isinstance(value, str) else value


def to_markdown(rows: Sequence[dict[str, Any]], total: str = "") -> str:
    """Return rows as a Markdown table, with columns aligned for reading as source text; `total` as in `written`."""
    rows, caption = _captioned(rows, total)
    columns = list(rows[0])
    cells = [[markdown_text(text_of(row[c])).replace("|", "\\|") for c in columns] for row in rows]
    widths = [max(len(c), *(len(line[i]) for line in cells)) for i, c in enumerate(columns)]
    numeric = [is_numeric(rows, column) for column in columns]

    def line(values: Sequence[str]) -> str:
        padded = (v.rjust(w) if n else v.ljust(w) for v, w, n in zip(values, widths, numeric, strict=True))
        return "| " + " | ".join(padded) + " |"

    rule = "|" + "|".join("-" * (w + 1) + (":" if n else "-") for w, n in zip(widths, numeric, strict=True)) + "|"
    return "\n".join([line(columns), rule, *map(line, cells), "", caption]).rstrip() + "\n"


def _captioned(rows: Sequence[dict[str, Any]], total: str) -> tuple[list[dict[str, Any]], str]:
    """Return the rows with only the columns that a table shows, and the line below the table: `total`, or the
    constant values if `total` is empty."""
    if not total:
        return without_constants(rows)
    return [{k: v for k, v in row.items() if any(text_of(other[k]) for other in rows)} for row in rows], total


def without_constants(rows: Sequence[dict[str, Any]]) -> tuple[list[dict[str, Any]], str]:
    """Return the rows without columns that are empty or equal in all rows, and a line with these constant values.

    Measured figures, which are floats, stay in the table, because equal figures are a result to show.
    """
    if len(rows) < 2:
        return [{k: v for k, v in row.items() if text_of(v)} for row in rows], ""
    texts = {column: [text_of(row[column]) for row in rows] for column in rows[0]}
    figures = {column for column in texts if any(isinstance(row[column], float) for row in rows)}
    constant = {column: t[0] for column, t in texts.items() if len(set(t)) == 1 and column not in figures}
    caption = ", ".join(f"{column} {text}" for column, text in constant.items() if text and column != "exact")
    return [{k: v for k, v in row.items() if k not in constant} for row in rows], caption


def _fitting(rows: Sequence[dict[str, Any]], width: int, expendable: Sequence[str]) -> list[str]:
    """Return the columns that remain when expendable columns are dropped, in order, until the table fits the width or
    no more columns can be dropped."""
    columns = list(rows[0])
    spared = [column for column in expendable if column in columns]
    while spared and sum(_widths(rows, columns)) + GAP * (len(columns) - 1) > width:
        columns.remove(spared.pop(0))
    return columns


def _widths(rows: Sequence[dict[str, Any]], columns: Sequence[str]) -> list[int]:
    """Return the width that each column needs: headers may wrap between words, cells only if they are long prose."""
    longest = (max(len(text_of(row[column])) for row in rows) for column in columns)
    return [max(min(cell, PROSE), *map(len, c.split("_"))) for cell, c in zip(longest, columns, strict=True)]


def to_terminal(rows: Sequence[dict[str, Any]], width: int, expendable: Sequence[str] = (), total: str = "") -> str:
    """Return rows as a table for a terminal; `total` as in `written`.

    Columns with the same value in every row move to the line below the table. If the other columns do not fit, those
    in `expendable` are left out, in order, and a note lists them.
    """
    from io import StringIO

    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    shown, caption = _captioned(rows, total)
    columns = _fitting(shown, width, expendable)
    table = Table(box=None, pad_edge=False, padding=(0, GAP, 0, 0), header_style="bold")
    widths = _widths(shown, columns)
    for i, column in enumerate(columns):
        # Prose takes what width is left.
        longest, spare = max(len(text_of(row[column])) for row in shown), width - sum(widths) - GAP * len(columns)
        widths[i] += max(0, min(longest - widths[i], spare))
    for column, needed in zip(columns, widths, strict=True):
        side = "right" if is_numeric(shown, column) else "left"
        table.add_column(escape(column.replace("_", " ")), justify=side, width=needed, overflow="fold")
    for row in shown:
        table.add_row(*(escape(text_of(row[column])) for column in columns))
    stream = StringIO()
    wide = max(width, sum(widths) + GAP * len(columns))
    # Two colons around a letter are no emoji: octahedral:B:... Colours would be escapes, which are shown as text.
    console = Console(file=stream, width=wide, highlight=False, emoji=False, color_system=None)
    console.print(table)
    left_out = [column for column in shown[0] if column not in columns]
    notes = [caption, f"not shown at this width: {', '.join(left_out)}" if left_out else ""]
    for note in filter(None, notes):
        console.print(escape(note), style="dim")
    return "\n".join(line.rstrip() for line in stream.getvalue().splitlines()) + "\n"


def written(
    rows: Sequence[dict[str, Any]],
    format: str,
    width: int = 200,
    expendable: Sequence[str] = (),
    by: str | None = None,
    lead: str = "",
    total: str = "",
) -> str:
    """Return rows as "table", "json", "csv" or "markdown"; an infinite figure is null in JSON.

    Args:
        by: column by whose values tables for display are split; None for a single table.
        lead: text above the tables.
        total: line below the table. Columns with the same value in every row then stay in the table, because a
            line of
            constant values would be read as totals.
    """
    if format == "json":
        return to_json(rows)
    if format == "csv":
        return to_csv(rows)
    groups: dict[Any, list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault(row[by] if by else None, []).append(row)
    shown = (
        to_markdown(group, total) if format == "markdown" else to_terminal(group, width, expendable, total)
        for group in groups.values()
    )
    return visible("\n".join([*_lead(lead, format), *shown]))


def _lead(lead: str, format: str) -> list[str]:
    """Return a list of the text above a table, followed by an empty line; an empty list without text. In Markdown
    each line is a paragraph."""
    if not lead:
        return []
    lines = [markdown_sentence(line) if format == "markdown" else line for line in lead.split("\n")]
    return [("\n\n" if format == "markdown" else "\n").join(lines) + "\n"]
