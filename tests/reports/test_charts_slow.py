"""Charts as values: a file and the page show the same marks, axes and labels of a chart."""

import itertools
import re

import pytest
from matplotlib import pyplot
from PIL import Image
from test_charts import HOSTILE, ROWS, a_chart

from normalbench.bench.tables.registry import TABLES
from normalbench.reports.charts import draw, wire
from normalbench.reports.charts.chart import (
    ALL,
    Axis,
    Kind,
    Mark,
    Names,
    Scale,
    Shades,
    Switch,
    apart,
    distinct,
    lines_apart,
)


def test_a_matplotlibrc_does_not_change_charts(tmp_path, monkeypatch):
    """The file in the current folder may come from a stranger, and LaTeX, which it can turn on, reads other files."""
    draw.write([a_chart()], (tmp_path / "before.png", "png"))
    monkeypatch.setitem(pyplot.rcParams, "text.usetex", True)
    monkeypatch.setitem(pyplot.rcParams, "figure.facecolor", "red")
    draw.write([a_chart()], (tmp_path / "after.png", "png"))
    assert (tmp_path / "before.png").read_bytes() == (tmp_path / "after.png").read_bytes()
    assert pyplot.rcParams["text.usetex"], "the settings of whoever calls stay"


def test_file_contains_finding_units_and_names_and_is_reproducible(tmp_path):
    texts = []
    for name in ("a.svg", "b.svg"):
        draw.write([a_chart()], (tmp_path / name, "svg"))
        texts.append(re.sub(r"<dc:date>.*</dc:date>", "", (tmp_path / name).read_text()))
    assert texts[0] == texts[1] and "<script" not in texts[0]
    for text in ("A finding", "what it is", "pixels", "error, degrees", "xy rg8"):
        assert f">{text}</text>" in texts[0], text


def test_several_charts_are_written_to_one_file(tmp_path):
    for count in (1, 2):
        draw.write([a_chart()] * count, (tmp_path / f"{count}.png", "png"))
    with Image.open(tmp_path / "1.png") as single, Image.open(tmp_path / "2.png") as two:
        assert single.width == two.width and two.height == pytest.approx(2 * single.height, abs=2)


def test_names_at_line_ends_stay_apart_and_in_order():
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


def test_lines_and_their_end_labels_match_in_file_and_page(agree):
    (shown,) = agree(a_chart())
    assert shown.marks == {Kind.LINES: 2} and shown.texts == [HOSTILE, "xy rg8"]
    assert shown.extents["y"] == pytest.approx((16 - 0.04 * 2384, 2400 + 0.04 * 2384))


def test_every_kind_of_mark_matches_in_file_and_page(agree):
    rows = tuple({"codec": f"c{n}", "x": float(n), "z": n + 2.0, "name": f"c{n}", "rest": n == 1} for n in range(4))
    names = Axis(title="", scale=Scale.NAMES, names=distinct(rows, "name"))
    marks = [Mark(kind=kind, y="name") for kind in (Kind.POINTS,)]
    marks += [Mark(kind=kind, x2="z", y="name") for kind in (Kind.RULES, Kind.BARS)]
    marks += [Mark(kind=Kind.TEXTS, x="z", y="name", text="name")]
    (shown,) = agree(a_chart(rows=rows, y=names, x=Axis(title="ms"), marks=tuple(marks)))
    assert shown.marks == {Kind.POINTS: 4, Kind.RULES: 4, Kind.BARS: 4} and len(shown.texts) == 4
    marks = [Mark(kind=Kind.POINTS, y="z"), Mark(kind=Kind.LABELS, y="z", text="name", rest="rest", colour="ink")]
    marks += [Mark(kind=Kind.RULES, y="z", y2="x"), Mark(kind=Kind.AREAS, y="z", y2="x", is_stepped=True)]
    (shown,) = agree(a_chart(rows=rows, x=Axis(title="instructions", scale=Scale.COUNT), marks=tuple(marks)))
    assert shown.marks == {Kind.POINTS: 4, Kind.RULES: 4, Kind.AREAS: 1}
    shades = Shades("z", "angle, degrees", 0.1, 180.0)
    cells = (
        Mark(kind=Kind.CELLS, x="codec", y="name", colour="z"),
        Mark(kind=Kind.TEXTS, x="codec", y="name", text="codec"),
    )
    across = Axis(title="", scale=Scale.NAMES, names=distinct(rows, "codec"))
    (shown,) = agree(a_chart(rows=rows, x=across, y=names, colour=shades, marks=cells))
    assert shown.marks == {Kind.CELLS: 4} and shown.extents == {"x": (4,), "y": (4,)}


@pytest.mark.parametrize("name", [name for name in ROWS if TABLES[name].work.has_charts])
def test_every_chart_of_a_run_matches_in_file_and_page(agree, name):
    charts = list(TABLES[name].work.charts(ROWS[name]))
    assert charts and len({chart.name for chart in charts}) == len(charts)
    for chart in charts:
        shown = agree(chart)
        assert sum(count for panel in shown for count in panel.marks.values()) > len(shown)
        assert chart.title and chart.subtitle and chart.title != chart.subtitle and chart.description.endswith(".")


def test_panels_share_an_axis_or_have_their_own(agree):
    chart = a_chart(panels=Names("bits", (16, 24)), x=Axis(title="pixels", scale=Scale.LOG, is_shared=False))
    first, other = agree(chart)
    assert first.extents["y"] == other.extents["y"] and first.texts != other.texts


def test_switch_is_a_control_on_the_page_and_panels_or_a_choice_in_a_file(agree):
    switch = Switch("bits", "Bits shown", (ALL, "16", "24"), ALL)
    expected = {"field": "bits", "label": "Bits shown", "all": ALL, "values": [ALL, "16", "24"], "usual": ALL}
    assert wire.spec(a_chart(switch=switch))["switch"] == expected
    (whole,) = agree(a_chart(switch=switch))
    assert whole.marks[Kind.LINES] == 2
    rows = tuple({**row, "gpu": f"gpu {row['bits']}"} for row in a_chart().rows)
    for has_panels, count in ((True, 2), (False, 1)):
        switch = Switch("gpu", "GPU", ("gpu 16", "gpu 24"), "gpu 24", has_panels)
        shown = agree(a_chart(rows=rows, switch=switch))
        assert len(shown) == count and shown[-1].marks[Kind.LINES] == 1
    assert len(wire.spec(a_chart(rows=rows, switch=switch))["panels"]) == 1


def test_values_that_cannot_be_plotted_are_left_out(agree):
    rows = [{"x": x, "y": y} for x, y in ((1.0, 2.0), (0.0, 2.0), (2.0, float("inf")), (3.0, None), (4.0, 1.0))]
    (shown,) = agree(a_chart(rows=tuple(rows), colour=None, marks=(Mark(kind=Kind.POINTS),)))
    assert shown.marks == {Kind.POINTS: 2}


def test_chart_without_rows_is_empty(agree, tmp_path):
    (shown,) = agree(a_chart(rows=()))
    assert shown.marks == {} and shown.titles == {"x": "pixels", "y": "error, degrees"}
    draw.write([], (tmp_path / "none.png", "png"))
    draw.write([a_chart(rows=())], (tmp_path / "empty.svg", "svg"))
    assert "A finding" in (tmp_path / "empty.svg").read_text()
