"""Renamed tables: in a copy of the tree, the tables with extras have other folders and names."""

import re

import pytest
from contributing import a_copy_of_the_rooms, normalbench_in

# By the name, which is the folder's, of a table that shows more than its rows: another one.
RENAMED = {"quality": "loss", "cost": "price", "pick": "advise"}


def _renamed_imports(path, tables) -> str:
    """Return a module's text in which imports from other tables use the new folders."""
    above = r"\." * len(path.relative_to(tables).parts) if tables in path.parents else r"\.+tables\."
    imports = re.compile(rf"(from {above})({'|'.join(RENAMED)})\b")
    return imports.sub(lambda match: match[1] + RENAMED[match[2]], path.read_text())


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the tree in which three tables and their folders are renamed."""
    folder = tmp_path_factory.mktemp("copy")
    bench = a_copy_of_the_rooms(folder) / "bench"
    tables = bench / "tables"
    for path in bench.rglob("*.py"):
        path.write_text(_renamed_imports(path, tables))
    registry = tables / "registry.py"
    for old, new in RENAMED.items():
        (tables / old).rename(tables / new)
        text = registry.read_text()
        assert text.count(f'"{old}",') == 1
        registry.write_text(text.replace(f'"{old}",', f'"{new}",'))
    return folder


@pytest.mark.usefixtures("gl")
def test_a_run_and_its_page_do_not_depend_on_the_names_of_tables(copy):
    """The page has the extras of these tables, and a gate that names no table applies to the table of errors."""
    loss, price, advise = RENAMED.values()
    words = ("--encoding", "octahedral,stereographic", "--storage", "rgba8", "--count", "2000")
    done = normalbench_in(copy, "run", "--tables", f"{loss},{price},{advise}", *words, "-o", "run")
    assert done.returncode == 0, done.stderr
    assert normalbench_in(copy, "report", "run", "-o", "page.html").returncode == 0
    page = (copy / "page.html").read_text()
    assert all(f'<section id="{name}"' in page or f'id="{name}"' in page for name in (loss, price, advise))
    assert "JAX and GLSL agree within" in page and "octahedral" in page
    assert "its rows have no histograms" not in page and "it has no maps" not in page
    # What pick adds: the questions that a reader may ask otherwise. What cost adds: disassemblies.
    assert 'id="data-choices"' in page and "data-choose" in page and "data-listings=" in page
    (copy / "gates.toml").write_text('[[gate]]\nencoding = "octahedral"\npsnr_db = "at least 30"\n')
    done = normalbench_in(copy, "check", "gates.toml", "--run", "run", "--format", "json")
    assert done.returncode == 0 and f'"table": "{loss}"' in done.stdout, done.stderr
