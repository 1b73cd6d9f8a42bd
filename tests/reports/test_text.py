"""Names from users' files stay text: in Markdown, in a spreadsheet, on a terminal."""

import re

import pytest

from normalbench.reports import tables

HOSTILE = "<script src=//x>[a](http://b) |`@c\x1b[2J"


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1"])
def test_no_cell_of_csv_is_a_formula(text):
    (_, line) = tables.to_csv([{"name": text, "figure": -1.5}]).splitlines()
    assert line.lstrip('"').startswith("'") and line.endswith(",-1.5")


def test_markdown_reads_nothing_into_a_cell():
    text = tables.to_markdown([{"name": HOSTILE, "n": 1}, {"name": "octahedral", "n": 2}])
    outside = re.sub(r"`[^`\n]*`", "", text)
    assert not re.search(r"[<@\[\x1b]|http", outside), text
    assert all(len(re.findall(r"(?<!\\)\|", line)) == 3 for line in text.splitlines() if line), text


def test_a_terminal_gets_no_control_characters():
    out = tables.to_terminal([{"name": HOSTILE, "n": 1}, {"name": "b", "n": 2}], 100)
    assert "\x1b" not in out and "\\x1b[2J" in out
    assert tables.visible("a\u202eb\x07\n") == "a\\u202eb\\x07\n"


def test_what_is_code_stays_code():
    assert tables.markdown_text(tables.markdown_text(HOSTILE)) == tables.markdown_text(HOSTILE)
    assert tables.markdown_text("rg8 (a, b)") == "rg8 (a, b)"
