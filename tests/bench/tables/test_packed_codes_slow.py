"""An encoder that packs into an integer, in every table: the known figures of truncated 8:8:8, or a line that says
why figures are missing."""

import json

import pytest
from manual import ROOT

pytestmark = pytest.mark.usefixtures("gl", "slang")


FILE = str(ROOT / "tests" / "inputs" / "encoders" / "uint_only.hlsl")


# An answer of few codes and normals, and of one scene.
SMALL_ANSWER = ("--count", "4096", "--scene", "studio")


INTEGER = "an integer cannot be filtered: decode the texels, then weigh the normals"


def rows(run, *asked):
    status, out, err = run(*asked, "--format", "json")
    assert status == 0, err
    return [row for row in json.loads(out) if row["encoding"] == "uint_only.hlsl"], err


def test_quality_counts_the_used_bits_and_names_the_best_encoding(run):
    asked = ("--normals", "sphere", "--storage", "rg8", "--backend", "glsl", "--count", "65536")
    (row,), _ = rows(run, "quality", "--encoding", FILE, *asked)
    assert (row["bits"], row["codes"], row["storage"]) == (24, 2**24, "bits32")
    assert row["limit_mean_deg"] < row["best_mean_deg"] < 0.0215 < row["angle_mean_deg"]
    assert row["best_codec"].partition("/")[2].startswith("rgb8_12_12")


def test_a_float_that_holds_integers_counts_only_their_bits(run):
    file = FILE.replace("uint_only", "float")
    asked = ("--normals", "hemisphere", "--storage", "rg8", "--backend", "glsl", "--count", "4096", "--format", "json")
    _, out, _ = run("quality", "--encoding", file, *asked)
    assert json.loads(out)[0]["bits"] == 16


def test_render_has_an_integer_target_next_to_the_layout(run):
    (row,), _ = rows(run, "render", "--encoding", FILE, "--storage", "rg8", "--size", "160x120")
    assert row["storage"] == "bits32" and row["invalid"] == 0
    assert 47 < row["normal_psnr_db"] < 51 and 22 < row["psnr_db"] < 32


def test_a_layout_has_its_own_target_for_an_integer(run, tmp_path):
    (tmp_path / "mine.hlsl").write_text((ROOT / "tests" / "inputs" / "encoders" / "uint_only.hlsl").read_text())
    layout = """encoding = "mine.hlsl"
targets = [{ format = "FORMAT", holds = "normal.x normal.y" },
           { format = "rgba8", holds = "albedo.r albedo.g albedo.b kind" },
           { format = "rgba8", holds = "specular.r specular.g specular.b power" }]"""
    (tmp_path / "right.toml").write_text(layout.replace("FORMAT", "bits32"))
    (tmp_path / "wrong.toml").write_text(layout.replace("FORMAT", "rg8"))
    status, out, err = run("render", "--layout", str(tmp_path / "right.toml"), "--size", "160x120", "--format", "json")
    assert status == 0 and json.loads(out)[0]["storage"] == "bits32", err
    status, _, err = run("render", "--layout", str(tmp_path / "wrong.toml"), "--size", "160x120")
    assert status == 2 and "packs 32 bits itself and needs the format bits32" in err


def test_cost_counts_only_the_functions(run):
    """Encoding converts three numbers to integers; no integers are converted to halves."""
    cost_rows, _ = rows(run, "cost", "--encoding", FILE, "--isa", "--family", "navi21", "--stage", "fragment")
    assert {row["operation"]: row["conversion"] for row in cost_rows} == {"encode": 3, "decode": 0}


def test_mix_decodes_before_it_mixes(run):
    asked = ("--normals", "sphere", "--angle", "1", "--edge", "none", "--backend", "glsl")
    mixed, err = rows(run, "mix", "--encoding", FILE, *asked)
    has_figures = {row["operation"]: row["angle_mean_deg"] is not None for row in mixed}
    assert has_figures == {
        **dict.fromkeys(("filter", "mip_2x2", "mip_4x4", "resolve", "blend", "detail"), False),
        **dict.fromkeys(("resolve_decoded", "blend_decoded", "upsample"), True),
    }
    assert {row["skipped"] for row in mixed} == {INTEGER, None} and INTEGER in err
    assert {(row["filterable"], row["upsamplable"], row["filterable_across"]) for row in mixed} == {("no", "yes", None)}


def test_motion_measures_the_wobble_of_an_integer(run):
    asked = ("--storage", "rg8", "--frames", "4", "--count", "4096", "--space", "view", "--turn", "0.5")
    motion_rows, _ = rows(run, "motion", "--encoding", FILE, *asked)
    assert {row["storage"] for row in motion_rows} == {"bits32"}
    assert all(row["static_rms_deg"] == pytest.approx(0.367, rel=0.02) for row in motion_rows)


def test_pick_ranks_an_integer_among_encodings_of_the_same_size(run):
    """The integer is compared with the catalogue in the same texel, and left out if texels have another size."""
    few = ("--encoding", "octahedral,xyz_largest", *SMALL_ANSWER)
    (row,), _ = rows(run, "pick", "--storage", "rgba8", *few, "--against", FILE)
    assert (row["place"], row["bits"], row["free_bits"], row["slots_once"]) == ("against", 24, 8, 25)
    (row,), err = rows(run, "pick", "--storage", "rg8,rgba8", "--encoding", f"{FILE},octahedral", *SMALL_ANSWER)
    assert row["asked"] == "rgba8"
    assert "uint_only.hlsl packs into a 4-byte integer; texels of rg8 have a different size" in err


def test_pick_leaves_out_an_integer_if_codes_are_filtered(run):
    words = ("--storage", "rgba8", "--encoding", f"{FILE},xyz_renormalised", "--needs", "filter")
    (row,), _ = rows(run, "pick", *words, *SMALL_ANSWER)
    assert row["left_out"] == "cannot be filtered" and INTEGER in row["cannot_mix"]


def test_a_gate_checks_the_figure_of_an_integer(run, tmp_path):
    (tmp_path / "mine.hlsl").write_text((ROOT / "tests" / "inputs" / "encoders" / "uint_only.hlsl").read_text())
    gate = (
        '[[gate]]\ntable = "quality"\nencoding = "mine.hlsl"\nstorage = "rg8"\nnormals = "sphere"\nbackend = "glsl"\n'
    )
    for limit, status in (("0.35", 0), ("0.2", 1)):
        (tmp_path / "gates.toml").write_text(f'{gate}count = 65536\nangle_mean_deg = "at most {limit}"\n')
        exit_code, out, err = run("check", str(tmp_path / "gates.toml"))
        assert exit_code == status and "mine.hlsl bits32" in out, out + err
