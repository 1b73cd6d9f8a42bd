"""CONTRIBUTING.md: its examples can be added to a copy of the code as described, and its commands exist."""

import csv
import io
import json

import pytest
from contributing import EXAMPLES, a_copy_of_the_rooms, normalbench_in


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """The code with every example, except the table and its chart, which test_new_table.py uses."""
    folder = tmp_path_factory.mktemp("copy")
    package = a_copy_of_the_rooms(folder)
    for name, example in EXAMPLES.items():
        if name not in ("a table", "a chart"):
            example.add_to(package)
    return folder


SMALL = ("--size", "64x48", "--repeats", "0")


def rows_of(folder, *arguments):
    done = normalbench_in(folder, *arguments, "--format", "csv")
    assert done.returncode == 0, done.stderr
    return list(csv.DictReader(io.StringIO(done.stdout)))


@pytest.mark.usefixtures("gl")
def test_adding_an_encoding_takes_a_pair_and_a_line(copy):
    """The encoding, a stereographic projection of half the sphere, has a row in both languages."""
    rows = rows_of(copy, "quality", "--encoding", "paraboloid", "--storage", "rg16", "--normals", "hemisphere")
    figures = {row["backend"]: float(row["psnr_db"]) for row in rows}
    assert figures == {"jax": pytest.approx(99.18, abs=0.01), "glsl": pytest.approx(99.18, abs=0.01)}


@pytest.mark.usefixtures("gl")
def test_adding_a_storage_takes_one_line_and_adding_a_column_takes_two(copy):
    """In both languages the new 5:5 storage has the same figures as 5:5 bits in two bytes."""
    rows = rows_of(copy, "quality", "--encoding", "octahedral", "--storage", "rgb5_a1,rg8_5_5", "--normals", "sphere")
    figures = {(row["storage"], row["backend"]): float(row["psnr_db"]) for row in rows}
    assert len(figures) == 4 and max(figures.values()) - min(figures.values()) < 1e-4, figures
    for row in rows:
        assert float(row["angle_rms_minutes"]) == pytest.approx(60 * float(row["angle_rms_deg"]), rel=1e-5)


@pytest.mark.usefixtures("gl")
def test_adding_a_kind_takes_a_class_a_pair_a_module_and_six_lines(copy):
    """The new code is compared with its twin, and the function names begin with the kind's name."""
    (row,) = json.loads(normalbench_in(copy, "code", "metres", "--check", "--to", "glsl", "--format", "json").stdout)
    assert (row["encoding"], row["storage"], row["differing"]) == ("metres", "r16", 0), row
    assert "float height_encode(float x)" in normalbench_in(copy, "code", "metres", "--to", "glsl").stdout
    (copy / "mine.glsl").write_text(
        "float EncodeHeightmap(float x) { return x; }\nfloat DecodeHeightmap(float e) { return e; }\n"
    )
    done = normalbench_in(copy, "code", "mine.glsl", "--of", "height")
    assert (done.returncode, done.stdout) == (
        2,
        "",
    ) and "mine.glsl: only the catalogue's encodings of heights can be measured" in done.stderr


@pytest.mark.usefixtures("gl")
def test_adding_a_scene_takes_a_file_and_two_lines(copy):
    """The scene is drawn: its marbles are more accurate with 16 bits per number than with 8."""
    rows = rows_of(copy, "render", "--scene", "marbles", "--encoding", "octahedral", "--storage", "rg8,rg16", *SMALL)
    psnr = {row["storage"]: float(row["psnr_db"]) for row in rows}
    assert psnr["rg16"] > psnr["rg8"] + 20 > 40, psnr


@pytest.mark.usefixtures("gl")
def test_adding_an_effect_takes_a_pair_and_a_line(copy):
    """The effect is listed, and measured with its setting."""
    assert "dimmed" in normalbench_in(copy, "list", "effects").stdout
    arguments = ("--encoding", "octahedral", "--storage", "rg8", "--scene", "playground", "--size", "64x48")
    rows = rows_of(copy, "effects", "--effect", "dimmed:strength=0.25", *arguments)
    assert rows and all(row["effect"] == "dimmed:strength=0.25" and float(row["psnr_db"]) > 20 for row in rows), rows


@pytest.mark.usefixtures("gl")
def test_adding_a_language_takes_a_writer_a_module_and_two_lines(copy):
    """The file in the new language is run before it is written."""
    done = normalbench_in(copy, "code", "octahedral", "--storage", "rg8", "--to", "signed", "-o", "made")
    assert done.returncode == 0, done.stderr
    (path,) = (copy / "made").iterdir()
    text = path.read_text()
    assert path.name == "octahedral_rg8.signed.glsl" and "// Written by an example." in text
    assert "texels of 65536 normals" in " ".join(text.replace("//", "").split())
    arguments = ("--check", "octahedral", "--storage", "rg8", "--to", "signed", "--format", "json")
    done = normalbench_in(copy, "code", *arguments)
    assert "signed" in done.stdout and json.loads(done.stdout), done.stderr
