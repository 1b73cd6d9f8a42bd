"""The command line: what it prints, what it writes, and what it says of bad input."""

import csv
import io
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import jax.numpy as jnp
import pytest

from normalbench.bench.subjects.codecs import user_encodings
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS, NAMES
from normalbench.encodings.codecs.encoding import Encoding
from normalbench.reports import tables

QUICK = ["quality", "--encoding", "xy,octahedral", "--storage", "rg8", "--normals", "axes"]


def in_a_process(*arguments: str, **environment: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "normalbench", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=os.environ | environment)


NO_GL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "VIRTUAL_DISPLAY": ""}


LIGHT = ("--help", "list", *(f"{name} --help" for name in ("quality", "render", "sweep", "depth", "frames", "report")))


def test_the_help_groups_commands_by_what_they_are_for(run):
    _, out, _ = run("--help")
    titles = [line.strip("╭─╮ \n") for line in out.splitlines() if line.startswith("╭")]
    assert titles == [
        "Options",
        "The answer",
        "Measure",
        "Your own",
        "Keep and compare",
        "This program and this machine",
    ]


def test_help_and_list_import_nothing_heavy():
    """JAX, pandas and matplotlib take a second each; `--help` and `list` answer without them."""
    program = (
        "import sys; from normalbench.bench.door.cli import app; given = sys.argv[1:]\n"
        "for one in given:\n"
        "    sys.argv = ['normalbench', *one.split()]; app.main()\n"
        "    heavy = {'jax', 'pandas', 'matplotlib', 'scipy', 'PIL', 'jinja2'} & set(sys.modules)\n"
        "    assert not heavy, (one, heavy)"
    )
    done = subprocess.run([sys.executable, "-c", program, *LIGHT], capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.count("Usage: ") == len(LIGHT) - 1, done.stderr[-200:]


def test_the_list_names_every_encoding(run):
    status, out, _ = run("list", "encodings")
    assert status == 0
    assert all(name in out for name in NAMES)


@pytest.mark.usefixtures("gl")
def test_json_is_a_list_of_flat_rows_with_nothing_that_json_lacks(run):
    status, out, _ = run(
        "quality", "--encoding", "xyz", "--storage", "rgba32f", "--normals", "axes", "--format", "json"
    )
    rows = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert status == 0 and [row["backend"] for row in rows] == ["jax", "glsl"]
    assert set(rows[0]) == set(TABLES["quality"].empty())
    assert all(row["psnr_db"] is None and row["exact"] is True for row in rows), "identical normals"


@pytest.mark.usefixtures("gl")
def test_the_formats_carry_the_same_figures(run):
    rows = json.loads(run(*QUICK, "--format", "json")[1])
    as_csv = list(csv.DictReader(io.StringIO(run(*QUICK, "--format", "csv")[1])))
    assert [float(r["psnr_db"]) for r in as_csv] == [r["psnr_db"] for r in rows]
    for as_text in ("table", "markdown"):
        out = run(*QUICK, "--format", as_text)[1]
        assert all(f"{row['psnr_db']:.4g}" in out for row in rows), out


def test_rows_go_to_a_file_whole(run, tmp_path):
    path = tmp_path / "new" / "rows.json"
    path.parent.mkdir()
    status, out, _ = run(*QUICK, "--backend", "jax", "--format", "json", "-o", str(path))
    assert status == 0 and out == ""
    assert len(json.loads(path.read_text())) == 2
    assert [p.name for p in path.parent.iterdir()] == ["rows.json"]


@pytest.mark.parametrize("width", [60, 80, 120, 200])
def test_a_narrow_terminal_breaks_no_number(run, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", str(width))
    rows = json.loads(run(*QUICK, "--backend", "jax", "--format", "json")[1])
    out = run(*QUICK, "--backend", "jax")[1]
    assert all(len(line) <= width for line in out.splitlines()), out
    assert all(f"{row['angle_max_deg']:.4g}" in out and f"{row['psnr_db']:.4g}" in out for row in rows), out


BAD = {
    "an encoding": (["quality", "--encoding", "octahedron"], ["'octahedron'", "octahedral", "spheremap"]),
    "a storage": (["quality", "--storage", "rgba9"], ["'rgba9'", "rgba8", "rg16f"]),
    "a set": (["quality", "--normals", "moon"], ["'moon'", "playground", "sphere"]),
    "a back end": (["quality", "--backend", "vulkan"], ["'vulkan'", "jax", "glsl"]),
    "a rounding": (["quality", "--rounding", "up"], ["'up'", "nearest", "truncate"]),
    "a list": (["list", "cars"], ["'cars'", "encodings", "storages"]),
    "no name": (["quality", "--encoding", ","], ["no encoding named", "octahedral"]),
    "nothing to tune": (["tune", "nope"], ["'nope'; known: xyz", "octahedral"]),
    "all to tune": (["tune", "all"], ["one encoding at a time"]),
    "no normals": (["quality", "--count", "0"], ["--count 0", "1099511627776"]),
    "negative count": (["quality", "--count", "-5"], ["--count -5"]),
    "too many": (["quality", "--count", "9999999999999"], ["9999999999999", "1099511627776"]),
    "not a count": (["quality", "--count", "many"], ["--count"]),
    "a negative seed": (["quality", "--seed", "-1"], ["--seed -1"]),
    "a seed beyond 64 bits": (["quality", "--seed", str(2**63)], [f"--seed {2**63}", "from 0 to"]),
    "no room": (["quality", "--encoding", "xyz", "--storage", "rg8"], ["xyz/rg8", "3 components", "2 channels"]),
    "a format": (["quality", "--format", "xml"], ["xml", "markdown"]),
    "an option": (["quality", "--colour"], ["--colour"]),
    "a command": (["mesure"], ["mesure", "quality"]),
    "no folder": ([*QUICK, "-o", "/proc/nowhere/rows.csv"], ["/proc/nowhere"]),
    "a folder": ([*QUICK, "-o", "/"], ["is a folder"]),
    "pictures nowhere": ([*QUICK, "--images", "/proc/nowhere"], ["/proc/nowhere"]),
    "no image": ([*QUICK, "--images", "somewhere"], ["--images", "playground"]),
    "run nowhere": (["run", "-o", "/proc/nowhere/results"], ["/proc/nowhere"]),
    "run onto": (["run", "-o", "/usr"], ["/usr exists already"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_one_line_that_says_what_would_be_right(run, what, tmp_path, monkeypatch):
    arguments, said = BAD[what]
    monkeypatch.chdir(tmp_path)
    status, out, err = run(*arguments)
    assert status == 2 and out == ""
    assert err.startswith("normalbench: ") and err.count("\n") == 1, err
    assert all(part in err for part in said), err
    assert not list(tmp_path.iterdir()), "something was left behind"


def test_a_file_that_fails_keeps_the_old_one(run, tmp_path, monkeypatch):
    path = tmp_path / "rows.csv"
    path.write_text("encoding,storage\nprecious,rg8\n")
    before = path.read_text()
    monkeypatch.setattr(
        tables, "written", lambda *_, **__: (_ for _ in ()).throw(OSError(28, "No space left on device"))
    )
    status, _, err = run(*QUICK, "--backend", "jax", "--format", "csv", "-o", str(path))
    assert status == 2 and "No space left" in err
    assert {p.name for p in tmp_path.iterdir()} == {"rows.csv", ".rows.csv.rows"} and path.read_text() == before


def test_a_link_is_written_through_and_a_pipe_stays_a_pipe(run, tmp_path):
    """What is not a plain file keeps its nature: the target of a link is replaced, a pipe is written to."""
    target, link, pipe = tmp_path / "target.csv", tmp_path / "link.csv", tmp_path / "pipe"
    target.write_text("kind,name\nold,old\n")
    link.symlink_to(target)
    assert run("list", "--format", "csv", "-o", str(link))[0] == 0
    assert link.is_symlink() and "octahedral" in target.read_text()
    os.mkfifo(pipe)
    reader = subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE, text=True)
    assert run("list", "--format", "csv", "-o", str(pipe))[0] == 0
    assert "octahedral" in reader.communicate(timeout=30)[0]
    assert pipe.is_fifo()


@pytest.mark.parametrize("output", ["-o a.json", "-o a.json/below.json", "--plot a.png", "--report a.html"])
def test_links_that_go_round_are_one_line(run, tmp_path, monkeypatch, output):
    monkeypatch.chdir(tmp_path)
    option, name = output.split()
    for one, other in (("a", "b"), ("b", "a")):
        for suffix in (".json", ".png", ".html"):
            Path(one + suffix).symlink_to(other + suffix)
    status, out, err = run("depth", option, name)
    why = "links lead back to themselves; name another file"
    assert (status, out, err) == (2, "", f"normalbench: cannot write to {name}: {why}\n")


@pytest.mark.parametrize("target", ["nowhere", "link"], ids=["to nothing", "to itself"])
@pytest.mark.parametrize("output", ["link", "link/below"])
def test_a_link_that_leads_to_no_folder_is_one_line(run, tmp_path, monkeypatch, target, output):
    monkeypatch.chdir(tmp_path)
    Path("link").symlink_to(target)
    status, out, err = run("run", "--tables", "depth", "-o", output)
    why = f"link is a link to {target}, where there is nothing; mend the link, or name another folder"
    assert (status, out, err) == (2, "", f"normalbench: cannot write to {output}: {why}\n")
    assert [path.name for path in tmp_path.iterdir()] == ["link"]


def test_output_that_cannot_be_written_is_one_line():
    if not Path("/dev/full").is_char_device():
        pytest.skip("no /dev/full here")
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "normalbench", "list"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2 and done.stderr == "normalbench: cannot write: No space left on device\n"


def test_a_reader_that_has_seen_enough_is_no_error():
    command = f"{sys.executable} -m normalbench list | true; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == ""


def test_no_command_is_help_and_no_error(run):
    status, out, err = run()
    assert status == 0 and "quality" in out and err == ""


def measured_instead(monkeypatch, encoding: Encoding) -> None:
    """From here on the encoding's name stands for it on the command line."""
    monkeypatch.setattr(user_encodings, "ENCODINGS", {**ENCODINGS, encoding.name: encoding})


def test_a_users_broken_encoding_is_one_line_with_its_file(run, monkeypatch):
    """A Python half that raises or has another size; a GLSL half that does not compile loses its own rows only."""

    def raises(*_):
        raise ValueError("what is this?")

    original = ENCODINGS["xy"]
    for changed, said in (
        ({"encode": raises}, ["xy.py", "ValueError", "what is this?"]),
        ({"components": 3}, ["xy.py", "encode gives 2 numbers"]),
    ):
        measured_instead(monkeypatch, replace(original, **changed))
        status, _, err = run("quality", "--encoding", "xy", "--normals", "axes")
        assert status == 2 and err.count("\n") == 1 and all(part in err for part in said), err


@pytest.mark.usefixtures("gl")
def test_a_users_broken_shader_loses_its_own_rows_and_is_an_error_alone(run, monkeypatch, tmp_path):
    broken = tmp_path / "xy.glsl"
    broken.write_text(ENCODINGS["xy"].glsl.read_text().replace("n.xy", "n.xq"))
    measured_instead(monkeypatch, replace(ENCODINGS["xy"], glsl=broken))
    arguments = ["quality", "--encoding", "xy,octahedral", "--normals", "axes", "--format", "json"]
    status, out, err = run(*arguments)
    rows = {(row["encoding"], row["backend"]): row for row in json.loads(out)}
    assert status == 0 and "xy.glsl:3" in err
    assert rows["xy", "glsl"]["psnr_db"] is None and "xy.glsl:3" in rows["xy", "glsl"]["skipped"]
    assert rows["xy", "jax"]["psnr_db"] and rows["octahedral", "glsl"]["psnr_db"]
    status, out, err = run("quality", "--encoding", "xy", "--normals", "axes", "--backend", "glsl")
    assert status == 2 and out == "" and err.count("\n") == 1 and "xy.glsl:3" in err


def test_decodes_that_are_no_number_are_counted_and_said(run, monkeypatch):
    original = ENCODINGS["xy"]

    def decode(e, view):
        n = original.decode(e, view)
        return n._replace(x=jnp.where(e.x > 0.9, jnp.nan, n.x))

    measured_instead(monkeypatch, replace(original, decode=decode))
    status, out, err = run("quality", "--encoding", "xy", "--normals", "axes", "--backend", "jax", "--format", "json")
    assert status == 0 and json.loads(out)[0]["invalid"] == 64, "one axis of six, 64 directions around it"
    assert err == "normalbench: xy rgba8 nearest axes jax: 64 results are NaN or infinite\n"


def test_what_does_not_fit_is_named_and_the_rest_measured(run):
    status, out, err = run(
        "quality", "--encoding", "xyz,xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax"
    )
    assert status == 0 and "xyz/rg8" in err and "xy" in out


def test_glsl_alone_without_a_gl_driver_exits_3_and_says_what_to_install():
    done = in_a_process(*QUICK, "--backend", "glsl", **NO_GL)
    assert done.returncode == 3 and done.stdout == ""
    assert done.stderr.count("\n") == 1 and "apt-get install libegl1" in done.stderr


def test_doctor_says_what_this_machine_has(run):
    status, out, _ = run("doctor", "--format", "json")
    facts = {row["name"]: row["value"] for row in json.loads(out)}
    assert status == 0
    assert {"python", "jax", "processor", "GL"} <= set(facts)
    if "GL version" in facts:
        assert facts["GL rounds rgba8"] == "nearest"
