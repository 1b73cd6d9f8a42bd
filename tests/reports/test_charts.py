"""Charts as values: a file and the page show the same marks, axes and labels of one."""

import itertools
import json
import re

import pytest
from both_ways import rows_of_tables
from matplotlib import pyplot
from PIL import Image

from normalbench.bench.tables.registry import TABLES
from normalbench.reports.charts import draw, wire
from normalbench.reports.charts.chart import (
    Axis,
    Chart,
    Kind,
    Mark,
    Names,
    Scale,
    apart,
    lines_apart,
)

ROWS = rows_of_tables()


HOSTILE = "$a\\b\"'</script>"


def a_chart(**more) -> Chart:
    """Lines of two codecs over a logarithmic axis, with names at their ends."""
    rows = [
        {"codec": codec, "bits": bits, "x": x, "y": x * bits}
        for codec, bits in (("xy rg8", 16), (HOSTILE, 24))
        for x in (1.0, 10.0, 100.0)
    ]
    about = {"name": "made", "title": "A finding", "subtitle": "what it is", "description": "It is made up."}
    about |= {"x": Axis(title="pixels", scale=Scale.LOG), "y": Axis(title="error, degrees")}
    about |= {"rows": tuple(rows), "colour": Names("bits", (16, 24), "bits")}
    line = Mark(kind=Kind.LINES, by=("codec",), colour="bits", tips=(("codec", "codec"),))
    end = Mark(kind=Kind.ENDS, by=("codec",), text="codec", colour="bits")
    return Chart(**about | {"marks": (line, end)} | more)


def test_a_matplotlibrc_changes_no_chart(tmp_path, monkeypatch):
    """One in the current folder may be a stranger's: LaTeX is a program, and reads other files."""
    draw.write([a_chart()], (tmp_path / "before.png", "png"))
    monkeypatch.setitem(pyplot.rcParams, "text.usetex", True)
    monkeypatch.setitem(pyplot.rcParams, "figure.facecolor", "red")
    draw.write([a_chart()], (tmp_path / "after.png", "png"))
    assert (tmp_path / "before.png").read_bytes() == (tmp_path / "after.png").read_bytes()
    assert pyplot.rcParams["text.usetex"], "the settings of whoever calls stay"


def test_an_axis_of_angles_says_degrees():
    """Both ways show one value, so that a wrong unit would be the same in both."""
    titles = {chart.x.title for chart in TABLES["quality"].work.charts(ROWS["quality"])}
    assert titles == {"angle between normal and decode, degrees"}


def test_a_file_says_finding_units_and_names_and_is_the_same_each_time(tmp_path):
    texts = []
    for name in ("a.svg", "b.svg"):
        draw.write([a_chart()], (tmp_path / name, "svg"))
        texts.append(re.sub(r"<dc:date>.*</dc:date>", "", (tmp_path / name).read_text()))
    assert texts[0] == texts[1] and "<script" not in texts[0]
    for said in ("A finding", "what it is", "pixels", "error, degrees", "xy rg8"):
        assert f">{said}</text>" in texts[0], said


def test_several_charts_are_one_file(tmp_path):
    for count in (1, 2):
        draw.write([a_chart()] * count, (tmp_path / f"{count}.png", "png"))
    with Image.open(tmp_path / "1.png") as one, Image.open(tmp_path / "2.png") as two:
        assert one.width == two.width and two.height == pytest.approx(2 * one.height, abs=2)


def test_names_at_ends_keep_apart_and_in_order():
    axis = Axis(title="", domain=(0.0, 1.0))
    values = [0.5, 0.51, 0.49, 0.9]
    shares = lines_apart(axis, values, 100.0, 10.0)
    assert shares[2] < shares[0] < shares[1] and shares[1] - shares[0] == pytest.approx(0.1)
    assert shares[3] == pytest.approx(0.9) and sum(shares[:3]) == pytest.approx(1.5)
    assert apart([0.0, 0.0, 5.0], 1.0) == [-0.5, 0.5, 5.0]
    rows = tuple({"codec": f"c{n}", "x": x, "y": 1.0 + n / 1000} for n in range(12) for x in (1.0, 2.0))
    figure = draw.figure([a_chart(rows=rows, colour=None, marks=(Mark(kind=Kind.ENDS, by=("codec",), text="codec"),))])
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    pyplot.close(figure)
    tops = sorted((box.y0 + box.y1) / 2 for box in boxes)
    assert min(b - a for a, b in itertools.pairwise(tops)) >= 0.9 * 9.5 * figure.dpi / 72


def test_a_specification_is_plain_data():
    text = json.dumps(wire.spec(a_chart()), allow_nan=False)
    assert wire.codecs(json.loads(text)) == {"xy rg8", HOSTILE}
