"""Pairs that return half of the sphere: one function loses the other half, or the pair is designed for one half."""

import json

import pytest
import test_halves
from test_halves import DESIGNS, HALVES, OPEN, design
from typed import first_look

pytestmark = pytest.mark.usefixtures("gl")
_here = test_halves._here


def test_encoding_for_a_hemisphere_is_measured_on_that_hemisphere(run, tmp_path):
    """Figures for each half agree with the figures for z >= 0, and a message names the half."""
    means = {}
    for half in HALVES:
        (tmp_path / "dir.glsl").write_text(design("hemi-octahedral", half))
        words = ("--storage", "rg8", "--normals", "hemisphere", "--count", "65536", "--backend", "glsl")
        status, out, err = run("quality", "--encoding", "dir.glsl", *words, "--format", "json")
        (row,) = json.loads(out)
        means[half] = row["angle_mean_deg"]
        assert status == 0 and f"assumed to be made only for normals with {half}" in err
        assert row["domain"] == "hemisphere" and row["encoding"] == "dir"
    assert min(means.values()) == pytest.approx(max(means.values()), rel=0.01)
    assert means["z >= 0"] == pytest.approx(0.239, abs=0.003)


@pytest.mark.parametrize("half", ["y >= 0", "z <= 0"])
def test_shader_code_for_a_hemisphere_keeps_its_own_axes(run, tmp_path, half):
    """Shader code is written in the axes of the user's file, although tables rotate the encoding."""
    (tmp_path / "dir.glsl").write_text(design("hemi-octahedral", half))
    status, out, _ = run("code", "dir.glsl", "--storage", "rg8", "--to", "glsl")
    assert status == 0 and f"Normals: unit vectors with {half}." in out
    (tmp_path / "written.glsl").write_text(out)
    look = first_look(tmp_path / "written.glsl")
    axis, side = look.get("half", (2, 1))
    assert f"{'xyz'[axis]} {'>=' if side > 0 else '<='} 0" == half and look["wrong"] == []


# Each design of a half has all six; of these two are enough, of which one is turned and mirrored.
TWO = ("z >= 0", "x <= 0")


@pytest.mark.drawn(3)
@pytest.mark.parametrize("half", TWO)
@pytest.mark.parametrize("what", OPEN)
def test_encoding_finite_only_on_its_hemisphere_is_assumed_to_be_for_it(tmp_path, monkeypatch, what, half):
    monkeypatch.setitem(DESIGNS, what, OPEN[what])
    (tmp_path / "dir.glsl").write_text(design(what, half))
    for domain in ("", "hemisphere"):
        look = first_look(tmp_path / "dir.glsl", domain)
        axis, side = look.get("half", (2, 1))
        assert look["wrong"] == [] and look["domain"] == "hemisphere" and "not finite" in look["hole"], look
        assert f"{'xyz'[axis]} {'>=' if side > 0 else '<='} 0" == half
    look = first_look(tmp_path / "dir.glsl", "sphere")
    assert "not finite" in (look.get("broken") or look["wrong"][0])


def test_a_hole_in_the_half_that_round_trips_remains_a_finding(tmp_path):
    """Rounding makes the square root's argument negative on the rim; the NaN remains a finding for z >= 0."""
    text = "vec2 dir_encode(vec3 n) { return n.xy * 0.5 + 0.5; }\n"
    text += "vec3 dir_decode(vec2 e) { e = e * 2.0 - 1.0; return vec3(e, sqrt(1.0 - dot(e, e))); }\n"
    (tmp_path / "dir.glsl").write_text(text)
    look = first_look(tmp_path / "dir.glsl")
    assert look["domain"] == "hemisphere" and "not finite" in look["wrong"][0]
