"""What the README says is so: its commands run, its table is measured, its example passes."""

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from written import as_document, packed, planes_of, png_bytes, some_normals, write_exr

from normalbench.bench.cli import app as cli
from normalbench.bench.metrics import published as seeds
from normalbench.bench.metrics.code_limits import HEMISPHERE, SPHERE, code_limit
from normalbench.bench.tables.lights.sums import Adder, equal_lights
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.scenes.mesh import sphere

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "README.md").read_text()
(ENCODING,) = re.findall(r"```glsl\n(.*?)```", TEXT, re.S)
LAYOUT, GATES = re.findall(r"```toml\n(.*?)```", TEXT, re.S)
COMMANDS = re.findall(r"^    ((?:normalbench|python -m) [^#\n]+?) *(?:#.*)?$", TEXT, re.M)


def cli_main(monkeypatch, *words: str) -> int:
    monkeypatch.setattr(sys, "argv", ["normalbench", *words])
    return cli.main()


def users_files(folder: Path) -> None:
    """A frame in every format, its mask, a matrix, and a scene, as the commands name them."""
    pytest.importorskip("OpenEXR")
    n = some_normals()
    for name in ("frame.exr", "world.exr"):
        write_exr(folder / name, planes_of(n))
    np.save(folder / "list.npy", n)
    (folder / "frame.png").write_bytes(png_bytes(packed(n, np.uint16)))
    (folder / "mask.png").write_bytes(png_bytes(np.full((*n.shape[:2], 1), 255, np.uint8)))
    np.savetxt(folder / "view.txt", np.eye(4))
    as_document([sphere(1.0, 16, 8)]).write(folder / "scene.glb")


def test_there_are_commands_to_run():
    assert len(COMMANDS) >= 8


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_runs_as_written(command, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.toml").write_text(LAYOUT)
    (tmp_path / "gates.toml").write_text(GATES)
    (tmp_path / "mine.glsl").write_text(ENCODING)
    words = shlex.split(command)
    for name in {"before", "after"} & set(words) if words[1] != "run" else ():
        assert cli_main(monkeypatch, "run", "--tables", "depth", "-o", name) == 0
    if re.search(r"\.(glb|exr|png|npy)\b", command):
        users_files(tmp_path)
    if words[0] == "python":
        done = subprocess.run([sys.executable, *words[1:]], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return
    monkeypatch.setattr(sys, "argv", words)
    assert cli.main() == 0, capsys.readouterr().err
    for option in ("-o", "--images", "--plot"):
        if option in words:
            assert (tmp_path / words[words.index(option) + 1]).exists()


def test_the_make_targets_exist():
    makefile = (ROOT / "Makefile").read_text()
    for target in re.findall(r"^    make (\w+)", TEXT, re.M):
        assert f"\n{target}:" in makefile


def test_the_table_is_what_is_measured(normalbench):
    table = TEXT[TEXT.index("<!-- normalbench run -->") :]
    lines = re.findall(r"^\| `(\w+)` +\| +(\d+) \| +([\d.]*) \| +([\d.]+) \| +([\d.]+) \|$", table, re.M)
    assert {line[0] for line in lines} == {*seeds.PSNR_DB, "octahedral"}
    for name, bits, article, by_jax, by_glsl in lines:
        assert not article or float(article) == pytest.approx(seeds.PSNR_DB[name], abs=0.0051)
        for backend, figure in (("jax", by_jax), ("glsl", by_glsl)):
            row = normalbench.quality(encoding=name, storage=seeds.STORAGE, backend=backend)
            assert row["bits"] == int(bits)
            assert float(figure) == pytest.approx(row["psnr_seed_db"], abs=0.02), f"{name} by {backend}"


def test_the_limit_table_is_what_is_measured(normalbench):
    """To the digits shown."""
    table = TEXT[TEXT.index("<!-- normalbench quality -->") :].split("\n\n")[0]
    lines = re.findall(r"^\| `?(\w+)`? +\| (\w+) +\|" + r" +([\d.]*)[ %]*\|" * 6 + "$", table, re.M)
    assert len(lines) == 8
    for name, domain, mean, rms, largest, bits, share, unused in lines:
        if name == "limit":
            least = code_limit(2**16, {"sphere": SPHERE, "hemisphere": HEMISPHERE}[domain])
            found = [least.mean_deg, least.rms_deg, least.max_deg, 16.0]
        else:
            row = normalbench.quality(encoding=name, storage="rg8", normals=domain, worst_case=True, codes=True)
            found = [row[f"angle_{what}_deg"] for what in ("mean", "rms", "sup")] + [row["effective_bits"]]
            assert row["domain"] == domain and int(unused) == row["codes_unused"]
            assert float(share) == pytest.approx(row["reached_rms_percent"], abs=0.06)
        assert [float(text) for text in (mean, rms, largest, bits)] == pytest.approx(found, rel=5e-4)


@pytest.mark.usefixtures("gl")
def test_the_image_table_is_what_is_measured(monkeypatch, capsys):
    table = TEXT[TEXT.index("<!-- normalbench render -->") :]
    lines = re.findall(r"^\| `(\w+)` +\| +([\d.]+) \| +(\d) \| +([\d.]+) \| +(\d) \|$", table, re.M)
    assert len(lines) == 8
    names = ",".join(line[0] for line in lines)
    command = ["normalbench", "render", "--encoding", names, "--repeats", "1", "--format", "json"]
    monkeypatch.setattr(sys, "argv", command)
    assert cli.main() == 0
    rows = {row["encoding"]: row for row in json.loads(capsys.readouterr().out)}
    for name, image, rank, normals, normal_rank in lines:
        row = rows[name]
        assert float(image) == pytest.approx(row["psnr_db"], abs=0.1), name
        assert float(normals) == pytest.approx(row["normal_psnr_db"], abs=0.1), name
        assert (int(rank), int(normal_rank)) == (row["rank"], row["normal_rank"]), name


def test_the_light_table_is_what_is_measured():
    """By the model, which needs no device."""
    table = TEXT[TEXT.index("<!-- normalbench lights -->") : TEXT.index("<!-- normalbench lights image -->")]
    lines = re.findall(r"^\| `(\w+)`[ \w()]*\| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", table, re.M)
    assert len(lines) == 7
    for name, *figures in lines:
        rows = equal_lights(Adder(LIGHT_BUFFERS[name], None), [1.0], [8, 64, 256])
        # Of channels that differ the table shows colours that lose most: not sRGB's alpha.
        found = {row["lights"]: row["model"] for row in rows if row["channel"] != "a"}
        for count, figure in zip((8, 64, 256), figures, strict=True):
            assert float(figure) == pytest.approx(found[count], abs=0.0005), f"{name}, {count} lights"


def test_the_tune_table_is_what_is_measured(run):
    """Two of its rows, which stand for those that take longer."""
    table = TEXT[TEXT.index("<!-- normalbench tune -->") : TEXT.index("## What the picture says")]
    named, figure = r"`(\w+)` +\| ", r" +([\d.]+) \|"
    lines = re.findall(rf"^\| {named * 3}[^|]+\|{figure * 3}$", table, re.M)
    assert len(lines) == 5
    for encoding, storage, normals, *figures in (lines[0], lines[3]):
        status, out, _ = run("tune", encoding, "--storage", storage, "--normals", normals, "--format", "json")
        (row,) = [row for row in json.loads(out) if row["quantity"] == "psnr_db"]
        measured = [row["published"], row["tuned"], row["gain"]]
        assert status == 0 and [float(text) for text in figures] == pytest.approx(measured, abs=0.02), encoding


@pytest.mark.usefixtures("gl")
def test_the_light_image_table_is_what_is_measured(run):
    table = TEXT[TEXT.index("<!-- normalbench lights image -->") :]
    lines = re.findall(r"^\| `(\w+)` +\| +([\d.]+) \| +([\d.]*) \|$", table, re.M)
    assert len(lines) == 4
    (command,) = [command for command in COMMANDS if "--experiment image" in command]
    status, out, _ = run(*shlex.split(command)[1:], "--format", "json")
    assert status == 0
    rows = {(row["light_buffer"], row["light_targets"]): row["held_psnr_db"] for row in json.loads(out)}
    for name, two, one in lines:
        assert float(two) == pytest.approx(rows[name, 2], abs=0.1), name
        assert (float(one) == pytest.approx(rows[name, 1], abs=0.1)) if one else (name, 1) not in rows


@pytest.mark.usefixtures("gl")
def test_the_depth_table_is_what_is_measured(run):
    """By JAX to the two digits shown; by GLSL where a division may be another one, to an eighth."""
    table = TEXT[TEXT.index("<!-- normalbench depth -->") : TEXT.index("## Commands")]
    lines = re.findall(r"^\| `(\w+)` +\| `(\w+)` +\|([^|]+)\|([^|]+)\|([^|]+)\|([^|]+)\|$", table, re.M)
    assert len(lines) == 10
    (command,) = re.findall(r"^    normalbench (depth --near 0.1 --far 1000 --distance .*)$", TEXT, re.M)
    status, out, _ = run(*command.split(), "--format", "json")
    rows = [row for row in json.loads(out) if row["distance"]]
    assert status == 0
    for name, storage, *shown in lines:
        for backend, tolerance in (("jax", 0.06), ("glsl", 0.125)):
            asked = (name, storage, backend)
            measured = [r["error_max"] for r in rows if (r["depth"], r["storage"], r["backend"]) == asked]
            assert [float(text) for text in shown] == pytest.approx(measured, rel=tolerance), asked


def test_the_frames_table_is_what_is_measured(run):
    """Every row of 32 bits, best first, as the command prints them."""
    table = TEXT[TEXT.index("<!-- normalbench frames -->") :].split("\n\n")[0]
    lines = [[cell.strip(" `%") for cell in line.split("|")[1:-1]] for line in table.splitlines()[3:]]
    status, out, _ = run("frames", "--backend", "jax", "--format", "json")
    rows = [row for row in json.loads(out) if row["bits"] == 32]
    assert status == 0 and [line[:2] for line in lines] == [[row["encoding"], row["storage"]] for row in rows]
    angles = ("normal_max_deg", "tangent_max_deg", "rotation_mean_deg", "rotation_rms_deg", "rotation_max_deg")
    for line, row in zip(lines, rows, strict=True):
        expected = [*(row[name] for name in angles), row["effective_bits"], row["reached_rms_percent"]]
        assert [float(cell) for cell in line[2:]] == pytest.approx(expected, rel=2e-3, abs=6e-5), line


def test_the_cost_table_is_what_is_measured(run):
    table = TEXT[TEXT.index("<!-- normalbench cost -->") :].split("\n\n")[0]
    (mesa,) = re.findall(r"\| (Mesa [\d.]+), fragment", table)
    lines = re.findall(r"^\| `(\w+)`" + r" +\| +(\d*)" * 6 + r" \|$", table, re.M)
    assert len(lines) == 8
    names = ",".join(line[0] for line in lines)
    words = ["--isa", "--family", "polaris10,navi31", "--stage", "fragment", "--seeds", "--format", "json"]
    status, out, err = run("cost", "--encoding", names, *words)
    if status == 3 and not os.environ.get("CI"):
        pytest.skip(err)
    rows = json.loads(out)
    if {row["driver"] for row in rows if row["family"]} != {mesa}:
        pytest.skip(f"this machine's compiler is not {mesa}")
    found = {(row["encoding"], row["operation"], row["family"] or row["compiler"]): row["instructions"] for row in rows}
    found |= {key[:2]: found[key] for key in found if key[2] == seeds.SLOTS_BY and found[key] is not None}
    for name, *figures in lines:
        for operation, (article, polaris, navi) in zip(("encode", "decode"), (figures[:3], figures[3:]), strict=True):
            key = (name, operation)
            assert (int(article) if article else None) == found.get(key), key
            assert [int(polaris), int(navi)] == [found[*key, "polaris10"], found[*key, "navi31"]], key


def test_the_pipelines_it_shows_are_those_there_are():
    table = TEXT[TEXT.index("<!-- normalbench list pipelines -->") :]
    shown = dict(re.findall(r"^\| `(\w+)` +\| ([\w, ]+) \|$", table, re.M))
    assert shown == {p.name: ", ".join(stage.name for stage in p.stages) for p in PIPELINES.values()}


@pytest.mark.usefixtures("gl")
def test_the_tests_it_shows_pass(pytester):
    """With the encoding it shows beside them, and the gates it shows named as it says."""
    (example,) = re.findall(r"```python\n(.*?)```", TEXT, re.S)
    pytester.makepyfile(example)
    pytester.path.joinpath("mine.glsl").write_text(ENCODING)
    pytester.path.joinpath("gates.toml").write_text(GATES)
    (command,) = re.findall(r"^    (pytest .*--normalbench.*)$", TEXT, re.M)
    words = ["." if word == "tests" else word for word in shlex.split(command)[1:]]
    plain = ("-p", "no:cacheprovider", "-p", "no:hypothesispytest")
    for more in (["--normalbench-write-baseline"], []):
        result = pytester.runpytest_subprocess(*words, *more, *plain)
        result.assert_outcomes(passed=example.count("def test_") + GATES.count("[[gate]]"))


def test_the_picture_it_shows_is_there():
    for picture in re.findall(r"!\[[^]]*\]\(([^)]+)\)", TEXT):
        assert (ROOT / picture).stat().st_size > 10_000


def a_copy_of_the_rooms(folder: Path) -> Path:
    """The package as a plain folder that Python finds from `folder` before the installed one."""
    package = folder / "normalbench"
    for room in ("encodings", "gbuffer", "bench", "reports"):
        for source in (ROOT / room).rglob("*"):
            if source.is_file() and "__pycache__" not in source.parts:
                target = package / source.relative_to(ROOT)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(source.read_bytes())
    return package


def normalbench_in(folder: Path, *arguments: str) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "normalbench.bench", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_an_encoding_is_added_as_it_says(tmp_path):
    """A copy of the tree, a pair of files, a line: the table has a new row in both languages."""
    package = a_copy_of_the_rooms(tmp_path)
    normals, catalogue = package / "encodings/normals", package / "encodings/catalogue.py"
    for suffix in (".py", ".glsl"):
        text = (normals / f"octahedral{suffix}").read_text()
        renamed = text.replace("octahedral_", "mine_").replace('name="octahedral"', 'name="mine"')
        (normals / f"mine{suffix}").write_text(renamed)
    catalogue.write_text(catalogue.read_text().replace('    "octahedral",\n', '    "octahedral",\n    "mine",\n'))
    done = normalbench_in(tmp_path, "quality", "--encoding", "mine", "--format", "csv")
    assert done.returncode == 0, done.stderr
    header, *rows = done.stdout.splitlines()
    figures = [dict(zip(header.split(","), row.split(","), strict=False))["psnr_db"] for row in rows]
    assert [float(f) for f in figures] == pytest.approx([49.95, 49.95], abs=0.01)


@pytest.mark.parametrize(
    "file, old, new, said",
    [
        ("normals/xy.py", "def encode(", "def encode((", ["xy.py", "SyntaxError"]),
        ("normals/xy.py", 'name="xy"', 'name="yx"', ["xy.py", "'yx'"]),
        ("catalogue.py", '    "xy",\n', '    "xy",\n    "missing",\n', ["missing.py", "No module named"]),
    ],
)
def test_an_encoding_that_cannot_be_imported_is_one_line_and_help_still_helps(tmp_path, file, old, new, said):
    path = a_copy_of_the_rooms(tmp_path) / "encodings" / file
    path.write_text(path.read_text().replace(old, new))
    for arguments in (["list"], ["quality", "--encoding", "octahedral"]):
        done = normalbench_in(tmp_path, *arguments)
        assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
        assert all(part in done.stderr for part in said), done.stderr
    assert normalbench_in(tmp_path, "--help").returncode == 0
