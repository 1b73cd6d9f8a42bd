"""What README.md and every page of docs/ say is so: commands run, tables are measured, examples pass."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from dataclasses import fields, replace
from pathlib import Path

import devices
import numpy as np
import pytest
from manual import PAGES, README, ROOT, table
from written import as_document, packed, planes_of, png_bytes, some_normals, write_exr

from normalbench.bench.cli import app as cli
from normalbench.bench.code.files import code_of
from normalbench.bench.code.verify import agreement
from normalbench.bench.codecs.names import codecs_named
from normalbench.bench.metrics import published
from normalbench.bench.metrics.code_limits import HEMISPHERE, SPHERE, code_limit
from normalbench.bench.tables.columns import explained
from normalbench.bench.tables.growth import work as growth
from normalbench.bench.tables.lights.sums import Adder, equal_lights
from normalbench.bench.tables.mix.table import USES, VERDICTS
from normalbench.bench.tables.mix.verdict import lines as verdicts_of_mixes
from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.throughput import measure as throughput
from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.scenes.mesh import sphere

MOST_LINES = 150
FENCE = re.compile(r"^```.*?^```$", re.S | re.M)
# An example is a fenced block under the name of its file.
NAMED = re.compile(r"^<!-- file (\S+) -->\n```(?:glsl|hlsl|python|toml)\n(.*?)^```$", re.S | re.M)
EXAMPLES = [(path, *found) for path, text in PAGES.items() for found in NAMED.findall(text)]
FILES = {name: text for _, name, text in EXAMPLES}
# An indented line is a command, up to its comment.
INDENTED = re.compile(r"^    (\S[^#\n]*?) *(?:#.*)?$", re.M)
LINES = list(dict.fromkeys(line for text in PAGES.values() for line in INDENTED.findall(FENCE.sub("", text))))
COMMANDS = [line for line in LINES if line.startswith(("normalbench ", "python "))]
PYTEST = [line for line in LINES if line.startswith("pytest ")]
MAKE = [line for line in LINES if line.startswith("make ")]
# These install something or change the shell.
NOT_RUN = [line for line in LINES if line.startswith(("pip install ", ". .venv/"))]
# Every marker of a table, each held by a test below.
HELD = {
    *("headline", "normalbench run", "normalbench quality", "normalbench tune", "normalbench render"),
    *("normalbench list pipelines", "normalbench lights", "normalbench lights image", "normalbench depth"),
    *("normalbench frames", "normalbench cost", "normalbench cost vendors", "normalbench published"),
    "normalbench cost half",
    *("normalbench cost terascale", "normalbench cost mobile"),
    *("normalbench effects", "normalbench half", "normalbench mix", "normalbench motion"),
    *("normalbench maps", "normalbench vectors", "normalbench code", "normalbench cost nvidia"),
}


def users_files(folder: Path) -> None:
    """A frame in every format, its mask, a matrix, and a scene, as the commands name them."""
    n = some_normals()
    for name in ("frame.exr", "world.exr"):
        write_exr(folder / name, planes_of(n))
    for name in ("list.npy", "cube.npy"):
        np.save(folder / name, n)
    (folder / "frame.png").write_bytes(png_bytes(packed(n, np.uint16)))
    (folder / "mask.png").write_bytes(png_bytes(np.full((*n.shape[:2], 1), 255, np.uint8)))
    np.savetxt(folder / "view.txt", np.eye(4))
    as_document([sphere(1.0, 16, 8)]).write(folder / "scene.glb")


def readers_devices(folder: Path) -> None:
    """Files of devices, as the commands name them."""
    devices.write(folder / "phone.json", renderer=devices.MALI, truncated=("RGB10_A2",))
    devices.write(folder / "desktop.json", renderer=devices.GEFORCE)
    devices.write_ten(folder / "contributed")


def test_the_readme_is_short():
    assert len(PAGES[README].splitlines()) <= MOST_LINES


def test_every_indented_line_is_a_known_command():
    """A line that no test below runs is one that installs something."""
    assert len(COMMANDS) >= 40
    assert set(LINES) == {*COMMANDS, *PYTEST, *MAKE, *NOT_RUN}
    for path, text in PAGES.items():
        assert not re.search(r"^```(sh|bash|shell|console)", text, re.M), f"{path.name}: indent commands"


def test_every_table_is_held_by_a_test():
    marked = re.findall(r"^<!-- (headline|normalbench [\w ]+?)(?: -->)?$", "\n".join(PAGES.values()), re.M)
    assert sorted(marked) == sorted(HELD)


def test_every_example_is_a_file_and_files_of_one_name_are_the_same():
    for path, text in PAGES.items():
        assert len(re.findall(r"^```(?:glsl|hlsl|python|toml)$", text, re.M)) == len(NAMED.findall(text)), path.name
    assert all(FILES[name] == text for _, name, text in EXAMPLES)


def test_every_example_is_used():
    for name in FILES:
        used = any(name in shlex.split(line.replace(",", " ")) for line in (*COMMANDS, *PYTEST))
        assert used or name.startswith("test_") or Path(name).with_suffix(".glsl").name in FILES, name


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_the_codes_that_differ_between_languages_are_as_many_as_said(tmp_path):
    """Of every cell, by C and by HLSL; ties depend on the device a little."""
    head, _, *rows = [[cell.strip(" `") for cell in line.split("|")[1:-1]] for line in _lines("normalbench code")]
    for encoding, *cells in rows:
        for storage, said in zip(head[1:], cells, strict=True):
            (codec,) = codecs_named(encoding, storage, "nearest")
            assert codec.fits == bool(said), codec.name
            found = [_differing(codec, language, tmp_path) for language in ("c", "hlsl")] if said else [0]
            assert (max(found) == 0) == (said in ("0", "")), f"{codec.name}: {found}, said {said}"
            assert max(found) <= 2 + 1.2 * int(said or 0), f"{codec.name}: {found}, said {said}"


def _lines(marker: str) -> list[str]:
    return table(marker).splitlines()[1:]


def _differing(codec, language: str, folder: Path) -> int:
    code = code_of(codec, language)
    for name, data in code.files([]).items():
        (folder / name).write_bytes(data)
    found = agreement(codec, language, folder / code.name, code.interface)
    assert found.holds, f"{codec.name} in {language}: {found.says}"
    return found.differing


# What renders, tunes, draws or measures many rows.
LONG = re.compile(
    r"(pick|mix|maps|render|effects|motion|lights|sweep|throughput|tune|run|report|frames|check|published)\b(?! --help)"
    r"|^python|growth$|--on |--plot|--report|--worst-case|--encoding all"
)


# What is measured of less than the command says: how it is written is tried here, its figures are by others.
SMALL = {"count": "4096", "size": "160x90", "counts": "4", "repeats": "3"}


def in_small(words: list[str]) -> list[str]:
    """Options that a command does not say itself, for as little as it can measure."""
    table = TABLES.get(words[1])
    known = {field.name for field in fields(table.options)} if table else set()
    return [word for name in SMALL if name in known and f"--{name}" not in words for word in (f"--{name}", SMALL[name])]


@pytest.mark.parametrize(
    "command", [pytest.param(one, marks=[pytest.mark.slow] * bool(LONG.search(one))) for one in COMMANDS]
)
def test_every_command_runs_as_written(command, tmp_path, monkeypatch, capsys, request):
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    words = shlex.split(command)
    if "nvidia" in words:
        request.getfixturevalue("nvidia")
    for name in {"before", "after"} & set(words) if words[1] != "run" else ():
        shutil.copytree(request.getfixturevalue("results")[0], tmp_path / name)
    if re.search(r"\.(glb|exr|png|npy)\b", command):
        users_files(tmp_path)
    if re.search(r"\b(phone\.json|desktop\.json|contributed)\b", command):
        readers_devices(tmp_path)
    if words[0] == "python":
        done = subprocess.run([sys.executable, *words[1:]], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return
    # Rates are no part of the manual: three turns are measured, however short.
    monkeypatch.setattr(throughput, "LONG_ENOUGH", 0.0)
    # Neither is how times grow: the largest of three sizes takes most of the time.
    kinds = {name: replace(kind, usual=kind.usual[:2]) for name, kind in growth.KINDS.items()}
    monkeypatch.setattr(growth, "KINDS", kinds)
    monkeypatch.setattr(sys, "argv", [*words, *in_small(words)])
    assert cli.main() == 0, capsys.readouterr().err
    for option in ("-o", "--images", "--plot"):
        if option in words:
            assert (tmp_path / words[words.index(option) + 1]).exists()


def test_the_make_targets_exist():
    makefile = (ROOT / "Makefile").read_text()
    assert {"make bench", "make test"} <= set(MAKE)
    for line in MAKE:
        _, target, *variables = line.split()
        assert f"\n{target}:" in makefile
        assert all(f"$({variable.partition('=')[0]})" in makefile for variable in variables)


def test_what_pip_installs_exists():
    known = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    extras = {extra for line in NOT_RUN for found in re.findall(r"\[([\w,]+)\]", line) for extra in found.split(",")}
    assert extras and extras <= set(known)


@pytest.mark.parametrize("name", TABLES)
def test_the_columns_it_explains_are_those_of_the_table(name):
    """To the letter as the registry has them."""
    marked = re.compile(rf"^<!-- columns {name} -->\n(.*?)^<!-- end -->", re.S | re.M)
    (shown,) = [found for text in PAGES.values() for found in marked.findall(text)]
    assert shown == explained(name)


def headline() -> tuple[list[list[str]], list[list[str]]]:
    """The commands that the headline table comes from, and its rows without units."""
    commands, rows = re.search(r"^<!-- headline\n(.*?)\n-->\n(.*?)\n\n", PAGES[README], re.S | re.M).groups()
    cells = [re.findall(r"\| *`?([\w.]+)", line) for line in rows.splitlines()[2:]]
    return [shlex.split(line)[1:] for line in commands.splitlines()], cells


def measured(run, name: str) -> list[dict]:
    """The rows of the headline's commands of one name."""
    found = []
    for command in headline()[0]:
        if command[0] == name:
            status, out, err = run(*command, "--format", "json")
            if status == 3 and not os.environ.get("CI"):
                pytest.skip(err)
            assert status == 0, err
            found += json.loads(out)
    return found


@pytest.mark.slow
def test_the_headline_errors_are_what_is_measured(run):
    """To the digits shown, and above the bounds that the text states."""
    rows = {(row["storage"], row["encoding"]): row for row in measured(run, "quality")}
    shown = headline()[1]
    assert {(storage, encoding) for storage, encoding, *_ in shown} == set(rows)
    assert shown == sorted(shown, key=lambda line: (line[0] != "rg8", float(line[3])))
    for storage, encoding, bits, mean, worst, *_ in shown:
        row = rows[storage, encoding]
        assert int(bits) == row["bits"]
        assert float(mean) == pytest.approx(row["angle_mean_deg"], abs=6e-4), row
        assert float(worst) == pytest.approx(row["angle_sup_deg"], abs=6e-3), row
    least = code_limit(2**16, SPHERE)
    assert f"{least.mean_deg:.3f}°" in PAGES[README] and f"{least.max_deg:.3f}°" in PAGES[README]


@pytest.mark.slow
@pytest.mark.usefixtures("gl", "radv")
def test_the_answer_is_what_the_command_says(run):
    """Every sentence of it."""
    (shown,) = re.findall(r"^<!-- answer: normalbench pick -->\n(.*?)<!-- end -->", PAGES[README], re.S | re.M)
    answer = " ".join(run("pick", "--format", "markdown")[1].split())
    for said in re.split(r"^(?:- |(?=rg))", shown, flags=re.M)[1:]:
        assert " ".join(said.split()) in answer, said


def test_the_headline_costs_are_what_is_measured(run):
    rows = [row for row in measured(run, "cost") if row["encoding"]]
    (mesa,) = set(re.findall(r"Mesa [\d.]+\d", PAGES[README]))
    if {row["driver"] for row in rows} != {mesa}:
        pytest.skip(f"this machine's compiler is not {mesa}")
    found = {(row["encoding"], row["operation"]): row["instructions"] for row in rows}
    for _, encoding, *_, encode, decode, _ in headline()[1]:
        assert (int(encode), int(decode)) == (found[encoding, "encode"], found[encoding, "decode"]), encoding


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_the_headline_images_are_what_is_measured(run):
    rows = {(row["storage"], row["encoding"]): row["psnr_db"] for row in measured(run, "render")}
    for storage, encoding, *_, image in headline()[1]:
        assert float(image) == pytest.approx(rows[storage, encoding], abs=0.1), (storage, encoding)


def test_the_article_table_is_what_is_measured(normalbench):
    shape = r"^\| `(\w+)` +\| +(\d+) \| +([\d.]*) \| +([\d.]+) \| +([\d.]+) \|$"
    lines = re.findall(shape, table("normalbench run"), re.M)
    assert {line[0] for line in lines} == {*published.PSNR_DB, "octahedral"}
    for name, bits, article, by_jax, by_glsl in lines:
        assert not article or float(article) == pytest.approx(published.PSNR_DB[name], abs=0.0051)
        for backend, figure in (("jax", by_jax), ("glsl", by_glsl)):
            row = normalbench.quality(encoding=name, storage=published.STORAGE, backend=backend)
            assert row["bits"] == int(bits)
            assert float(figure) == pytest.approx(row["psnr_article_db"], abs=0.02), f"{name} by {backend}"


@pytest.mark.slow
def test_the_limit_table_is_what_is_measured(normalbench):
    """To the digits shown."""
    lines = re.findall(
        r"^\| `?(\w+)`? +\| (\w+) +\|" + r" +([\d.]*)[ %]*\|" * 6 + "$", table("normalbench quality"), re.M
    )
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


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_the_image_table_is_what_is_measured(monkeypatch, capsys):
    shape = r"^\| `(\w+)` +\| +([\d.]+) \| +(\d) \| +([\d.]+) \| +(\d) \|$"
    lines = re.findall(shape, table("normalbench render"), re.M)
    assert len(lines) == 8
    names = ",".join(line[0] for line in lines)
    command = ["normalbench", "render", "--encoding", names, "--repeats", "0", "--format", "json"]
    monkeypatch.setattr(sys, "argv", command)
    assert cli.main() == 0
    rows = {row["encoding"]: row for row in json.loads(capsys.readouterr().out)}
    for name, image, rank, normals, normal_rank in lines:
        row = rows[name]
        assert float(image) == pytest.approx(row["psnr_db"], abs=0.1), name
        assert float(normals) == pytest.approx(row["normal_psnr_db"], abs=0.1), name
        assert (int(rank), int(normal_rank)) == (row["rank"], row["normal_rank"]), name


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_the_effects_table_is_what_is_measured(run):
    """And what it concludes: the error of octahedral 8:8 is a fifteenth of the method's own, or less."""
    lines = [re.findall(r"[\w.]+", line) for line in table("normalbench effects").splitlines()[3:]]
    assert len(lines) == 7
    words = ("--encoding", "octahedral,spheremap", "--storage", "rg8,rgb10a2", "--depth", "linear/packed16")
    status, out, _ = run("effects", "--effect", ",".join(line[0] for line in lines), *words, "--format", "json")
    assert status == 0
    rows = {(row["effect"], row["encoding"], row["storage"]): row for row in json.loads(out)}
    codes = (("octahedral", "rg8"), ("octahedral", "rgb10a2"), ("spheremap", "rg8"), (None, None))
    for name, *figures in lines:
        found = [1e3 * rows[name, *code]["effect_rms"] for code in codes]
        assert [float(text) for text in figures[:4]] == pytest.approx(found, rel=0.02, abs=0.01), name
        method = rows[name, *codes[0]]["method_rms"]
        assert [float(text) for text in figures[4:]] == pytest.approx([1e3 * method] if method else [], rel=0.05), name
        assert method is None or method > 15 * rows[name, *codes[0]]["effect_rms"], name


@pytest.mark.slow
def test_the_half_table_is_what_is_measured(run):
    """To the digits shown; the largest angle, which a driver's roots decide, to 3 %."""
    lines = [re.findall(r"[\w.]+", line) for line in table("normalbench half").splitlines()[3:]]
    assert len(lines) == 11
    rows = {}
    for storage in ("rg8", "rgb10a2"):
        names = ",".join(line[1] for line in lines if line[0] == storage)
        words = ("--storage", storage, "--normals", "sphere", "--arithmetic", "float,half", "--backend", "jax")
        status, out, _ = run("quality", "--encoding", names, *words, "--count", "1048576", "--format", "json")
        assert status == 0
        rows |= {(storage, row["encoding"]): row for row in json.loads(out)}
    for storage, name, *figures in lines:
        pair = rows[storage, name], rows[storage, f"{name}:arithmetic=half"]
        means = [row["angle_mean_deg"] for row in pair]
        assert [float(text) for text in figures[:2]] == pytest.approx(means, abs=6e-5), name
        largest = [row["angle_max_deg"] for row in pair]
        assert [float(text) for text in figures[2:4]] == pytest.approx(largest, rel=0.03), name
        assert float(figures[4]) == pytest.approx(pair[1]["half_loss_percent"], rel=0.02, abs=0.06), name


@pytest.mark.slow
def test_the_mix_table_is_what_is_measured(run):
    """By the model: verdicts as they are, and shares of garbage to a tenth of a percent."""
    shape = r"^\| `(\w+)` \| (yes|no) \| ([\d.]+) \| (yes|no) \| ([\d.]+) \| (yes|no) \| ([\d.]+) \|$"
    lines = re.findall(shape, table("normalbench mix"), re.M)
    assert len(lines) == 12
    status, out, _ = run("mix", "--backend", "jax", "--format", "json")
    assert status == 0
    found = {line["encoding"]: line for line in verdicts_of_mixes(json.loads(out))}
    for name, *shown in lines:
        line = found[name]
        for use, verdict, said, share in zip(USES, VERDICTS.values(), shown[::2], shown[1::2], strict=True):
            assert said == line[verdict], (name, use)
            assert float(share) == pytest.approx(line[f"{use}_garbage_percent"], abs=0.1), (name, use)


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_the_motion_table_is_what_is_measured(run):
    """To within a few percent, and exactly 0 in world space."""
    lines = [re.findall(r"[\w.]+", line) for line in table("normalbench motion").splitlines()[3:]]
    assert len(lines) == 9
    names, axes = (",".join(dict.fromkeys(line[at] for line in lines)) for at in (0, 2))
    status, out, _ = run("motion", "--encoding", names, "--axis", axes, "--format", "json")
    assert status == 0
    rows = {(row["encoding"], row["space"], row["axis"], row["turn_deg"]): row for row in json.loads(out)}
    for *key, static, slowest, slow, usual, half, one, highlight, peak, reprojected in lines:
        found = [rows[*key, turn]["wobble_deg"] for turn in (0.01, 0.05, 0.25, 0.5, 1.0)]
        assert list(map(float, (slowest, slow, usual, half, one))) == pytest.approx(found, rel=0.01, abs=2e-3), key
        row = rows[*key, 0.25]
        assert float(static) == pytest.approx(row["static_rms_deg"], rel=0.005), key
        assert float(highlight) == pytest.approx(row["highlight_px"], rel=0.05, abs=6e-4), key
        assert float(peak) == pytest.approx(row["peak_percent"], rel=0.05, abs=6e-3), key
        # JSON has no infinity.
        left = row["reprojected_psnr_db"] or "infinite"
        assert reprojected == left or float(reprojected) == pytest.approx(left, rel=0.01), key


@pytest.mark.slow
def test_the_maps_table_is_what_is_measured(run):
    """To the digits shown, by the encoders that CI pins; and what it says of codes in tangent space."""
    shape = r"^\| `(\w+)` +\| `(\w+)` +\|" + r" +([\d.]+) \|" * 6 + "$"
    lines = re.findall(shape, table("normalbench maps"), re.M)
    assert len(lines) == 7
    rows = {}
    for encoding, normals in (("xy,hemi_octahedral,octahedral", "bumps,grain"), ("octahedral", "playground")):
        status, out, _ = run("maps", "--encoding", encoding, "--normals", normals, "--format", "json")
        assert status == 0
        rows |= {
            tuple(row[name] for name in ("encoding", "normals", "block", "swizzle")): row for row in json.loads(out)
        }
    for block, swizzle, *figures in lines:
        codes = (("xy", "bumps"), ("xy", "grain"), ("octahedral", "playground"))
        found = [rows[*code, block, swizzle][f"angle_{name}_deg"] for code in codes for name in ("mean", "max")]
        assert [float(text) for text in figures] == pytest.approx(found, rel=2e-3), (block, swizzle)
    means = [rows[name, "bumps", "bc5", "rg"]["angle_mean_deg"] for name in ("xy", "hemi_octahedral", "octahedral")]
    assert means == pytest.approx([0.463, 0.504, 0.574], abs=6e-4)


def test_the_light_table_is_what_is_measured():
    """By the model, which needs no device."""
    shape = r"^\| `(\w+)`[ \w()]*\| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$"
    lines = re.findall(shape, table("normalbench lights"), re.M)
    assert len(lines) == 7
    for name, *figures in lines:
        rows = equal_lights(Adder(LIGHT_BUFFERS[name], None), [1.0], [8, 64, 256])
        # Of channels that differ the table shows colours that lose most: not sRGB's alpha.
        found = {row["lights"]: row["model"] for row in rows if row["channel"] != "a"}
        for count, figure in zip((8, 64, 256), figures, strict=True):
            assert float(figure) == pytest.approx(found[count], abs=0.0005), f"{name}, {count} lights"


@pytest.mark.slow
def test_the_tune_table_is_what_is_measured(run):
    """Two of its rows, which stand for those that take longer."""
    named, figure = r"`(\w+)` +\| ", r" +([\d.]+) \|"
    lines = re.findall(rf"^\| {named * 3}[^|]+\|{figure * 3}$", table("normalbench tune"), re.M)
    assert len(lines) == 5
    for encoding, storage, normals, *figures in (lines[0], lines[3]):
        status, out, _ = run("tune", encoding, "--storage", storage, "--normals", normals, "--format", "json")
        (row,) = [row for row in json.loads(out) if row["quantity"] == "psnr_db"]
        measured = [row["published"], row["tuned"], row["gain"]]
        assert status == 0 and [float(text) for text in figures] == pytest.approx(measured, abs=0.02), encoding


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_the_light_image_table_is_what_is_measured(run):
    shape = r"^\| `(\w+)` +\| +([\d.]+) \| +([\d.]*) \|$"
    lines = re.findall(shape, table("normalbench lights image"), re.M)
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
    shape = r"^\| `(\w+)` +\| `(\w+)` +\|([^|]+)\|([^|]+)\|([^|]+)\|([^|]+)\|$"
    lines = re.findall(shape, table("normalbench depth"), re.M)
    assert len(lines) == 10
    (command,) = [line for line in COMMANDS if line.startswith("normalbench depth --near 0.1 --far 1000 --distance")]
    status, out, _ = run(*command.split()[1:], "--format", "json")
    rows = [row for row in json.loads(out) if row["distance"]]
    assert status == 0
    for name, storage, *shown in lines:
        for backend, tolerance in (("jax", 0.06), ("glsl", 0.125)):
            asked = (name, storage, backend)
            measured = [r["error_max"] for r in rows if (r["depth"], r["storage"], r["backend"]) == asked]
            assert [float(text) for text in shown] == pytest.approx(measured, rel=tolerance), asked


def test_the_frames_table_is_what_is_measured(run):
    """Every row of 32 bits, best first, as the command prints them."""
    shown = table("normalbench frames").splitlines()[3:]
    lines = [[cell.strip(" `%") for cell in line.split("|")[1:-1]] for line in shown]
    status, out, _ = run("frames", "--backend", "jax", "--format", "json")
    rows = [row for row in json.loads(out) if row["bits"] == 32]
    assert status == 0 and [line[:2] for line in lines] == [[row["encoding"], row["storage"]] for row in rows]
    angles = ("normal_max_deg", "tangent_max_deg", "rotation_mean_deg", "rotation_rms_deg", "rotation_max_deg")
    for line, row in zip(lines, rows, strict=True):
        expected = [*(row[name] for name in angles), row["effective_bits"], row["reached_rms_percent"]]
        assert [float(cell) for cell in line[2:]] == pytest.approx(expected, rel=2e-3, abs=6e-5), line


def test_the_vectors_table_is_what_is_measured(run):
    """By JAX to the two digits shown."""
    shown = table("normalbench vectors").splitlines()[3:]
    lines = [[cell.strip(" `%") for cell in line.split("|")[1:-1]] for line in shown]
    status, out, _ = run("vectors", "--backend", "jax", "--speed", "0.05,1,64", "--format", "json")
    assert status == 0 and len(lines) == 13
    rows = {(row["encoding"], row["storage"], row["speed"]): row for row in json.loads(out)}
    for encoding, storage, *cells in lines:
        slow, middle, fast = (rows[encoding, storage, speed] for speed in (0.05, 1, 64))
        figures = [slow["still_px"], slow["least_px"], *(row["error_mean_px"] for row in (slow, middle, fast))]
        assert float(cells[5]) == pytest.approx(slow["lost_percent"], abs=0.6), (encoding, storage)
        figures.append(middle["drift_px"])
        assert [float(cell) for cell in cells[:5] + cells[6:]] == pytest.approx(figures, rel=0.06), (encoding, storage)


def test_the_pipelines_it_shows_are_those_there_are():
    shown = dict(re.findall(r"^\| `(\w+)` +\| ([\w, ]+) \|$", table("normalbench list pipelines"), re.M))
    assert shown == {p.name: ", ".join(stage.name for stage in p.stages) for p in PIPELINES.values()}


@pytest.mark.slow
@pytest.mark.usefixtures("gl")
def test_the_tests_it_shows_pass(pytester):
    """With the encoding and the gates it shows, by its commands: the one that writes the baseline first."""
    for name, text in FILES.items():
        pytester.path.joinpath(name).write_text(text)
    tests = sum(text.count("def test_") for name, text in FILES.items() if name.startswith("test_"))
    gates = FILES["gates.toml"].count("[[gate]]")
    assert len(PYTEST) == 2
    for command in sorted(PYTEST, key=len, reverse=True):
        words = ["." if word == "tests" else word for word in shlex.split(command)[1:]]
        result = pytester.runpytest_subprocess(*words, "-p", "no:cacheprovider", "-p", "no:hypothesispytest")
        result.assert_outcomes(passed=tests + gates)


def anchors(text: str) -> set[str]:
    """What the headings of a page are linked by."""
    headings = re.findall(r"^#+ (.+)$", FENCE.sub("", text), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_what_it_links_to_is_there(path):
    for link in re.findall(r"\]\(([^)]+)\)", PAGES[path]):
        name, _, anchor = link.partition("#")
        target = (path.parent / name).resolve() if name else path
        assert target.is_file(), link
        assert not anchor or anchor in anchors(target.read_text()), link
        assert target.suffix != ".png" or target.stat().st_size > 10_000, link


def test_every_page_is_in_the_index():
    index = PAGES[ROOT / "docs/README.md"]
    assert all(f"({path.name})" in index for path in PAGES if path.name != "README.md")


def test_a_seed_is_a_random_seed():
    """Articles are named by author, title and year."""
    for path, text in PAGES.items():
        assert not re.search(r"\bseed \d", text), path.name


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


@pytest.mark.slow
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


@pytest.mark.slow
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
