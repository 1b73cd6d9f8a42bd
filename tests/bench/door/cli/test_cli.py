"""The command line: its output, the files it writes, and its messages about bad input."""

import json
import os
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import jax.numpy as jnp
import pytest

from normalbench.bench.door.cli.app import command_line
from normalbench.bench.subjects.codecs import encoding_names
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS, NAMES
from normalbench.encodings.codecs.encoding import Encoding
from normalbench.reports import tables

QUICK = ["quality", "--encoding", "xy,octahedral", "--storage", "rg8", "--normals", "axes"]


def test_the_front_page_fits_a_screen_and_groups_commands_by_purpose(run):
    """`--help-all` shows the complete help, with every option that commands share."""
    _, out, _ = run("--help")
    lines = out.splitlines()
    groups = ["The answer", "Measure", "Your own", "Keep and compare", "This program and this machine"]
    assert [line.rstrip(":") for line in lines if re.fullmatch(r"\S.*:", line)] == groups
    assert len(lines) <= 40 and max(map(len, lines)) <= 80
    named = {word for line in lines for word in re.findall(r"[a-z]+", line)}
    assert {*command_line().commands} <= named
    _, out, _ = run("--help-all")
    assert all(f"--{flag}" in out for flag in ("output", "format", "report", "on", "define", "channels", "anew"))


def test_help_shows_at_most_twelve_options_at_first(run):
    """The program has at most 320 options; options that commands share belong to the program and are listed once."""
    program = command_line()
    options = [option for command in program.commands.values() for option in command.params]
    options = [option for option in (*options, *program.params) if option.param_type_name == "option"]
    assert len(options) <= 320
    for name in ("pick", "run", "doctor"):
        _, short, _ = run(name, "--help")
        _, whole, _ = run(name, "--help-all")
        heads = (text.partition("Also:")[0] for text in (short, whole))
        shown, every = (len(re.findall(r"^  (?:-\w, )?--(?!help)", head, re.M)) for head in heads)
        assert shown == min(every, 12), name
        assert f"normalbench {name} --help-all" in " ".join(short.split()) and "--output" in short


def test_a_shared_option_may_come_anywhere_and_is_refused_if_meaningless(run):
    words = ("--encoding", "xyz", "--storage", "rg16,rgba8", "--count", "4096", "--backend", "jax")
    _, before, _ = run("--format", "csv", "quality", *words)
    _, behind, _ = run("quality", *words, "--format=csv")
    assert before == behind and before.startswith("encoding,")
    status, _, err = run("--on", "local:2", "list", "encodings")
    assert status == 2 and "--on is not an option of this command" in err
    status, _, err = run("list", "--on", "local:2")
    assert status == 2 and "No such option: --on" in err


def test_the_list_names_every_encoding(run):
    status, out, _ = run("list", "encodings")
    assert status == 0
    assert all(name in out for name in NAMES)


@pytest.mark.usefixtures("gl")
def test_json_is_a_list_of_flat_rows_with_valid_values(run):
    status, out, _ = run(
        "quality", "--encoding", "xyz", "--storage", "rgba32f", "--normals", "axes", "--format", "json"
    )
    rows = json.loads(out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert status == 0 and [row["backend"] for row in rows] == ["jax", "glsl"]
    assert set(rows[0]) == set(TABLES["quality"].empty())
    assert all(row["psnr_db"] is None and row["exact"] is True for row in rows), "identical normals"


def test_rows_are_written_to_a_file_completely(run, tmp_path):
    path = tmp_path / "new" / "rows.json"
    path.parent.mkdir()
    status, out, _ = run(*QUICK, "--backend", "jax", "--format", "json", "-o", str(path))
    assert status == 0 and out == ""
    assert len(json.loads(path.read_text())) == 2
    assert [p.name for p in path.parent.iterdir()] == ["rows.json"]


@pytest.mark.parametrize("width", [60, 80, 120, 200])
def test_a_narrow_terminal_does_not_break_numbers(run, monkeypatch, width):
    monkeypatch.setenv("COLUMNS", str(width))
    rows = json.loads(run(*QUICK, "--backend", "jax", "--format", "json")[1])
    out = run(*QUICK, "--backend", "jax")[1]
    assert all(len(line) <= width for line in out.splitlines()), out
    assert all(f"{row['angle_max_deg']:.4g}" in out and f"{row['psnr_db']:.4g}" in out for row in rows), out


def test_a_failed_write_keeps_the_old_file(run, tmp_path, monkeypatch):
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
    """The target of a link is replaced; a pipe is written to."""
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
def test_links_in_a_loop_are_a_one_line_error(run, tmp_path, monkeypatch, output):
    monkeypatch.chdir(tmp_path)
    option, name = output.split()
    for link, other in (("a", "b"), ("b", "a")):
        for suffix in (".json", ".png", ".html"):
            Path(link + suffix).symlink_to(other + suffix)
    status, out, err = run("depth", option, name)
    why = "its links form a loop; name another file"
    assert (status, out, err) == (2, "", f"normalbench: cannot write to {name}: {why}\n")


def test_no_command_prints_help_without_an_error(run):
    status, out, err = run()
    assert status == 0 and "quality" in out and err == ""


def measured_instead(monkeypatch, encoding: Encoding) -> None:
    """Make the encoding's name stand for this encoding on the command line."""
    monkeypatch.setattr(encoding_names, "ENCODINGS", {**ENCODINGS, encoding.name: encoding})


def test_a_users_broken_encoding_is_a_one_line_error_that_names_its_file(run, monkeypatch):
    """The Python twin raises an error or returns another number of components."""

    def raises(*_):
        raise ValueError("what is this?")

    original = ENCODINGS["xy"]
    for changed, parts in (
        ({"encode": raises}, ["xy.py", "ValueError", "what is this?"]),
        ({"components": 3}, ["xy.py", "encode returns 2 numbers"]),
    ):
        measured_instead(monkeypatch, replace(original, **changed))
        status, _, err = run("quality", "--encoding", "xy", "--normals", "axes")
        assert status == 2 and err.count("\n") == 1 and all(part in err for part in parts), err


@pytest.mark.usefixtures("gl")
def test_a_users_broken_shader_loses_its_rows_and_is_an_error_if_measured_alone(run, monkeypatch, tmp_path):
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


def test_decoded_values_that_are_not_numbers_are_counted_and_reported(run, monkeypatch):
    original = ENCODINGS["xy"]

    def decode(e, view):
        n = original.decode(e, view)
        return n._replace(x=jnp.where(e.x > 0.9, jnp.nan, n.x))

    measured_instead(monkeypatch, replace(original, decode=decode))
    status, out, err = run("quality", "--encoding", "xy", "--normals", "axes", "--backend", "jax", "--format", "json")
    assert status == 0 and json.loads(out)[0]["invalid"] == 64, "one axis of six, 64 directions around it"
    assert err == "normalbench: xy rgba8 nearest axes jax: 64 results are NaN or infinite\n"


def test_an_encoding_that_does_not_fit_is_reported_and_the_rest_is_measured(run):
    status, out, err = run(
        "quality", "--encoding", "xyz,xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax"
    )
    assert status == 0 and "xyz/rg8" in err and "xy" in out
