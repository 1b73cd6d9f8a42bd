"""The interactive chart of cost against error: a switch between GPUs, readable names and no crowded corner."""

from itertools import combinations, pairwise

import pytest
from browsing import PHONE, Opened
from hypothesis import given
from hypothesis import strategies as st
from test_cost_chart import CODECS, FAMILIES, costs_of, points
from test_report import a_run, quality_row, reported

from normalbench.bench.tables.cost.charts import HEIGHT, front_chart
from normalbench.reports.charts import wire
from normalbench.reports.charts.chart import Axis, lines_apart
from normalbench.reports.charts.pareto import Panel


@given(st.lists(st.floats(10, 110), min_size=1, max_size=24, unique=True))
def test_names_do_not_overlap_and_keep_the_order_of_their_points(errors):
    axis = Axis(title="PSNR, dB", domain=(0, 120))
    places = dict(zip(errors, lines_apart(axis, errors, HEIGHT, wire.LABEL_LINE), strict=True))
    pixels = [places[error] * HEIGHT for error in sorted(errors)]
    assert all(b - a >= wire.LABEL_LINE - 1e-6 for a, b in pairwise(pixels))


def test_a_file_and_the_page_show_the_same_for_the_default_gpu(agree):
    panels = [
        Panel(kind, points(index, side), name, is_usual=name == "dg2")
        for index, name in enumerate(FAMILIES)
        for side, kind in enumerate(("encode", "decode"))
    ]
    shown = agree(front_chart("cost-0", "PSNR", panels))
    assert [panel.marks["points"] for panel in shown] == [5, 5]


@pytest.fixture(scope="module")
def run_folder(tmp_path_factory):
    """A run with costs of two vendors' GPUs."""
    costs = [row for index, family in enumerate(FAMILIES) for row in costs_of(CODECS, family, index)]
    quality = [quality_row(name, psnr_db=CODECS[name][2]) for name in CODECS]
    return a_run(tmp_path_factory.mktemp("costs") / "run", {"quality": quality, "cost": costs})


def test_the_pages_switch_shows_another_gpu_and_no_names_overlap(run, run_folder, browser, size=PHONE):
    reported(run, run_folder)
    page = Opened(browser, run_folder / "report.html", size)
    try:
        figure = page.page.locator("figure[data-chart=cost-0]")
        page.come_to("figure[data-chart=cost-0]", "figure[data-chart=cost-0] .plot svg >> nth=1")
        choice = figure.get_by_role("combobox", name="GPU")
        choice.wait_for()
        titles = figure.locator(".plot").all_text_contents()
        assert [f"{o}, Navi 3x (navi31)" in t for o, t in zip(("encode", "decode"), titles, strict=True)] == [True] * 2
        for name in ("Navi 3x (navi31)", "Arc A770 (dg2)"):
            choice.select_option(name)
            figure.get_by_text(f"encode, {name}").wait_for()
            assert_no_names_overlap(figure)
        assert page.said == []
    finally:
        page.context.close()


def assert_no_names_overlap(figure) -> None:
    for plot in figure.locator(".plot").all():
        texts = plot.locator("svg text.labels:not(.unplaced)").all()
        boxes = {(index, text.text_content()): text.bounding_box() for index, text in enumerate(texts)}
        assert len(boxes) >= 3
        for (a, first), (b, other) in combinations(boxes.items(), 2):
            # Browsers do not agree on how high a line of 11 pixels is.
            apart = abs(first["y"] + first["height"] / 2 - other["y"] - other["height"] / 2) >= 12
            beside = first["x"] + first["width"] <= other["x"] or other["x"] + other["width"] <= first["x"]
            assert apart or beside, (a, b)
        frame = plot.bounding_box()
        for name, box in boxes.items():
            assert frame["x"] <= box["x"] and box["x"] + box["width"] <= frame["x"] + frame["width"], name
