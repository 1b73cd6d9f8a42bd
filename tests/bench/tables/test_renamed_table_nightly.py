"""A table goes by its value alone: in a copy of the tree the folder and the name of one are others."""

import re

import pytest
from contributing import a_copy_of_the_rooms, normalbench_in

FOLDER, NAME = "losses", "loss"


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """The tree with `quality` in another folder and under another name, which the other tables import it by."""
    folder = tmp_path_factory.mktemp("copy")
    tables = a_copy_of_the_rooms(folder) / "bench" / "tables"
    (tables / "quality").rename(tables / FOLDER)
    for path in tables.rglob("*.py"):
        path.write_text(re.sub(r"(from \.+)quality\b", rf"\1{FOLDER}", path.read_text()))
    for path, old, new in (
        (tables / "registry.py", '"quality",', f'"{FOLDER}",'),
        (tables / FOLDER / "table.py", 'name="quality"', f'name="{NAME}"'),
    ):
        text = path.read_text()
        assert text.count(old) == 1
        path.write_text(text.replace(old, new))
    # The head of a code says what that table measures.
    head = tables.parent / "door" / "code_figures.py"
    head.write_text(head.read_text().replace("from ..tables.quality", f"from ..tables.{FOLDER}"))
    return folder


@pytest.mark.usefixtures("gl")
def test_a_run_and_its_page_know_no_table_by_its_name(copy):
    """The page has the sentence, the charts and the maps of the table; a gate that names no table means it."""
    words = ("--encoding", "octahedral", "--storage", "rgba8", "--count", "2000")
    done = normalbench_in(copy, "run", "--tables", NAME, *words, "-o", "run")
    assert done.returncode == 0, done.stderr
    assert normalbench_in(copy, "report", "run", "-o", "page.html").returncode == 0
    page = (copy / "page.html").read_text()
    assert f'<section id="{NAME}"' in page and "JAX and GLSL agree within" in page and "octahedral" in page
    assert "its rows keep no histograms" not in page and "it keeps no maps" not in page
    (copy / "gates.toml").write_text('[[gate]]\nencoding = "octahedral"\npsnr_db = "at least 30"\n')
    done = normalbench_in(copy, "check", "gates.toml", "--run", "run", "--format", "json")
    assert done.returncode == 0 and f'"table": "{NAME}"' in done.stdout, done.stderr
