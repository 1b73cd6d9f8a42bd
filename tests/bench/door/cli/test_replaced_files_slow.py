"""No command overwrites a file that it reads, or a file that it could not have written."""

import pytest
import test_replaced_files
from test_replaced_files import DEPTHS, ONE

folder = test_replaced_files.folder


def test_code_does_not_replace_a_users_shader_in_its_folder(run, folder):
    path = folder / "out" / "octahedral_rgb10a2.hlsl"
    path.parent.mkdir()
    path.write_text("// Mine.\n")
    status, _, err = run("code", "octahedral", "--storage", "rgb10a2", "--to", "hlsl", "-o", "out")
    assert status == 2 and "octahedral_rgb10a2.hlsl: not a file written by normalbench" in err, err
    assert path.read_text() == "// Mine.\n"


@pytest.mark.parametrize("words", [(*ONE, "--report", "p.html"), ("renderdoc", "--script", "s.py")])
def test_a_page_and_a_script_may_be_written_twice(run, words):
    assert [run(*words)[0] for _ in range(2)] == [0, 0]


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_a_picture_replaces_a_picture(run, ending):
    assert [run(*DEPTHS, "--plot", f"p.{ending}")[0] for _ in range(2)] == [0, 0]
