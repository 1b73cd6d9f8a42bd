"""A table is a folder and a line: in a copy of the tree, one is added, and everything knows it."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from test_readme import a_copy_of_the_rooms

TABLE = """
from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import Option, Seed
from ..table import Column, Role, Section, Table


@dataclass(frozen=True, kw_only=True)
class EchoOptions:
    word: Annotated[str, Option("--word", "Words to repeat, comma-separated.")] = "a,bb,c,dd,e,ff"
    pause: Annotated[float, Option("--pause", "Seconds that a word takes.")] = 0.0
    seed: Seed = 0


TABLE = Table(
    name="echo",
    package=__package__ or "",
    help="How long words are.",
    example="normalbench echo --word two,words",
    options=EchoOptions,
    columns=(
        Column("word", "The word that was repeated.", Role.KEY),
        Column("letters", "How many letters it has.", unit="letters", better="less"),
        Column("device", "What repeated it.", Role.HOW),
    ),
    usual=({"pause": PAUSE},),
    single={"word": "a"},
    section=Section("What words cost", "Words", "How long is a word?", "Letters are counted."),
)
"""
WORK = """
import time

from ..table import Step, Work, each


def steps(options, outputs):
    words = options.word.split(",")
    return [Step({"word": w, "seed": options.seed}, (w, options.pause), w) for w in words]


def measure(case):
    word, pause = case
    time.sleep(pause)
    return [{"word": word, "letters": LETTERS, "device": "a parrot"}]


WORK = Work(steps=steps, measure=each(measure))
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """The tree with one more table; nothing else is touched."""
    folder = tmp_path_factory.mktemp("copy")
    package = a_copy_of_the_rooms(folder)
    echo = package / "bench/tables/echo"
    echo.mkdir()
    (echo / "table.py").write_text(TABLE.replace("PAUSE", "0.15"))
    (echo / "work.py").write_text(WORK.replace("LETTERS", "len(word)"))
    registry = package / "bench/tables/registry.py"
    registry.write_text(registry.read_text().replace('    "quality",\n', '    "quality",\n    "echo",\n'))
    return folder


def command(copy: Path, *arguments: str) -> subprocess.CompletedProcess:
    words = [sys.executable, "-m", "normalbench", *arguments]
    return subprocess.run(words, cwd=copy, capture_output=True, text=True)


@pytest.mark.slow
def test_it_is_a_command_with_help_and_formats(copy):
    assert "Words to repeat" in command(copy, "echo", "--help").stdout
    done = command(copy, "echo", "--word", "one,three", "--format", "json")
    assert [(row["word"], row["letters"]) for row in json.loads(done.stdout)] == [("one", 3), ("three", 5)], done.stderr
    assert "How many letters it has." in command(copy, "columns", "echo").stdout
    assert "echo" in command(copy, "run", "--help").stdout


@pytest.mark.slow
def test_a_gate_and_a_test_may_hold_it(copy):
    (copy / "gates.toml").write_text('[[gate]]\ntable = "echo"\nword = "three"\nletters = "at most 4"\n')
    done = command(copy, "check", "gates.toml")
    assert done.returncode == 1 and "FAIL" in done.stdout and "three" in done.stdout, done.stderr
    (copy / "test_it.py").write_text(
        "import pytest\n"
        "def test_fixture(normalbench):\n    assert normalbench.echo(word='three')['letters'] == 5\n"
        "@pytest.mark.normalbench(table='echo', word='three', letters='at most 5')\ndef test_marker(): pass\n"
    )
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_it.py"]
    done = subprocess.run(words, cwd=copy, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": "."})
    assert "2 passed" in done.stdout, done.stdout


@pytest.mark.slow
def test_compare_names_its_rows_and_the_page_shows_it(copy):
    for name, letters in (("before", "len(word)"), ("after", "len(word) + (word == 'c')")):
        path = copy / "normalbench/bench/tables/echo/work.py"
        path.write_text(WORK.replace("LETTERS", letters))
        assert command(copy, "run", "--tables", "echo", "-o", name).returncode == 0
    done = command(copy, "compare", "before", "after", "--format", "json", "--fail-on", "worse")
    (change,) = json.loads(done.stdout)
    assert done.returncode == 1 and (change["row"], change["column"], change["verdict"]) == ("c", "letters", "worse")
    page = (copy / "before/report.html").read_text()
    assert '<section id="echo"' in page and '<a href="#echo">Words</a>' in page and "What words cost" in page
    assert re.search(r"<dt>letters</dt><dd>How many letters it has\. Unit: letters\.</dd>", page)
    assert "a parrot" in page, "the conditions"
