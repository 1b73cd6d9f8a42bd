"""`normalbench pick`: the answer to any question follows from the rows, and the sentences agree with the rows."""

import json
import re
from collections import Counter

import pytest
from manual import ROOT
from typed import codecs_named

from normalbench.bench.tables.pick.answer import answered, groups
from normalbench.bench.tables.pick.charts import charts
from normalbench.bench.tables.pick.sentences import sentences
from normalbench.bench.tables.quality.table import COMMON
from normalbench.bench.tables.registry import TABLES


def test_fixed_size_codes_keep_their_size_in_a_larger_storage():
    """An index of 65536 directions still has 16 bits in a storage of 20 bits."""
    codec = codecs_named("spherical_fibonacci", "rgb10a2", "nearest")[0]
    assert codec.code_bits == 16 and codec.bits == 20
    assert codecs_named("octahedral", "rgb10a2", "nearest")[0].code_bits is None
    about = {"asked": "rgb10a2", "storage": "rgb10a2", "normals": "sphere", "scene": "studio", "aim": "angle"}
    about |= {"encoding": codec.encoding.name, "domain": "sphere", "family": "navi21", "readers": 4, "worth": 3.0}
    about |= {"angle_mean_deg": 0.3, "angle_max_deg": 0.6, "worst_normal": "(0.0, 0.0, 1.0)", "invalid": 0}
    about |= {"encode_slots": 20, "decode_slots": 20, "slots_once": 40, "slots": 100, "enough": 0.3, "look_ups": True}
    about |= {"bits": codec.bits, "free_bits": 12, "bytes": 4}
    for code_bits, text in ((codec.code_bits, "20 bits, for codes of 16; 12 are free"), (None, "20 bits; 12 are free")):
        (group,) = groups(answered([TABLES["pick"].empty() | about | {"code_bits": code_bits}])).values()
        assert text in " ".join(sentences(group))


def test_the_chart_of_an_answer_shows_the_share_of_normals_below_each_angle():
    """The area is between the smallest and the largest share. An encoding without a histogram has no line."""
    about = {"asked": "rg8", "storage": "rg8", "normals": "sphere", "scene": "studio", "bits": 16, "aim": "angle"}
    about |= {"angle_mean_deg": 0.3, "slots_once": 9, "family": "navi21", "domain": "sphere"}
    counts = {"octahedral": "0.25:1 0.28125:2 0.5:1", "spheremap": "0.25:3 2:1", "spherical": None}
    rows = [TABLES["pick"].empty() | about | {"encoding": n, "angle_counts": text} for n, text in counts.items()]
    _, spread = charts(rows)
    assert spread.name == "spread-0"
    assert spread.title == (
        "rg8, on sphere: octahedral has errors below 0.31 degrees for half of the normals, below 0.56 degrees for 99%"
    )
    lines = [[(row["x"], row["y"]) for row in spread.rows if row["codec"] == f"{name} rg8"] for name in counts]
    assert lines[0] == [(0.28125, 25.0), (0.3125, 75.0), (0.5625, 100.0), (2.25, 100.0)]
    assert lines[1] == [(0.28125, 75.0), (0.3125, 75.0), (0.5625, 75.0), (2.25, 100.0)] and lines[2] == []
    area = spread.marks[0].rows
    assert [(row["low"], row["y"]) for row in area] == [(25.0, 75.0), (75.0, 75.0), (75.0, 100.0), (100.0, 100.0)]


def test_no_qualifying_encoding_is_reported_with_status_1(run):
    status, out, err = run("pick", "--encoding", "octahedral", "--storage", "rg8", "--most-instructions", "1")
    assert status == 1 and "no answer for rg8 on sphere" in err and "no encoding qualifies" not in err
    assert "octahedral (more than 1 issue slots)" in out.replace("\n  ", " ")


@pytest.mark.parametrize(
    "words, said",
    [
        (("--aim", "beauty"), "unknown aim 'beauty'; known: angle, worst, image, cost"),
        (("--family", "navi99"), "unknown family 'navi99'; known: all, polaris10"),
        (("--domain", "cube"), "unknown domain 'cube'; known: sphere, tangent, terrain, map, view"),
        (
            ("--domain", "hemisphere"),
            "--domain hemisphere: ambiguous; use tangent, terrain or map for normals with z >= 0",
        ),
        (("--power", "47,none"), "--power 47,none: expected numbers from 1 to 2048"),
        (("--most-instructions", "-1"), "--most-instructions -1: out of range; use 0 to 1000000"),
        (("--readers", "65"), "--readers 65: out of range; use 0 to 64"),
        (("--worth", "0"), "--worth 0: out of range; use more than 0, up to 100 dB"),
        (("--enough", "-1"), "--enough -1: out of range; use 0 to 360 degrees"),
        (("--bytes", "3"), "unknown number of bytes '3'; known: all, 2, 4, 8, 16"),
        (("--encoding", "xyz", "--storage", "rg8"), "xyz: 3 components, but RG8 has 2 channels"),
        (("--rounding", "up"), "unknown rounding 'up'; known: all, nearest, truncate, truncate_half"),
        (("--rounding", "dithered"), "--rounding dithered: this command adds no noise"),
        (
            ("--encoding", "octahedral", "--storage", "rg16f", "--rounding", "truncate_half"),
            "octahedral: RG16F stores floats, but truncate_half is for fixed point",
        ),
    ],
)
def test_invalid_question_is_a_one_line_error(run, words, said):
    status, out, err = run("pick", *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err


def test_the_default_answer_has_at_most_a_dozen_lines():
    kept = json.loads((ROOT / "tests/manual_tables/kept/answer-normalbench-pick.json").read_text())["lines"]
    counts = Counter(storage for storage, _ in kept)
    assert set(counts) == {"rg8", "rgb10a2"} and max(counts.values()) <= 12, counts


def test_a_run_measures_the_encodings_in_the_default_answer():
    """The recommended encodings are in every table of a run with several encodings, the alternatives in quality,
    render and cost."""
    kept = ROOT / "tests/manual_tables/kept/answer-normalbench-pick.json"
    texts = [line[1] for line in json.loads(kept.read_text())["lines"]]
    taken = {match[1] for text in texts if (match := re.search(r": take (\w+)\.", text))}
    ladder = {
        match[1]
        for text in texts
        if (match := re.match(r"(\w+) +(?:more accurate|most accurate|cheaper|fewer bits) ", text))
    }
    assert taken == {"octahedral", "xyz_largest"} and ladder >= {"octahedral_precise", "spherical_fibonacci"}
    assert taken | ladder <= set(COMMON) and len(COMMON) <= 20
    for name in ("quality", "render", "cost", "mix", "effects"):
        usual = ",".join(usual["encoding"] for usual in TABLES[name].usual).split(",")
        assert taken <= set(usual), name


CODES = "xy,xy_sign,spherical,spheremap,octahedral,octahedral_precise,latitude_longitude,hemi_octahedral,per_pixel_view"


CODES += ",xyz,xyz_renormalised,cube"


SMALL = ("pick", "--encoding", CODES, "--count", "4096", "--aim", "image")


@pytest.fixture(scope="module")
def rows(gl, radv, tmp_path_factory):  # noqa: ARG001 # they skip where this machine lacks them
    """Rows that the command measures for a dozen encodings; with --aim image all that qualify have an image."""
    from normalbench.bench.door.cli import app

    output = tmp_path_factory.mktemp("pick") / "rows.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["normalbench", *SMALL, "--format", "json", "-o", str(output)])
        assert app.main() == 0
    return json.loads(output.read_text())
