"""The command line: its output, the files it writes, and its messages about bad input."""

import csv
import io
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from test_cli import QUICK

from normalbench.bench.door.run import options_of
from normalbench.bench.measures.metrics import published
from normalbench.bench.tables.quality.table import COMMON, TWO, WIDE
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.reports import tables


def in_a_process(*arguments: str, **environment: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "normalbench", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=os.environ | environment)


NO_GL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent", "VIRTUAL_DISPLAY": ""}


LIGHT = ("--help", "list", *(f"{name} --help" for name in ("quality", "render", "sweep", "depth", "frames", "report")))


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
    assert done.returncode == 0 and done.stdout.count("Usage: ") == len(LIGHT) - 2, done.stderr[-200:]


def test_a_command_imports_only_its_own_table():
    program = (
        "import sys; from normalbench.bench.door.cli import app; sys.argv[0] = 'normalbench'; app.main()\n"
        "print(sorted(name.split('.')[3] for name in sys.modules if name.startswith('normalbench.bench.tables.')"
        " and name.endswith('.table') and name.count('.') == 4), file=sys.stderr)"
    )
    for words, imported in ((["list", "encodings"], []), (["quality", "--help"], ["quality"])):
        done = subprocess.run([sys.executable, "-c", program, *words], capture_output=True, text=True)
        assert done.stderr == f"{imported}\n", words


@pytest.mark.usefixtures("gl")
def test_all_formats_have_the_same_figures(run):
    rows = json.loads(run(*QUICK, "--format", "json")[1])
    as_csv = list(csv.DictReader(io.StringIO(run(*QUICK, "--format", "csv")[1])))
    assert [float(r["psnr_db"]) for r in as_csv] == [r["psnr_db"] for r in rows]
    for as_text in ("table", "markdown"):
        out = run(*QUICK, "--format", as_text)[1]
        assert all(f"{row['psnr_db']:.4g}" in out for row in rows), out


BAD = {
    "an encoding": (["quality", "--encoding", "octahedron"], ["'octahedron'", "octahedral", "spheremap"]),
    "a storage": (["quality", "--storage", "rgba9"], ["'rgba9'", "rgba8", "rg16f"]),
    "a set": (["quality", "--normals", "moon"], ["'moon'", "playground", "sphere"]),
    "a back end": (["quality", "--backend", "vulkan"], ["'vulkan'", "jax", "glsl"]),
    "a rounding": (["quality", "--rounding", "up"], ["'up'", "nearest", "truncate"]),
    "a list": (["list", "cars"], ["'cars'", "encodings", "storages"]),
    "no name": (["quality", "--encoding", ","], ["no encoding named", "octahedral"]),
    "nothing to tune": (["tune", "nope"], ["'nope'; known: xyz", "octahedral"]),
    "all to tune": (["tune", "all"], ["tune takes one encoding, not ", "name one"]),
    "no normals": (["quality", "--count", "0"], ["--count 0", "1099511627776"]),
    "negative count": (["quality", "--count", "-5"], ["--count -5"]),
    "too many": (["quality", "--count", "9999999999999"], ["9999999999999", "1099511627776"]),
    "not a count": (["quality", "--count", "many"], ["--count"]),
    "a negative seed": (["quality", "--seed", "-1"], ["--seed -1"]),
    "a seed beyond 64 bits": (["quality", "--seed", str(2**63)], [f"--seed {2**63}", "use 0 to"]),
    "no room": (["quality", "--encoding", "xyz", "--storage", "rg8"], ["xyz/rg8", "3 components", "2 channels"]),
    "a format": (["quality", "--format", "xml"], ["xml", "markdown"]),
    "an option": (["quality", "--colour"], ["--colour"]),
    "a command": (["mesure"], ["mesure", "quality"]),
    "no folder": ([*QUICK, "-o", "/proc/nowhere/rows.csv"], ["/proc/nowhere"]),
    "a folder": ([*QUICK, "-o", "/"], ["is a folder"]),
    "pictures nowhere": ([*QUICK, "--images", "/proc/nowhere"], ["/proc/nowhere"]),
    "no image": ([*QUICK, "--images", "somewhere"], ["--images", "playground"]),
    "run nowhere": (["run", "-o", "/proc/nowhere/results"], ["/proc/nowhere"]),
    "run onto": (["run", "-o", "/usr"], ["/usr already exists"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_a_one_line_error_that_suggests_a_fix(run, what, tmp_path, monkeypatch):
    arguments, parts = BAD[what]
    monkeypatch.chdir(tmp_path)
    status, out, err = run(*arguments)
    assert status == 2 and out == ""
    assert err.startswith("normalbench: ") and err.count("\n") == 1, err
    assert all(part in err for part in parts), err
    assert not list(tmp_path.iterdir()), "something was left behind"


@pytest.mark.parametrize("target", ["nowhere", "link"], ids=["to nothing", "to itself"])
@pytest.mark.parametrize("output", ["link", "link/below"])
def test_a_link_to_a_missing_folder_is_a_one_line_error(run, tmp_path, monkeypatch, target, output):
    monkeypatch.chdir(tmp_path)
    Path("link").symlink_to(target)
    status, out, err = run("run", "--tables", "depth", "-o", output)
    why = f"link is a link to {target}, which does not exist; fix the link, or name another folder"
    assert (status, out, err) == (2, "", f"normalbench: cannot write to {output}: {why}\n")
    assert [path.name for path in tmp_path.iterdir()] == ["link"]


def test_output_that_cannot_be_written_is_a_one_line_error():
    if not Path("/dev/full").is_char_device():
        pytest.skip("no /dev/full here")
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "normalbench", "list"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2 and done.stderr == "normalbench: cannot write: No space left on device\n"


def test_a_pipe_closed_by_its_reader_is_not_an_error():
    command = f"{sys.executable} -m normalbench list | true; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == ""


def test_glsl_without_an_opengl_driver_exits_with_3_and_says_what_to_install():
    done = in_a_process(*QUICK, "--backend", "glsl", **NO_GL)
    assert done.returncode == 3 and done.stdout == ""
    assert done.stderr.count("\n") == 1 and "apt-get install libegl1" in done.stderr


def test_doctor_describes_this_machine(run):
    status, out, _ = run("doctor", "--format", "json")
    facts = {row["name"]: row["value"] for row in json.loads(out)}
    assert status == 0
    assert {"python", "jax", "processor", "GL"} <= set(facts)
    if "GL version" in facts:
        assert facts["GL rounds rgba8"] == "nearest"


# What a run measures where nobody names an encoding.
USUAL_CODECS = len(COMMON) + len(TWO) + 3 * len(WIDE) + 2


@pytest.mark.usefixtures("gl")
def test_the_pictures_show_the_scene(run, tmp_path):
    """The pictures are neither black nor all alike. The error picture of `xy` is blue where z was lost."""
    status, _, err = run("quality", "--encoding", "xy,xyz", "--images", str(tmp_path))
    assert status == 0, err
    names = {f"playground-{e}-rgba8-{k}.png" for e in ("xy", "xyz") for k in ("encoded", "decoded", "error", "power")}
    others = {"playground-normals.png", "playground-xy-rgba8.npz", "playground-xyz-rgba8.npz"}
    assert {p.name for p in tmp_path.iterdir()} == names | others, "and the set itself, and each pixel's code and angle"
    pictures = {name: np.asarray(pixels_of(tmp_path / name)).astype(int) for name in names}
    assert all(p.shape == (480, 640, 3) and p.std() > 3 for p in pictures.values())
    assert abs(pictures["playground-xyz-rgba8-decoded.png"] - pictures["playground-xyz-rgba8-encoded.png"]).max() <= 1
    error = pictures["playground-xy-rgba8-error.png"]
    lost = pictures["playground-xyz-rgba8-decoded.png"][..., 2] < 120
    lost &= pictures["playground-xyz-rgba8-decoded.png"].any(axis=-1)
    assert np.mean(error[lost][:, 2] > 200) > 0.95, "z is what XY loses"
    assert pictures["playground-xy-rgba8-encoded.png"][..., 2].max() == 0, "an unused channel is black"


def pixels_of(path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


def test_run_prints_a_verdict_and_show_adds_the_figures_of_the_article(run, results):
    folder, out, err = results
    assert err == "" and out.startswith("quality: Most accurate on playground, by mean error: octahedral_precise"), out
    assert len(out.splitlines()) <= 6 and "normalbench show" in out, out
    status, shown, _ = run("show", str(folder), "quality")
    assert status == 0 and shown.startswith("Most accurate on playground, by mean error: octahedral_precise"), shown
    for name, figure in published.PSNR_DB.items():
        table = shown[shown.index("playground, rgba8") :]
        line = next(line for line in table.splitlines() if line.startswith(f"{name} "))
        assert f"{figure:.2f}" in line, line
    assert run("show", str(folder))[1].split() == " ".join(out.splitlines()[:-2]).split(), "in another width"


def test_show_lists_the_tables_of_a_run(run, results, tmp_path):
    status, _, err = run("show", str(results[0]), "depth")
    assert (status, err) == (2, "normalbench: unknown table of the run 'depth'; known: all, quality\n")
    status, _, err = run("show", str(tmp_path))
    assert status == 2 and err.count("\n") == 1, err
    facts = json.loads((results[0] / "run.json").read_text())
    for name in ("run.json", "rows.jsonl"):
        shutil.copy(results[0] / name, tmp_path)
    (tmp_path / "run.json").write_text(json.dumps(facts | {"finished": False}))
    status, out, err = run("show", str(tmp_path))
    assert status == 0 and "is not finished" in err and out.startswith("quality: "), err


def test_run_leaves_a_results_folder(results):
    folder, out, _ = results
    assert str(folder) in out
    rows = json.loads((folder / "quality.json").read_text())
    names = {row["encoding"] for row in rows}
    assert names == {*published.PICTURED, "octahedral_precise", "spheremap_classic"}
    whole = [name for name in names if ENCODINGS[name].domain == "sphere"]
    assert len(rows) == 2 * (2 * len(names) + 2 * len(whole)), "by JAX and GLSL, on two sets and two of the sphere"
    assert {row["normals"] for row in rows} == {"playground", "hemisphere", "sphere", "axes"}
    assert all(row["skipped"] is None and row["count"] for row in rows)
    assert len(list(csv.DictReader(io.StringIO((folder / "quality.csv").read_text())))) == len(rows)
    facts = json.loads((folder / "run.json").read_text())
    assert facts["machine"]["jax"] and facts["machine"]["GL"] and facts["finished"] and facts["sources"]
    assert facts["command"][:3] == ["run", "--tables", "quality"] and facts["command"][-2:] == ["-o", str(folder)]
    # Another test may have written the pictures of all encodings next to each other.
    images = {path.name for path in (folder / "images").iterdir()} - {"playground-rgba8.png"}
    assert len(images) == len(names) * 5 + 1 and "playground-normals.png" in images
    assert len(list((folder / "sphere").iterdir())) == len(names)


def test_a_run_measures_the_usual_codecs():
    """The storages are rgba8, rg16f, rgb10a2, rg16 and 12:12; each is measured on two sets with both backends."""
    two = [
        name for name in COMMON if ENCODINGS[name].components == 2 and Codec(ENCODINGS[name], STORAGES["rg16f"]).fits
    ]
    assert tuple(two) == TWO
    quality = TABLES["quality"]
    steps = [step for options in options_of(quality, {}) for step in quality.work.steps(options, quality.outputs())]
    assert len(steps) == USUAL_CODECS * 2 * 2
    assert {step.key["normals"] for step in steps} == {"playground", "hemisphere"}


def test_a_run_that_fails_at_the_end_keeps_its_rows_and_no_partial_table(run, tmp_path, monkeypatch):
    """A full disk is a one-line error when tables are written; a second run measures nothing again."""
    folder = tmp_path / "results"
    words = ("--encoding", "octahedral,xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax")
    command = ("run", "--tables", "quality", *words, "-o", str(folder))

    def full(*_):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(tables, "to_csv", full)
        status, _, err = run(*command)
    assert status == 2 and "No space left on device" in err and err.count("\n") == 1
    assert {path.name for path in folder.iterdir()} == {"rows.jsonl", "run.json", "quality.json"}
    steps = (folder / "rows.jsonl").read_bytes().count(b"\n")
    status, _, err = run(*command)
    assert status == 0 and f"{steps} of {steps} steps are done" in err


@pytest.mark.usefixtures("gl")
def test_a_cache_folder_that_cannot_be_made_causes_no_message(tmp_path, monkeypatch):
    """Mesa would print a line of its own; JAX keeps its programs in this folder."""
    for name in ("MESA_SHADER_CACHE_DIR", "MESA_SHADER_CACHE_DISABLE", "JAX_COMPILATION_CACHE_DIR"):
        monkeypatch.delenv(name, raising=False)
    (tmp_path / "file").touch()
    done = in_a_process(*QUICK, "--backend", "jax,glsl", XDG_CACHE_HOME=str(tmp_path / "file" / "cache"))
    assert (done.returncode, done.stderr) == (0, "")


def test_an_unknown_jax_platform_is_a_one_line_error_in_every_command():
    """All commands run in one process, because JAX looks up its platforms again each time."""
    commands = (QUICK, *([name] for name in ("run", "lights", "depth", "frames", "render", "sweep")))
    program = (
        "import json, sys\n"
        "from normalbench.bench.door.cli import app\n"
        "for words in json.loads(sys.argv[1]):\n"
        "    sys.argv = ['normalbench', *words]\n"
        "    print(f'ends with {app.main()}', file=sys.stderr, flush=True)\n"
    )
    words = [sys.executable, "-c", program, json.dumps(commands)]
    done = subprocess.run(words, capture_output=True, text=True, env=os.environ | {"JAX_PLATFORMS": "bogus"})
    lines = done.stderr.splitlines()
    assert done.returncode == 0 and done.stdout == "" and len(lines) == 2 * len(commands), done.stderr
    for command, line, end in zip(commands, lines[::2], lines[1::2], strict=True):
        assert "JAX_PLATFORMS" in line and end == "ends with 3", (command, line, end)


def test_jax_measures_without_an_opengl_driver():
    done = in_a_process(*QUICK, "--format", "json", **NO_GL)
    rows = json.loads(done.stdout)
    assert done.returncode == 0
    assert all(row["psnr_db"] for row in rows if row["backend"] == "jax")
    skipped = [row["skipped"] for row in rows if row["backend"] == "glsl"]
    assert len(skipped) == 2 and all("no OpenGL 4.3 device" in s and "apt-get install" in s for s in skipped)
    assert done.stderr.count("\n") == 1 and "apt-get install" in done.stderr
