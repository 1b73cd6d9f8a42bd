"""Names from users' files stay text: in Markdown, in a spreadsheet, on a terminal."""

import csv
import io
import json
import re

import pytest
from rich.console import Console

from normalbench.bench.ground.output.progress import progress
from normalbench.bench.ground.output.writing import say
from normalbench.reports import tables
from normalbench.reports.page import live, page

HOSTILE = "<script src=//x>[a](http://b) |`@c\x1b[2J"


@pytest.mark.parametrize("text", ["=1+1", "+1+2", "-1+2", "-A1", "@SUM(A1)", "\t=1"])
def test_no_cell_of_csv_is_a_formula(text):
    for line in tables.to_csv([{text: text, "figure": -1.5}]).splitlines():
        assert line.lstrip('"').startswith("'") and line.endswith((",figure", ",-1.5")), line


@pytest.mark.parametrize("text", ["-1", "-0.52032965", "17", "+0.0362", "-1.2e-05", "-inf", "+20.1 %"])
def test_printed_numbers_stay_numbers_in_csv(text):
    assert tables.to_csv([{"printed": text}]).splitlines()[1] == text


def test_markdown_in_a_cell_is_escaped():
    text = tables.to_markdown([{"name": HOSTILE, "n": 1}, {"name": "octahedral", "n": 2}])
    outside = re.sub(r"`[^`\n]*`", "", text)
    assert not re.search(r"[<@\[\x1b]|http", outside), text
    assert all(len(re.findall(r"(?<!\\)\|", line)) == 3 for line in text.splitlines() if line), text


def test_a_terminal_gets_no_control_characters():
    out = tables.to_terminal([{"name": HOSTILE, "n": 1}, {"name": "b", "n": 2}], 100)
    assert "\x1b" not in out and "\\x1b[2J" in out
    assert tables.visible("a\u202eb\x07\n") == "a\\u202eb\\x07\n"


@pytest.mark.parametrize("format", ["table", "markdown"])
def test_no_line_around_a_table_has_control_characters(format, monkeypatch):
    """This covers the lead, the line below and the names of columns; colours cannot be forced either."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    rows = [{"name": "a", HOSTILE: 1.0}, {"name": "b", HOSTILE: 2.0}]
    text = tables.written(rows, format, 100, lead=HOSTILE, total=HOSTILE)
    assert text.count("\\x1b[2J") >= 2 and not tables.CONTROL.search(text), text


def test_printed_text_has_no_control_characters(capsys):
    """This holds in every format; JSON and CSV still give the name when they are read back."""
    row = {"name": f"{HOSTILE}\x7f", "figure": 1.5}
    for way in ("table", "json", "csv", "markdown"):
        say(tables.written([row], way))
        out = capsys.readouterr().out
        assert not tables.CONTROL.search(out), (way, out)
        if way == "json":
            assert json.loads(out) == [row]
    text = tables.to_csv([row])
    assert next(csv.DictReader(io.StringIO(text)))["name"] == row["name"], text


@pytest.mark.parametrize("name", ["[/red].glsl", "[red]a.glsl", "a\x1b[2Jb.glsl"])
def test_a_progress_bar_shows_names_literally(name, monkeypatch):
    """Square brackets are not markup, and a terminal gets no escape sequences from a name."""
    shown = io.StringIO()
    console = Console(file=shown, force_terminal=True, width=200)
    monkeypatch.setattr("rich.console.Console", lambda **_: console)
    with progress(1) as tick:
        tick(name)
    assert tables.visible(name) in shown.getvalue() and "\x1b[2J" not in shown.getvalue(), shown.getvalue()


def test_escaped_text_is_not_escaped_again():
    assert tables.markdown_text(tables.markdown_text(HOSTILE)) == tables.markdown_text(HOSTILE)
    assert tables.markdown_text("rg8 (a, b)") == "rg8 (a, b)"


def test_optional_columns_are_dropped_first():
    rows = [{"name": "one", "first": "a" * 30, "second": "b" * 30}, {"name": "two", "first": "c", "second": "d"}]
    wide, narrow = (tables.written(rows, "table", width, ("first", "second")).split() for width in (200, 50))
    assert wide[:3] == ["name", "first", "second"] and narrow[:2] == ["name", "second"], (wide, narrow)


def test_figures_of_a_page_sort_by_all_their_digits():
    """Rounded to four digits, both figures look the same."""
    table = page.table("t", [{"name": name, "db": db} for name, db in (("a", 50.00001), ("b", 50.00002))], lambda _: "")
    first, other = (line.cells[1] for line in table.rows)
    assert first.text == other.text and float(first.value) < float(other.value), (first, other)


def test_names_in_the_scripts_of_the_page_are_unique():
    """The scripts share one scope with the laboratory's scripts, which are added when the laboratory is opened: a
    second `const` with the same name stops them all."""
    paths = [page.WEB / name for name in page.SCRIPTS] + [live.FOLDER / name for name in live.SCRIPTS]
    texts = [path.read_text(encoding="utf-8") for path in paths]
    declared = re.compile(r"^(const|let|class|function|async function)\s+(\w+)([^\n]*)", re.MULTILINE)
    parts = [match.groups() for text in texts for match in declared.finditer(text)]
    # Several to a line: const VERSION = "v1", CODECS = [...].
    more = [re.findall(r", (\w+) = ", rest) for kind, _, rest in parts if kind in ("const", "let") and "=>" not in rest]
    names = [name for _, name, _ in parts] + [name for several in more for name in several]
    assert len(names) > 100
    assert not {name for name in names if names.count(name) > 1}


def test_strings_in_the_laboratory_scripts_are_on_one_line():
    """The page contains the scripts without indentation and comment lines."""
    wrong = [
        f"{name}: {line}"
        for name in live.SCRIPTS
        for line in (live.FOLDER / name).read_text(encoding="utf-8").splitlines()
        if line.count("`") % 2
    ]
    assert not wrong, wrong
    assert not re.search(r"^(\s|//)", live.script(), re.MULTILINE)
