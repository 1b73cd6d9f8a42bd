"""Rows that tests share are those that would be measured: what they follow from is in their key."""

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import kept_rows
import pytest
from slowly import all_but

from normalbench.bench.run.measuring import asked
from normalbench.bench.tables.registry import TABLES


@pytest.mark.parametrize("name", all_but(1, ["quality", "mix", "vectors"]))
def test_what_a_table_really_imports_is_in_its_key(name):
    """Every file of the project that is loaded once the table was measured, but for what Python finds by names in
    strings: the registry of the tables, and what the program is started with."""
    folder = kept_rows.ROOT / "bench" / "tables" / name
    measure = (
        "import sys, normalbench as nb; from normalbench.bench.tables.registry import TABLES\n"
        f"before = {{*sys.modules}}; TABLES[{name!r}].work\n"
        "print(*(sys.modules[m].__file__ for m in {*sys.modules} - before if m.startswith('normalbench')), sep='\\n')"
    )
    done = subprocess.run([sys.executable, "-c", measure], capture_output=True, text=True, check=True)
    loaded = {Path(line).resolve() for line in done.stdout.splitlines() if line != "None"}
    known = set().union(*map(kept_rows.reached, folder.glob("*.py"))) | set(kept_rows.ALWAYS)
    packages = {path for path in loaded if path.name == "__init__.py"}
    assert len(loaded) > 50 and loaded - packages <= known, loaded - packages - known


def test_a_changed_source_changes_the_key_and_one_that_is_not_imported_does_not(monkeypatch, tmp_path):
    for path, text in {
        "bench/tables/echo/work.py": "from ..deep import a",
        "bench/tables/deep.py": "import os",
    }.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    (tmp_path / "bench/tables/other.py").write_text("")
    monkeypatch.setattr(kept_rows, "ROOT", tmp_path)
    monkeypatch.setattr(kept_rows, "ALWAYS", [])

    def key() -> str:
        kept_rows.imported.cache_clear()
        return kept_rows.fingerprint.__wrapped__("normalbench.bench.tables.echo")

    first = key()
    (tmp_path / "bench/tables/other.py").write_text("import sys")
    assert key() == first
    (tmp_path / "bench/tables/deep.py").write_text("import sys")
    assert key() != first
    kept_rows.imported.cache_clear()


def test_a_step_is_measured_once_and_rows_keep_their_order(tmp_path):
    table = TABLES["quality"]
    ask = asked(table, table.options(encoding="xy,octahedral", storage="rg8", normals="axes", backend="jax"))
    measured: list[str] = []

    def measure(_, __, steps, ___):
        for step in steps:
            measured.append(step.name)
            yield step, [{"name": step.name, "mse": float("inf")}]

    kept = kept_rows.kept(measure, tmp_path)
    few = list(kept(SimpleNamespace(), ask, ask.steps[1:], None))
    all_of_them = list(kept(SimpleNamespace(), ask, ask.steps, None))
    assert measured == [ask.steps[1].name, ask.steps[0].name]
    assert [step for step, _ in all_of_them] == list(ask.steps) and all_of_them[1:] == few
