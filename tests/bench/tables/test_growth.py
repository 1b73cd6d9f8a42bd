"""How the time grows: exponents of known times, what is timed, and bad input."""

import json
import re

import pytest

from normalbench.bench.ground.output.errors import MissingError, UsageError
from normalbench.bench.measures.metrics.growth import exponent
from normalbench.bench.tables.growth import measure
from normalbench.bench.tables.growth.measure import Case
from normalbench.bench.tables.growth.table import KINDS, GrowthOptions
from normalbench.bench.tables.growth.work import WORK, cases, notes, with_exponents

ROW = {"over": "normals", "skipped": None}


def test_the_exponent_is_the_slope_in_logarithms():
    """By hand: 3 x^2 has 2, a constant 0; through 1, 10 and 1000 seconds at 1, 10 and 100 the slope is 1.5."""
    assert exponent([1, 2, 4], [3, 12, 48]) == pytest.approx(2)
    assert exponent([5, 50], [7, 7]) == pytest.approx(0)
    assert exponent([1, 10, 100], [1, 10, 1000]) == pytest.approx(1.5)
    assert exponent([5, 5], [1, 2]) is None


def test_each_row_has_the_exponent_from_the_next_smaller_size():
    """Whatever their order; not across kinds, nor from a size that was not timed."""
    times = [("normals", 100, 4.0), ("normals", 10, 2.0), ("lights", 1, None), ("lights", 10, 1.0), ("lights", 40, 4.0)]
    rows = [{"over": over, "size": size, "seconds": seconds} for over, size, seconds in times]
    found = {(row["over"], row["size"]): row["exponent"] for row in with_exponents(rows)}
    assert found.pop(("normals", 100)) == pytest.approx(0.30103)
    assert found.pop(("lights", 40)) == pytest.approx(1)
    assert set(found.values()) == {None} and len(found) == 3
    assert [*notes(rows)] == [
        "normals: time grows as normals^0.30 from 10 to 100",
        "lights: time grows as lights^1.00 from 10 to 40",
    ]


def test_the_usual_sizes_of_each_kind_are_ten_times_apart_or_more():
    for name, kind in KINDS.items():
        assert kind.usual[-1] >= 100 * kind.usual[0], name
        assert all(kind.least <= size <= kind.most for size in kind.usual), name
        assert all(measure.rounded(name, size) == size for size in kind.usual), name


def test_codes_are_rounded_to_what_two_numbers_of_equal_bits_have_and_timed_once():
    made = cases(GrowthOptions(over="codes", sizes="60000,65536,2^20"))
    assert [case.size for case in made] == [2**16, 2**20]


@pytest.mark.usefixtures("gl")
def test_what_is_timed_is_as_large_as_said(monkeypatch):
    """Codecs of a table, normals of a row, objects and lights of a frame, codes of a search."""
    rows, searched, frames = [], [], []
    monkeypatch.setattr(measure, "least_times", lambda works: [works[0](), [1.0]][1])
    monkeypatch.setattr(measure.quality, "rows", lambda cases, _: rows.append(cases) or [])
    monkeypatch.setattr(measure, "worst_case", type("", (), {"__wrapped__": searched.append}))
    monkeypatch.setattr(measure, "_frame", lambda *sizes: frames.append(sizes) or 1.0)
    for over, size in (("normals", 1000), ("codecs", 7), ("codes", 4**6), ("objects", 30), ("lights", 50)):
        assert measure.measure(Case(over, size))["microseconds_each"] == pytest.approx(1e6 / size)
    assert [[case.normal_set.count for case in cases] for cases in rows] == [[1000], [measure.NORMALS] * 7]
    assert len({case.codec.encoding.name for case in rows[1]}) == 7
    assert [codec.codes for codec in searched] == [4**6]
    assert frames == [(30, measure.LIGHTS), (measure.OBJECTS, 50)]


def test_without_a_gl_device_the_row_says_so(monkeypatch):
    def missing():
        raise MissingError("no GL driver")

    monkeypatch.setattr(measure, "require_device", missing)
    row = measure.measure(Case("lights", 10))
    assert row["skipped"] == "no GL driver" and row["seconds"] is None
    assert [*WORK.warnings([row, row])] == ["lights: not timed: no GL driver"]


@pytest.mark.parametrize(
    "options, said",
    [
        ({"over": "pixels"}, "unknown kind 'pixels'"),
        ({"sizes": "5"}, "--sizes 5: sizes are of one kind; name it, such as --over normals"),
        ({"over": "codes", "sizes": "2^40"}, "--sizes 2^40: whole numbers from 256 to 16777216"),
        ({"over": "lights", "sizes": "0"}, "--sizes 0: whole numbers from 1 to"),
    ],
)
def test_bad_input_is_one_line(options, said):
    with pytest.raises(UsageError, match=re.escape(said)) as error:
        cases(GrowthOptions(**options))
    assert "\n" not in str(error.value)


@pytest.mark.usefixtures("gl")
def test_the_command_writes_rows_and_a_plot(run, tmp_path):
    plot = tmp_path / "growth.png"
    status, out, _ = run("growth", "--over", "lights", "--sizes", "1,4", "--plot", str(plot), "--format", "json")
    rows = json.loads(out)
    assert status == 0 and [row["size"] for row in rows] == [1, 4]
    assert all(row["seconds"] > 0 for row in rows) and rows[1]["exponent"] is not None
    assert plot.stat().st_size > 10_000
