"""No command overwrites a file that it reads, or a file that it could not have written."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from normalbench.bench.door.cli.app import command_line
from normalbench.bench.door.cli.inputs import keep_inputs
from normalbench.bench.door.cli.typed import _takes
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.output.replacing import reads
from normalbench.bench.ground.output.writing import whole_file
from normalbench.bench.keep.row_files import check_rows
from normalbench.bench.tables.registry import TABLES
from normalbench.reports.charts import motion, pictures

SHADER = """vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }
vec3 mine_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }
"""


ROW = ("quality", "--storage", "rg8", "--normals", "sphere", "--backend", "jax", "--count", "1000")


ONE = (*ROW, "--encoding", "octahedral")


LAYOUT = 'title = "mine"\nencoding = "octahedral"\ntargets = [{ format = "rg8", holds = "normal.x normal.y" }]\n'


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with a user's files, in which commands run."""
    monkeypatch.chdir(tmp_path)
    Path("mine.glsl").write_text(SHADER)
    Path("other.glsl").write_text("// Another encoder.\n" + SHADER)
    Path("prelude.glsl").write_text("#define MINE\n")
    Path("hard.glsl").hardlink_to("mine.glsl")
    Path("link.csv").symlink_to("mine.glsl")
    Path("gates.toml").write_text("[[gate]]\nencoding = 'octahedral'\nstorage = 'rg8'\nangle_max_deg = 'at most 90'\n")
    Path("layout.toml").write_text(LAYOUT)
    Path("notes.csv").write_text("name,value\nkeep,this\n")
    Path("points.csv").write_text("x,y,z\n0,0,1\n")
    Path("notes.md").write_text("# Notes\n\n| encoding | storage | bits |\n|--|--|--|\n| mine | rg8 | 16 |\n")
    Path("notes.txt").write_text("Keep this.\n")
    Path("notes.json").write_text('[{"mine": 1}]\n')
    Path("page.html").write_text("<!doctype html>\n<title>mine</title>\n")
    Path("frame.rdc").write_bytes(b"RDOC\0\0\1")
    Path("vectors.svg").write_text("<svg/>\n")
    Path("mine.pdf").write_bytes(b"%PDF-1.4\n")
    Image.fromarray(np.zeros((4, 4, 3), np.uint8)).save("photo.png")
    np.save("normals.npy", np.eye(3, dtype=np.float32))
    return tmp_path


# The words, and the file that must stay.
INPUTS = {
    "rows over an encoder": ((*ROW, "--encoding", "mine.glsl", "-o", "mine.glsl"), "mine.glsl"),
    "rows over a hard link of an encoder": ((*ROW, "--encoding", "mine.glsl", "-o", "hard.glsl"), "hard.glsl"),
    "rows over a link to an encoder": ((*ROW, "--encoding", "mine.glsl", "-o", "link.csv"), "link.csv"),
    "a page over an encoder": ((*ROW, "--encoding", "mine.glsl,xy", "--report", "mine.glsl"), "mine.glsl"),
    "rows over a prelude": (
        (*ROW, "--encoding", "mine.glsl", "--prelude", "prelude.glsl", "-o", "prelude.glsl"),
        "prelude.glsl",
    ),
    "rows over normals": (("quality", "--normals", "normals.npy", "-o", "normals.npy"), "normals.npy"),
    "a look-up over normals": (
        ("tune", "best_fit", "--normals", "normals.npy", "--table", "normals.npy"),
        "normals.npy",
    ),
    "findings over what is examined": (("doctor", "mine.glsl", "-o", "mine.glsl"), "mine.glsl"),
    "results over gates": (("check", "gates.toml", "-o", "gates.toml"), "gates.toml"),
    "results over a layout": (("code", "layout.toml", "--to", "c", "--check", "-o", "layout.toml"), "layout.toml"),
}


@pytest.mark.parametrize("case", INPUTS)
def test_a_file_that_a_command_reads_is_not_replaced(run, folder, case):
    words, name = INPUTS[case]
    before = (folder / name).read_bytes()
    status, out, err = run(*words)
    assert (status, out, err) == (2, "", f"normalbench: {name}: this is an input of the command; name another file\n")
    assert (folder / name).read_bytes() == before


# The words, less the last, which is the file; and what the command would have written.
OTHERS = {
    "rows over notes": (("list", "-o", "notes.csv"), "table"),
    "measured rows over notes": ((*ONE, "-o", "notes.csv"), "table"),
    "rows over points": ((*ONE, "-o", "points.csv"), "table"),
    "rows over notes with a table": ((*ONE, "-o", "notes.md"), "table"),
    "rows over a text": (("columns", "quality", "-o", "notes.txt"), "table"),
    "rows over other rows": ((*ONE, "-o", "notes.json"), "table"),
    "rows over a shader": ((*ONE, "-o", "other.glsl"), "table"),
    "results over a text": (("check", "gates.toml", "-o", "notes.txt"), "table"),
    "findings over a text": (("doctor", "mine.glsl", "-o", "notes.txt"), "table"),
    "a page over a page": ((*ONE, "--report", "page.html"), "page"),
    "a page over a shader": ((*ONE, "--report", "other.glsl"), "page"),
    "a plot over a picture": (("depth", "--plot", "photo.png"), "picture"),
    "a plot over vectors": (("depth", "--plot", "vectors.svg"), "picture"),
    "a plot over a document": (("doctor", "mine.glsl", "--plot", "mine.pdf"), "picture"),
    "a look-up over a text": (("tune", "best_fit", "--table", "notes.txt"), "NumPy array"),
    "a script over a capture": (("renderdoc", "--script", "frame.rdc"), "file"),
    "a script over a shader": (("renderdoc", "--script", "other.glsl"), "file"),
}


@pytest.mark.parametrize("case", OTHERS)
def test_a_file_of_another_kind_is_not_replaced(run, folder, case):
    words, what = OTHERS[case]
    before = (folder / words[-1]).read_bytes()
    status, out, err = run(*words)
    assert (status, out, err.count("\n")) == (2, "", 1), (status, out[:100], err)
    assert err.endswith(f"{words[-1]}: not a {what} written by normalbench; name another file, or delete this one\n")
    assert (folder / words[-1]).read_bytes() == before


@pytest.mark.parametrize("is_run", [True, False])
def test_an_input_in_a_folder_is_not_replaced(folder, is_run):
    """In the folder of a run every other file may be replaced."""
    if is_run:
        (folder / "run.json").write_text("{}")
    keep_inputs(["--encoding", "other.glsl,mine.glsl"], command_line().commands["quality"].params)
    with (
        pytest.raises(UsageError, match="this is an input of the command"),
        whole_file(folder / "mine.glsl") as partial,
    ):
        partial.write_text(SHADER.splitlines()[0] + "\n")
    assert (folder / "mine.glsl").read_text() == SHADER
    reads.clear()


AGAIN = {
    "list": ("list", "-o"),
    "columns": ("columns", "quality,pick", "-o"),
    "machine": ("doctor", "-o"),
    "findings": ("doctor", "mine.glsl", "-o"),
    "rows": (*ONE, "-o"),
    "gates": ("check", "gates.toml", "-o"),
}


ENDINGS = ("csv", "json", "md", "txt")


# By day: a list in every format, and every other command in some.
BY_DAY = (
    *(("list", ending) for ending in ENDINGS),
    *(("columns", "csv"), ("machine", "csv"), ("findings", "txt"), ("findings", "md")),
    *(("rows", "csv"), ("rows", "txt"), ("gates", "md")),
)


@pytest.mark.parametrize("case, ending", BY_DAY)
def test_rows_replace_earlier_rows_of_the_same_command(run, case, ending):
    for _ in range(2):
        status, _, err = run(*AGAIN[case], f"rows.{ending}")
        assert (status, err) == (0, ""), err


DEPTHS = ("depth", "--storage", "depth16", "--depth", "linear", "--backend", "jax", "--count", "100")


def test_a_picture_replaces_a_picture_of_another_command(run):
    doctor = ("doctor", "mine.glsl")
    assert [run(*words, "--plot", "p.png")[0] for words in (DEPTHS, doctor, DEPTHS)] == [0, 0, 0]


def test_pictures_name_the_program(run, folder):
    pixels = np.zeros((4, 4, 3), np.uint8)
    run("doctor", "mine.glsl", "--plot", "plot.png")
    pictures.write_png(folder / "still.png", pixels)
    motion.write_animation(folder / "moving.png", [Image.fromarray(pixels), Image.fromarray(pixels + 1)])
    for name in ("plot", "still", "moving"):
        with Image.open(f"{name}.png") as image:
            assert image.info.get("Software") == "normalbench", f"{name}: {image.info}"


def test_an_empty_file_is_replaced(run, folder):
    (folder / "empty").touch()
    assert run("list", "-o", "empty", "--format", "csv")[0] == 0 and "octahedral" in (folder / "empty").read_text()


@pytest.mark.parametrize("table", TABLES.values(), ids=lambda table: table.name)
def test_every_table_recognises_its_own_header(tmp_path, table):
    names = list(table.empty(("a",)))
    for number, text in enumerate((",".join(names), json.dumps([dict.fromkeys(names)]), "  ".join(names))):
        (tmp_path / f"{number}").write_text(f"{text}\n")
        check_rows(tmp_path / f"{number}")


# By command what its options that take a path write; `--run` is a folder, which nothing replaces.
WRITTEN = {
    *("--output", "--report", "--plot", "--images", "--live", "--maps", "--disassembly", "--layouts", "--table"),
    *("--script", "--run", "--diff"),
}


def test_options_that_take_a_path_are_outputs():
    """The check treats every other value, an argument or a text, as an input."""
    program = command_line()
    every = [*program.params, *(option for command in program.commands.values() for option in command.params)]
    options = [option for option in every if option.param_type_name == "option"]
    assert {max(option.opts, key=len) for option in options if _takes(option, Path)} == WRITTEN
