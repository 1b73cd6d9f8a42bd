"""Layout files that name users' encoders: measurement, changes and one-line errors."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from typed import layouts_named

from normalbench.bench.run.measuring import companions, files_of
from normalbench.bench.subjects.codecs.layout_names import files_of_layout
from normalbench.bench.tables.render.table import RenderOptions
from normalbench.encodings.catalogue import ENCODINGS

pytestmark = pytest.mark.usefixtures("gl")


OWN = Path(__file__).parents[4] / "docs" / "your-layout.md"


LAYOUT, *_ = re.findall(r"```toml\n(.*?)```", OWN.read_text(), re.S)


THREE_NUMBERS = """
encoding = "best_fit:table=scales.npy"
targets = [{ format = "rgba8", holds = "normal.x normal.y normal.z power" }]
"""


OCTAHEDRAL = """
#include "wrap.glsl"
vec2 mine_encode(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    return n.z >= 0.0 ? n.xy : wrap(n.xy);
}
vec3 mine_decode(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    return normalize(vec3(n.z >= 0.0 ? n.xy : wrap(n.xy), n.z));
}
"""


WRAP = "vec2 wrap(vec2 v) { return (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }\n"


def written(folder: Path, encoding: str, name: str = "own.toml") -> str:
    """Write a layout to a folder, with an encoder and its include below it, and return the layout's path."""
    (folder / "code").mkdir(parents=True, exist_ok=True)
    (folder / "code" / "mine.glsl").write_text(OCTAHEDRAL)
    (folder / "code" / "wrap.glsl").write_text(WRAP)
    (folder / name).write_text(LAYOUT.replace('"octahedral"', json.dumps(encoding)))
    return str(folder / name)


def test_a_layout_accepts_a_tuned_table(tmp_path):
    path, encoding = tmp_path / "own.toml", ENCODINGS["best_fit"]
    path.write_text(THREE_NUMBERS)
    np.save(tmp_path / "scales.npy", encoding.tables()[encoding.look_up.sampler])
    (layout,) = layouts_named(str(path))
    assert layout.encoding.name == "best_fit:table=scales.npy"
    assert companions(path) == [tmp_path / "scales.npy"]


@pytest.mark.parametrize("name", ["mine.glsl", "wrap.glsl", "mine.py"])
def test_rows_of_a_changed_encoder_are_not_reused(tmp_path, name):
    """The encoder's file, its includes and its twin count like the layout's own file."""
    options = RenderOptions(layout=written(tmp_path, "code/mine.glsl"))
    before = files_of(options)
    with (tmp_path / "code" / name).open("a") as file:
        file.write("\n")
    assert len(before["files"]) == 1 and files_of(options) != before


@pytest.mark.parametrize(
    "encoding, said",
    [
        ("cubemap", "own.toml: unknown encoding 'cubemap'; known: "),
        ("octahedral,xyz", "own.toml: unknown encoding 'octahedral,xyz'"),
        ("all", "own.toml: encoding 'all': a layout has one encoding"),
        ("code/none.glsl", "none.glsl: there is no such file"),
        ("code/bad.glsl", "own.toml: {0}/code/bad.glsl: no function vec2"),
        ("code/mine.metal", "Metal is not supported"),
        ("code/../../mine.glsl", "code/../../mine.glsl is not in the layout's folder or below it; copy it"),
        ("/tmp/mine.glsl", "/tmp/mine.glsl is not in the layout's folder"),
        ("best_fit:table=../scales.npy", "../scales.npy is not in the layout's folder"),
        ("best_fit:table=a\0", "a\\x00: no file can have this name"),
        ("octahedral:axis=w", "axis is x, y or z, not 'w'"),
    ],
)
def test_invalid_encoding_in_a_layout_is_a_one_line_error(run, tmp_path, encoding, said):
    path = written(tmp_path, encoding)
    (tmp_path / "code" / "bad.glsl").write_text("float f() { return 1.0; }\n")
    status, out, err = run("render", "--layout", path, "--size", "96x64")
    assert (status, out) == (2, "") and err.count("\n") == 1 and said.format(tmp_path) in err, err


def test_link_to_an_encoding_outside_the_layouts_folder_is_refused(run, tmp_path):
    """Includes follow the same rule; a link within the folder is accepted."""
    path, mine = Path(written(tmp_path / "inside", "code/link.glsl")), tmp_path / "inside/code/mine.glsl"
    link = mine.with_name("link.glsl")
    link.symlink_to("mine.glsl")
    assert files_of_layout(path) == [link]
    mine.rename(tmp_path / "mine.glsl")
    link.unlink()
    link.symlink_to(tmp_path / "mine.glsl")
    status, out, err = run("render", "--layout", str(path), "--size", "96x64")
    assert (status, out) == (2, "") and err.count("\n") == 1, err
    assert "code/link.glsl is not in the layout's folder" in err
