"""Slips in what users type: each is understood, or is a one-line error with exit status 2 that suggests a fix."""

import json
import sys
from dataclasses import fields
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

from normalbench.bench.door.cli.app import COMMANDS, _is_delicate, _words, command_line
from normalbench.bench.door.table_command import _why_nothing
from normalbench.bench.ground.options.counts import whole_number
from normalbench.bench.tables.registry import TABLES

ROW = ("quality", "--storage", "rg8", "--normals", "sphere", "--backend", "jax", "--count", "1000")


ONE = (*ROW, "--encoding", "octahedral")


# The words, and what the line must say.
SLIPS: dict[str, tuple[tuple[str, ...], str]] = {
    "a command that is not": (("qualty",), "No such command 'qualty'. Did you mean 'quality'?"),
    "an option that is not": ((*ONE, "--storages", "rg8"), "--storages"),
    "an option without a value": ((*ONE, "--seed"), "--seed"),
    "another encoding's spelling": ((*ROW, "--encoding", "octaedral"), "did you mean octahedral?"),
    "a storage misspelt": (("quality", "--storage", "rbg8"), "did you mean rg8?"),
    "spaces for commas": (
        (*ROW, "--encoding", "xy octahedral"),
        "separate names by commas: xy,octahedral",
    ),
    "a semicolon for a comma": ((*ROW, "--encoding", "octahedral;xy"), "separate names by commas: octahedral,xy"),
    "names after each other": (
        (*ROW, "--encoding", "octahedral", "spheremap"),
        "separate names by commas: --encoding octahedral,spheremap",
    ),
    "names after each other of a list": (("columns", "quality", "render"), "give one name, or several separated by"),
    "a name without its option": (
        ("quality", "octahedral"),
        "unexpected argument octahedral; did you mean --enc",
    ),
    "options before the command": (
        ("--encoding", "xy", "quality", "--count", "9"),
        "the command comes first: normalbench quality --encoding xy --count 9",
    ),
    "options without a command": (
        ("--encoding", "xy"),
        "--encoding: begin with a command: pick, budget, run,",
    ),
    "no name at all": ((*ROW, "--encoding", ""), "no encoding named"),
    "a number twice": ((*ONE, "--count", "2000"), "--count is given twice, 1000 and 2000; give it once"),
    "a file twice": ((*ONE, "-o", "a.csv", "-o", "b.csv"), "-o is given twice, a.csv and b.csv"),
    "a format twice": ((*ONE, "--format", "csv", "--format", "json"), "--format is given twice, csv and json"),
    "both of a pair": ((*ONE, "--unpack", "--no-unpack"), "--unpack and --no-unpack contradict each other"),
    "a size twice": (("render", "--size", "64x48", "--size", "96x72"), "--size 64x48,96x72: expected WIDTHxHEIGHT"),
    "an aim twice": (("pick", "--aim", "angle", "--aim", "cost"), "one aim at a time, not angle,cost"),
    "a half": ((*ROW[:-1], "1.5"), "1.5 is not a whole number, such as 1000, 1e6, 4M or 2^22"),
    "a word for a count": ((*ROW[:-1], "many"), "many is not a whole number"),
    "a count of nothing": ((*ROW[:-1], "0"), "--count 0: out of range; use 1 to"),
    "a count beyond all": ((*ROW[:-1], "1e13"), "--count 10000000000000: out of range; use 1 to"),
    "a negative seed": ((*ONE, "--seed", "-1"), "--seed -1: out of range; use 0 to"),
    "a folder that is not there": ((*ONE, "-o", "no/x.csv"), "cannot write no/x.csv: folder no does not exist"),
    "a page in no folder": ((*ONE, "--report", "no/x.html"), "cannot write no/x.html: folder no does not exist"),
    "a page as PDF": ((*ONE, "--report", "page.pdf"), "page.pdf: the page is HTML; name it page.html"),
    "a text as a page": (
        ("report", "there", "--markdown", "-o", "x.html"),
        "x.html: --markdown writes text; name it x.md",
    ),
    "the page of a run as PDF": (("report", "there", "-o", "page.pdf"), "page.pdf: the page is HTML"),
    "a picture for a folder": (
        ("render", "--images", "x.png"),
        "x.png: --images writes into a folder; name one, such as x",
    ),
    "a file for a folder of results": (("run", "-o", "f.npy"), "f.npy: run writes into a folder; name one, such as f"),
    "a file without an ending for a folder of results": (
        ("run", "-o", "plain"),
        "plain: run writes into a folder; name one, such as plain-folder",
    ),
    "a table for a folder of results": (("run", "-o", "x.csv"), "x.csv: run writes into a folder; name one, such as x"),
    "a folder for a file": ((*ONE, "-o", "there"), "there is a folder; name a file"),
    "a format that is not": ((*ONE, "--format", "xlsx"), "Invalid value for '--format': 'xlsx' is not one of 'table'"),
    "Metal": ((*ROW, "--encoding", "mine.metal"), "mine.metal: Metal is not supported"),
    "WGSL": ((*ROW, "--encoding", "mine.wgsl"), "no encoder and decoder found; the two functions must be"),
    "one function of a file": (
        (*ROW, "--encoding", "mine.hlsl:Encode"),
        "mine.hlsl:Encode: name both functions, such as",
    ),
    "functions of GLSL": ((*ROW, "--encoding", "short.glsl:s:t"), "unknown function s; known: s_encode"),
    "a file without its ending": (
        (*ROW, "--encoding", "hlsl"),
        "unknown encoding 'hlsl'; did you mean the file hlsl.glsl?",
    ),
    "a file without its ending, of doctor": (("doctor", "hlsl"), "did you mean the file hlsl.glsl?"),
    "doctor for the catalogue": (
        ("doctor", "octahedral"),
        "octahedral is in the catalogue; doctor examines your files. Measure it with `normalbench quality --encoding ",
    ),
    # doctor asks whether a file is of another kind, in a process for each: once will do.
    "HLSL in a GLSL file": (
        ("doctor", "hlsl.glsl"),
        "float2 h_encode(float3 n, float3 v) must be vec2 (or vec3) h_encode(vec3 n, vec3 view); float2 is HLSL",
    ),
    "a code of four": (
        (*ROW, "--encoding", "four.glsl"),
        "vec4 f_encode(vec3 n, vec3 v) must be vec2 (or vec3) f_encode(vec3 n, vec3 view); a code has two or three",
    ),
    "no decode": ((*ROW, "--encoding", "short.glsl"), "no function vec3 s_decode(vec2 e, vec3 view)"),
    "a decode of another code": (
        (*ROW, "--encoding", "decode.glsl"),
        "vec3 d_decode(vec3 e) must be vec3 d_decode(vec2 e, vec3 view)",
    ),
    "a shader that is not there": ((*ROW, "--encoding", "missing.glsl"), "missing.glsl: there is no such file"),
    "a shader that is not text": ((*ROW, "--encoding", "bytes.glsl"), "bytes.glsl: it is not text in UTF-8"),
    "doctor for a text": (
        ("doctor", "words.txt"),
        "words.txt: its name does not end in .glsl, .hlsl, .hlsli, .fx, ",
    ),
    "a folder without a pair": (
        ("doctor", "folder.glsl"),
        "folder.glsl: none of its 0 shader files defines a function",
    ),
    "a capture that is not there": (("quality", "--normals", "missing.exr"), "missing.exr"),
    "a capture of another kind": (("quality", "--normals", "frame.fbx1"), "or a file ending in .exr"),
    "a JPEG": (
        ("quality", "--normals", "frame.jpg"),
        "frame.jpg: JPEG compression changes normals; save the frame as EXR or PNG",
    ),
    "an archive": (("quality", "--normals", "frame.npz"), "frame.npz: an archive of arrays; save one array as .npy"),
    "a folder of captures": (("quality", "--normals", "there"), "there: it is a folder; name files in it"),
    "two channels": (("quality", "--normals", "two.npy"), "two.npy: it has 0, 1; a normal has three channels; save z"),
    "signed bytes": (("quality", "--normals", "signed.npy"), "uint8, uint16; save array / 127 as float32"),
    "a scene that is not": (("render", "--scene", "glos"), "did you mean gloss?"),
    "a mesh of another kind": (("render", "--scene", "scene.fbx"), "or a file ending in"),
    "a layout that is not": (("render", "--layout", "unity"), "unknown layout 'unity'"),
    "a power of nothing": (("render", "--power", "0"), "--power 0: expected numbers from 1 to 2048"),
    "an exposure in words": (
        ("render", "--exposure", "bright"),
        "--exposure bright: not a number; use stops such as -1.5",
    ),
    "a size in words": (("render", "--size", "hd"), "--size hd: expected WIDTHxHEIGHT, such as 640x480"),
    "an angle of view": (("quality", "--normals", "f.npy", "--fov", "500"), "use 1 to 175"),
    "a matrix of twelve": (
        ("quality", "--normals", "f.npy", "--space", "world", "--view-matrix", "1,0,0,0,0,1,0,0,0,0,1,0"),
        "12 numbers; expected 9 or 16, row by row",
    ),
    "a space that is not": (("quality", "--normals", "f.npy", "--space", "wrld"), "did you mean world?"),
    "options of captures without one": ((*ONE, "--fov", "60"), "options for captures are given, but --normals sphere"),
    "a GPU for its family": (("pick", "--family", "rtx3080"), "rtx3080 is a GPU, not a family; use its family, sm_86"),
    "a GPU among families": (("cost", "--isa", "--family", "skl,RX480"), "use its family, polaris10"),
    "a number in words": (("roofline", "--overdraw", "two"), "'--overdraw': expected a number, such as 0.5"),
    "a number of a hundred digits": (("quality", "--count", "1e99"), "--count 100000... (100 digits): out of range"),
    "a storage with one wrong letter": (("quality", "--storage", "rg9"), "did you mean rg8?"),
    "a family that is not": (("pick", "--family", "navi99"), "unknown family 'navi99'"),
    "a backend that is not": ((*ONE[:6], "cuda"), "unknown backend 'cuda'"),
    "an option of another table": (
        ("run", "--tables", "depth", "--encoding", "xy"),
        "measure one of them with --tables",
    ),
    "a table that is not": (("run", "--tables", "qualiti"), "did you mean quality?"),
    "columns of no table": (("columns", "qualities"), "did you mean quality?"),
    "a list of nothing": (("list", "encoder"), "unknown list 'encoder'"),
    "a run that is not": (("report", "missing"), "missing"),
    "gates that are not": (("check", "missing.toml"), "missing.toml: there is no such file"),
    "gates that are not text": (("check", "bytes.toml"), "bytes.toml: it is not text in UTF-8"),
    "a plural": (("check", "plural.toml"), "unknown key 'gates'; a gates file has only [[gate]] tables"),
    "a key twice": (("check", "twice.toml"), "twice.toml: line 3, column 18: a key or a table is given twice"),
    "TOML that is cut off": (("check", "cut.toml"), "cut.toml: its end: this is not TOML"),
    "a layout that is not there": (("render", "--layout", "missing.toml"), "missing.toml: there is no such file"),
    "a layout that is not TOML": (("render", "--layout", "twice.toml"), "a key or a table is given twice"),
    "a table of scales that is not there": (
        ("quality", "--encoding", "best_fit:table=missing.npy"),
        "missing.npy: there is no such file",
    ),
    "a matrix that is not there": (
        ("quality", "--normals", "f.npy", "--space", "world", "--view-matrix", "no.txt"),
        "--view-matrix no.txt: neither numbers nor a text file of numbers: there is no such file",
    ),
    "a matrix that is not text": (
        ("quality", "--normals", "f.npy", "--space", "world", "--view-matrix", "bytes.txt"),
        "--view-matrix bytes.txt: neither numbers nor a text file of numbers: it is not text in UTF-8",
    ),
    "Parquet, which is not written": ((*ONE, "-o", "x.parquet"), "use x.csv or .json"),
    "a plot of another kind": (("sweep", "--plot", "x.gif"), "x.gif"),
}


HLSL = "float2 mine_encode(float3 n, float3 v);"


FILES = {
    **dict.fromkeys(("mine.metal", "mine.wgsl"), HLSL),
    **dict.fromkeys(("bytes.glsl", "bytes.toml", "bytes.txt"), b"\xff\xfe\x00abc"),
    "hlsl.glsl": "float2 h_encode(float3 n, float3 v) { return n.xy; }",
    "words.txt": "the uniform frames",
    "four.glsl": "vec4 f_encode(vec3 n, vec3 v) { return vec4(n, 1.0); }",
    "short.glsl": "vec2 s_encode(vec3 n) { return n.xy; }",
    "decode.glsl": "vec2 d_encode(vec3 n, vec3 view) { return n.xy; } vec3 d_decode(vec3 e) { return e; }",
    "twice.toml": '[[gate]]\nencoding = "xy"\nencoding = "cube"\n',
    "plural.toml": "[[gates]]\n",
    "cut.toml": "gate = [",
}


def write_files() -> None:
    """Write FILES, two folders and a list of normals to the working folder."""
    for name in ("there", "folder.glsl"):
        Path(name).mkdir()
    for name, text in FILES.items():
        Path(name).write_bytes(text if isinstance(text, bytes) else text.encode())
    np.save("f.npy", np.eye(3, dtype=np.float32))
    Path("plain").touch()
    np.save("two.npy", np.zeros((4, 4, 2), np.float32))
    np.save("signed.npy", np.full((4, 4, 3), 73, np.int8))


@pytest.mark.parametrize("what", SLIPS)
def test_a_slip_is_a_one_line_error_that_suggests_a_fix(run, tmp_path, monkeypatch, what):
    monkeypatch.chdir(tmp_path)
    write_files()
    before = set(tmp_path.rglob("*"))
    words, message = SLIPS[what]
    status, out, err = run(*words)
    assert (status, out) == (2, ""), (status, out[:100], err)
    assert err.startswith("normalbench: ") and err.count("\n") == 1 and message in err, err
    assert not any(word in err for word in ("[Errno", "Traceback", "Error:", "codec")), err
    assert set(tmp_path.rglob("*")) == before, "something was left behind"


@pytest.mark.parametrize("option", ["-o", "--report"])
@pytest.mark.parametrize("name", ["frame.npy", "mine.glsl", "mine.py"])
def test_measured_files_are_not_overwritten(run, tmp_path, option, name):
    for each in ("mine.glsl", "mine.py"):
        (tmp_path / each).write_text("// an encoder")
    np.save(tmp_path / "frame.npy", np.eye(3, dtype=np.float32))
    before = (tmp_path / name).read_bytes()
    words = ("--normals", str(tmp_path / "frame.npy"), "--encoding", f"{tmp_path / 'mine.glsl'},xy")
    status, out, err = run("quality", *words, option, str(tmp_path / name))
    assert (status, out, err.count("\n")) == (2, "", 1) and f"{name}: this is an input of the command" in err
    assert (tmp_path / name).read_bytes() == before


def test_an_empty_plot_states_the_reason():
    """The reason comes from the row. If the row has no reason, there are too few figures."""
    table = TABLES["budget"]
    few = f"too few figures for a chart in 1 row; for example, run: {table.example}"
    assert _why_nothing(table, [{"layout": "mine", "skipped": None}]) == few
    assert _why_nothing(table, [{"layout": "mine", "skipped": "it has no normals"}]) == "it has no normals"


def test_at_least_forty_slips_are_covered():
    assert len(SLIPS) >= 40


def test_count_causes_a_warning_if_only_files_are_measured(run, tmp_path):
    path = str(tmp_path / "f.npy")
    np.save(path, np.eye(3, dtype=np.float32))
    told = f"normalbench: --count has no effect on files: every normal of {path} is measured\n"
    for names, message in ((path, told), (f"{path},sphere", "")):
        words = ("--encoding", "octahedral", "--backend", "jax", "--count", "1000", "--normals", names)
        assert run("quality", "--storage", "rg8", *words)[::2] == (0, message)


def rows_of(run, *words: str) -> list[dict]:
    status, out, err = run(*words, "--format", "json")
    assert status == 0, err
    return json.loads(out)


def test_names_in_a_repeated_option_are_combined(run):
    rows = rows_of(run, *ROW, "--encoding", "octahedral", "--encoding=xyz_renormalised,spheremap", "--storage", "rgba8")
    assert {(row["encoding"], row["storage"]) for row in rows} == {
        ("octahedral", "rg8"),
        ("spheremap", "rg8"),
        *((name, "rgba8") for name in ("octahedral", "xyz_renormalised", "spheremap")),
    }


@pytest.mark.parametrize(
    "text, number",
    [
        ("1000", 1000),
        ("1e6", 10**6),
        ("2.5e3", 2500),
        ("4M", 4_000_000),
        ("64k", 64_000),
        ("1G", 10**9),
        ("2^22", 2**22),
        ("2**10", 1024),
        ("1_000", 1000),
        (" 7 ", 7),
        ("-3", -3),
    ],
)
def test_counts_are_read_in_common_notations(run, text, number):
    assert whole_number(text) == number
    if number in (2500, 1024):
        assert rows_of(run, *ROW[:-1], text, "--encoding", "xy")[0]["count"] == number


@pytest.mark.parametrize("text", ["", "1.5", "1e-3", "4Mi", "0x10", "2^", "1e999", "nan", "inf", "1 000", "٣٣x"])
def test_text_that_is_not_a_count_is_refused(text):
    with pytest.raises(ValueError, match="is not a whole number"):
        whole_number(text)


VERDICT = "Most accurate on sphere, by mean error: octahedral in rg8 at 16 bits (0.33°)."


@pytest.mark.parametrize(
    "ending, begins", [("csv", "encoding,"), ("json", "[\n"), ("md", VERDICT + "\n\n| "), ("txt", VERDICT + "\n\n   ")]
)
def test_the_file_extension_chooses_the_format(run, tmp_path, ending, begins):
    path = tmp_path / f"rows.{ending.upper()}"
    assert run(*ONE, "-o", str(path))[0] == 0
    assert path.read_text().startswith(begins), path.read_text()[:60]
    assert run(*ONE, "-o", str(path), "--format", "csv")[0] == 0
    assert path.read_text().startswith("encoding,"), "what is asked for goes before the name"


def test_csv_has_no_histogram_and_json_has_one_as_a_list(run):
    _, out, _ = run(*ONE, "--format", "csv")
    assert "angle_counts" not in out and max(map(len, out.splitlines())) < 1000
    (row,) = rows_of(run, *ONE)
    assert sum(count for _, count in row["angle_counts"]) == row["count"] == 1000
    edges = [edge for edge, _ in row["angle_counts"]]
    assert edges == sorted(edges) and edges[-1] <= row["angle_max_deg"]


def test_version_and_short_help_are_printed(run):
    assert run("--version")[:2] == (0, f"{version('normalbench')}\n")
    status, out, _ = run("-h")
    assert status == 0 and "quality" in out


@pytest.mark.parametrize(
    "name",
    [
        *TABLES,
        *("run", "check", "compare", "report", "list", "doctor", "columns", "import", "site", "history", "renderdoc"),
    ],
)
def test_help_fits_80_columns_and_groups_its_options(run, monkeypatch, name):
    monkeypatch.setenv("COLUMNS", "80")
    status, out, _ = run(name, "-h")
    assert status == 0 and max(map(len, out.splitlines())) <= 80
    if name in TABLES:
        assert "Measurement:" in out and "Also: --output" in out
        assert "<table|json" not in out, "a list of choices leaves no room for the words"
    assert f"Example: normalbench {name}" in out
    if name == "check":
        assert "[[gate]]" in out


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("name", TABLES)
def test_the_example_of_a_table_command_is_valid(name):
    """The options are valid, and so are the names in them, which are not checked in examples with captured files."""
    table, program = TABLES[name], command_line()
    words = _words(TABLES[name].example.split()[1:], program)
    command = program.commands[name]
    index = words.index(name)
    context = command.make_context(name, words[index + 1 :])
    asked = {field.name: context.params[field.name] for field in fields(table.options) if field.name in context.params}
    if not {"frame.png", "phone.json"} & set(words):
        assert table.work.steps(table.options(**asked), table.outputs())


@pytest.mark.parametrize("name", sorted(set(COMMANDS) - set(TABLES)))
def test_the_example_of_another_command_is_valid(name):
    program = command_line()
    words = _words((program.commands[name].epilog or "").removeprefix("Example: normalbench ").split(), program)
    assert program.commands[name].make_context(name, words[words.index(name) + 1 :])


@pytest.mark.parametrize("what", ["all", "storages", "layouts"])
def test_a_list_fits_the_terminal_with_a_table_for_each_kind(run, monkeypatch, what):
    monkeypatch.setenv("COLUMNS", "80")
    status, out, _ = run("list", what)
    assert status == 0 and max(map(len, out.splitlines())) <= 80
    assert out.count("name ") >= {"all": 12, "storages": 1, "layouts": 1}[what]
    # A letter between two colons is no emoji, and of a storage nothing is left out.
    assert what != "storages" or ("unorm:B:..." in out and "across channels" in out and "not shown" not in out)


@pytest.mark.parametrize(
    "file, is_delicate",
    [
        ("/venv/site-packages/moderngl/__init__.py", True),
        ("<frozen importlib._bootstrap>", True),
        ("/mine/scene.py", False),
    ],
)
def test_an_interruption_waits_for_imports_and_for_moderngl(file, is_delicate):
    """An exception that passes through C++ code ends the process without a message, with exit status -11."""
    answers = []
    namespace = {"look": lambda: answers.append(_is_delicate(sys._getframe()))}
    exec(compile("look()", file, "exec"), namespace)
    assert answers == [is_delicate]
