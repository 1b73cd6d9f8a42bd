"""A new table: a folder and a line in a copy of the tree add the table everywhere."""

import json
import os
import subprocess
import sys

import pytest
from contributing import EXAMPLES, a_copy_of_the_rooms, normalbench_in
from packed import packed_text

ECHO = EXAMPLES["a table"]


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the tree with one more table and no other change."""
    folder = tmp_path_factory.mktemp("copy")
    package = a_copy_of_the_rooms(folder)
    ECHO.add_to(package)
    EXAMPLES["a chart"].add_to(package)
    return folder


def test_the_new_table_is_a_command_with_help_and_formats(copy):
    assert "Words to repeat" in normalbench_in(copy, "echo", "--help").stdout
    done = normalbench_in(copy, "echo", "--word", "one,three", "--format", "json")
    assert [(row["word"], row["letters"]) for row in json.loads(done.stdout)] == [("one", 3), ("three", 5)], done.stderr
    assert "How many letters it has." in normalbench_in(copy, "columns", "echo").stdout
    assert "echo" in normalbench_in(copy, "run", "--help").stdout


def test_a_gate_and_a_test_can_check_the_new_table(copy):
    (copy / "gates.toml").write_text('[[gate]]\ntable = "echo"\nword = "three"\nletters = "at most 4"\n')
    done = normalbench_in(copy, "check", "gates.toml")
    assert done.returncode == 1 and "FAIL" in done.stdout and "three" in done.stdout, done.stderr
    (copy / "test_it.py").write_text(
        "import pytest\n"
        "def test_fixture(normalbench):\n    assert normalbench.echo(word='three')['letters'] == 5\n"
        "@pytest.mark.normalbench(table='echo', word='three', letters='at most 5')\ndef test_marker(): pass\n"
    )
    words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "test_it.py"]
    done = subprocess.run(words, cwd=copy, capture_output=True, text=True, env=os.environ | {"PYTHONPATH": "."})
    assert "2 passed" in done.stdout, done.stdout


def test_compare_names_the_new_rows_and_the_page_shows_the_new_table(copy):
    path = copy / "normalbench/bench/tables/echo/work.py"
    work = path.read_text()
    for name, letters in (("before", "len(word)"), ("after", "len(word) + (word == 'c')")):
        path.write_text(work.replace("len(word)", letters))
        assert normalbench_in(copy, "run", "--tables", "echo", "-o", name).returncode == 0
    done = normalbench_in(copy, "compare", "before", "after", "--format", "json", "--fail-on", "worse")
    (change,) = json.loads(done.stdout)
    assert done.returncode == 1 and (change["row"], change["column"], change["verdict"]) == ("c", "letters", "worse")
    page = (copy / "before/report.html").read_text()
    assert '<section id="echo"' in page and 'data-to="more"' in page and "What words cost" in page
    assert "How many letters it has. Unit: letters." in packed_text(page, "data-echo")
    assert "a parrot" in packed_text(page, "data-echo"), "the conditions, which are listed when they are opened"
    assert "bb is the longest, with 2 letters" in page and (copy / "before/charts/echo.svg").exists()
