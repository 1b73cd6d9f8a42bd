"""Diagnoses of users' encoders: the likely error in a wrong encoder, and only the domain of a correct encoder."""

import json

import pytest
from test_diagnoses import FLAT, faces, looked_at, octahedral


@pytest.mark.usefixtures("gl")
def test_doctor_reports_the_error_and_plots_the_sphere(run, tmp_path):
    path, picture = tmp_path / "mine.glsl", tmp_path / "sphere.png"
    path.write_text(octahedral(result="normalize(n.yxz)"))
    status, out, err = run("doctor", str(path), "--plot", str(picture), "--format", "json")
    assert status == 1 and "x and y swapped" in out and str(picture) in err
    assert picture.read_bytes().startswith(b"\x89PNG")
    path.write_text(octahedral())
    status, out, err = run("doctor", str(path))
    assert (status, err) == (0, "") and "No problems found." in out
    path.write_text(octahedral().replace("mine_", "spherical_"))
    status, out, err = run("doctor", str(path))
    assert (status, err) == (0, "") and "an encoding named spherical already exists" in " ".join(out.split())
    path.write_text(FLAT)
    status, out, err = run("doctor", str(path))
    assert (status, err) == (0, "") and "assumed to be made only for normals with z >= 0" in " ".join(out.split())


@pytest.mark.usefixtures("gl")
def test_error_in_a_component_with_few_values_is_not_blamed_on_other_components(tmp_path):
    look = looked_at(tmp_path, faces("f / 6.0", "e.z * 5.0"))
    assert look["is_unit"] and len(look["wrong"]) == 1 and "are not a pair" in look["wrong"][0]


@pytest.mark.usefixtures("gl")
def test_doctor_prints_its_verdict_first_and_notes_separately(run, tmp_path):
    """A note, such as a guess about the range of codes, is not a finding."""
    path = tmp_path / "mine.glsl"
    path.write_text(octahedral("p * 0.5 + 0.5", "e = e * 2.0 - 1.0;"))
    status, out, _ = run("doctor", str(path))
    verdict, about, notes, note = out.rstrip("\n").split("\n\n")
    assert (status, verdict, notes) == (0, "No problems found.", "notes:")
    assert about == "file mine.glsl, encoding mine, domain sphere, functions mine_encode:mine_decode"
    assert note.startswith("- its codes are in [0, 1]")
    rows = json.loads(run("doctor", str(path), "--format", "json")[1])
    assert [row["kind"] for row in rows] == ["verdict", "note"] and rows[0]["finding"] == "No problems found."
    path.write_text(octahedral("p * 0.5 + 0.5", "e = e * 2.0 - 1.0;", "normalize(n.yxz) * 1.5"))
    status, out, _ = run("doctor", str(path))
    verdict, about, findings, notes, note = out.rstrip("\n").split("\n\n")
    assert (status, verdict, notes) == (1, "2 findings", "notes:") and findings.count("\n- ") == 1, out
    rows = json.loads(run("doctor", str(path), "--format", "json")[1])
    assert [row["kind"] for row in rows] == ["finding", "finding", "note"]
    written = tmp_path / "said.md"
    assert run("doctor", str(path), "-o", str(written))[0] == 1 and written.read_text().startswith("2 findings\n\n")
