"""Charts drawn by both renderers, and the contents of each drawing."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from functools import partial
from math import dist
from pathlib import Path
from typing import Any

import pytest

from normalbench.bench.tables.registry import TABLES
from normalbench.reports.charts import draw, drawings, plots, wire
from normalbench.reports.charts.chart import Axis, Chart, Kind, Scale
from normalbench.reports.page import page as report
from normalbench.reports.page.page import WEB, template

WIDTH = 900


@dataclass
class Shown:
    """A panel: its marks by kind, the ends and titles of its axes, its labels and the texts at its ticks."""

    marks: dict[str, int] = field(default_factory=dict)
    extents: dict[str, tuple[float, ...]] = field(default_factory=dict)
    titles: dict[str, str] = field(default_factory=dict)
    texts: list[str] = field(default_factory=list)
    ticks: set[str] = field(default_factory=set)


def codecs_in(chart_spec: dict[str, Any]) -> set[str]:
    """Return the names of the codecs in a chart's data."""
    columns = [table["codec"] for panel in chart_spec["panels"] for table in panel["tables"] if "codec" in table]
    return {name for column in columns for name in (column["names"] if isinstance(column, dict) else column) if name}


def in_files(chart: Chart) -> list[Shown]:
    """Return the contents of each panel as matplotlib draws it."""
    figure = draw.figure([chart])
    try:
        return [_in_axes(axes, part) for axes, (_, part) in zip(figure.axes, chart.still(), strict=False)]
    finally:
        plots.drawn_off_screen().close(figure)


def _in_axes(axes, part: Chart) -> Shown:
    from matplotlib.collections import FillBetweenPolyCollection, LineCollection, PathCollection
    from matplotlib.patches import Rectangle

    points = [collection for collection in axes.collections if isinstance(collection, PathCollection)]
    rules = [collection for collection in axes.collections if isinstance(collection, LineCollection)]
    areas = [collection for collection in axes.collections if isinstance(collection, FillBetweenPolyCollection)]
    is_cell = part.x.scale == Scale.NAMES
    shown = Shown(texts=sorted(text.get_text().replace(r"\$", "$") for text in axes.texts))
    shown.marks = {
        Kind.POINTS: sum(len(collection.get_offsets()) for collection in points),
        Kind.LINES: len(axes.lines),
        Kind.RULES: sum(len(collection.get_segments()) for collection in rules),
        Kind.AREAS: len(areas),
        Kind.CELLS if is_cell else Kind.BARS: sum(isinstance(patch, Rectangle) for patch in axes.patches),
    }
    shown.marks = {kind: count for kind, count in shown.marks.items() if count}
    for name, axis, ends in (("x", part.x, axes.get_xlim()), ("y", part.y, axes.get_ylim())):
        shown.extents[name] = (len(axis.names),) if axis.scale == Scale.NAMES else ends
    shown.titles = {"x": axes.get_xlabel(), "y": axes.get_ylabel()}
    shown.ticks = {label.get_text() for label in (*axes.get_xticklabels(), *axes.get_yticklabels())}
    return shown


# Puts a figure into the page, and draws it.
PUT = """([html, spec, codecs]) => {
  document.querySelector("main").innerHTML = html;
  known.codecs = codecs;
  change({ a: "", b: "" });
  const figure = document.querySelector("figure"), height = () => document.querySelector("[data-drawn]").offsetHeight;
  const before = height();
  charts.specs = { [figure.dataset.chart]: spec };
  charts.views.clear();
  while (drawNext(figure));
  return [before, height()];
}"""
# Reads the panels for each choice of a switch: marks and texts, what axes say and where, the box.
READ = """(choices) => {
  const all = (node, selector) => Array.from(node.querySelectorAll(selector));
  const figure = document.querySelector("figure");
  const said = (node) => node.querySelector("title")?.textContent ?? node.textContent;
  const numbers = (node) => node.getAttribute("transform").match(/-?[0-9.]+(e-?[0-9]+)?/g).map(Number);
  // Texts one over another; names at a slant stand in each other's boxes, not in each other.
  const overlaps = (texts) => {
    const straight = texts.filter((one) => !one.getAttribute("transform")?.includes("rotate(-30)"));
    const boxes = straight.map((one) => [said(one), one.getBoundingClientRect()]);
    const isOver = (one, other) => Math.min(one.right, other.right) - Math.max(one.left, other.left) > 2
      && Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top) > 3;
    return boxes.flatMap(([text, one], at) => {
      return boxes.slice(at + 1).filter(([, other]) => isOver(one, other)).map(([other]) => [text, other]);
    });
  };
  const panel = (svg) => {
    const box = svg.querySelector("clipPath rect"), kinds = ["points", "lines", "areas", "rules", "bars", "cells"];
    const [x, y, width, height] = ["x", "y", "width", "height"].map((name) => Number(box.getAttribute(name)));
    const tick = (one) => [said(one.querySelector("text")), ...numbers(one)];
    const counts = kinds.map((kind) => [kind, all(svg, `.${kind}`).length]);
    return {
      box: [x + 6, y + 6, x + width - 6, y + height - 6],
      marks: Object.fromEntries(counts.filter(([, count]) => count)),
      texts: all(svg, "text.texts, text.labels, text.ends").filter((one) => !one.matches(".unplaced")).map(said),
      axes: all(svg, ".axis").map((axis) => all(axis, ".tick").map(tick)),
      titles: all(svg, ".title[transform]").map(said),
      points: all(svg, ".points").map((one) => numbers(one).slice(0, 2)),
      overlaps: overlaps(all(svg, "text").filter((one) => one.textContent && getComputedStyle(one).display !== "none")),
    };
  };
  return choices.flatMap((choice) => {
    const select = figure.querySelector("[data-switch]");
    if (choice) select.value = choice;
    for (const view of charts.views.values()) view.draw();
    return all(figure, ".plot svg").map(panel);
  });
}"""


# What a report's scripts find beside its figures.
AROUND = """<button id="theme"><span></span></button><nav></nav><style id="sides"></style><main></main>
<script type="application/json" id="beginning">{"codecs": [], "a": "", "b": "", "view": ""}</script>"""


class Page:
    """A browser page with the scripts of a report, which draws one chart after another.

    Args:
        page: an empty page.
        path: the file to write for the page; a page without an address cannot save its state.
    """

    def __init__(self, page, path: Path):
        self.page, self.said = page, []
        page.on("pageerror", lambda error: self.said.append(str(error)))
        names = ("tables.js", "state.js", "charts.js", "figures.js")
        scripts = [wire.library(), *((WEB / name).read_text() for name in names)]
        style = (WEB / "page.css").read_text() + f"main {{ width: {WIDTH}px; }} main .plots {{ display: block; }}"
        texts = "".join(f"<script>{text}</script>" for text in scripts)
        path.write_text(f"<!doctype html><meta charset='utf-8'><style>{style}</style>{AROUND}{texts}")
        page.goto(path.as_uri())

    def put(self, chart: Chart) -> list[float]:
        """Draw a chart. Return the height of the element that holds its panels, before and after drawing."""
        spec = wire.spec(chart)
        json.dumps(spec, allow_nan=False)
        figure = template("parts.html.j2").module.chart(report.Chart(drawings.of(chart), spec))
        heights = self.page.evaluate(PUT, [str(figure), spec, sorted(codecs_in(spec))])
        assert not self.said, self.said
        return heights

    def panels(self, chart: Chart) -> list[dict]:
        """Return READ's result for each panel, with the first choice of a switch or with every choice."""
        self.put(chart)
        switch = chart.switch
        return self.page.evaluate(READ, list(switch.values) if switch and switch.has_panels else [""])

    def agree(self, chart: Chart) -> list[Shown]:
        """Check that a file and the page agree on the panels and on the places of values; return the panels."""
        files, pages = in_files(chart), self.panels(chart)
        assert len(files) == len(pages)
        named = {name for axis in (chart.x, chart.y) for name in (*axis.names, *(name for _, name in axis.ticks))}
        for file, page, (_, part) in zip(files, pages, chart.still(), strict=True):
            same(file, page)
            assert page["overlaps"] == []
            stands(part, page)
            ticks = {text for axis in page["axes"] for text, *_ in axis}
            assert named <= file.ticks and named <= ticks, (named - file.ticks, named - ticks)
        return files


def rows_of_tables() -> dict[str, list[dict]]:
    """Return rows of every table that has charts, by table, from a file with only the columns that charts read.

    The sweep's rows were measured with one number of objects and multiplied for other numbers.
    """
    kept = json.loads((Path(__file__).parent / "charted_rows.json").read_text())
    return {
        name: [TABLES[name].as_now(dict(zip(t["columns"], row, strict=True))) for row in t["rows"]]
        for name, t in kept.items()
    }


def same(file: Shown, page: dict) -> None:
    """Check that a file and the page agree; the page leaves out labels that do not fit."""
    assert file.marks == page["marks"]
    assert Counter(page["texts"]) <= Counter(file.texts)
    assert [file.titles["x"], file.titles["y"]] == page["titles"]


def stands(part: Chart, page: dict) -> None:
    """Check that ticks on the page are within 0.1 pixels of their values, and points within 0.2 pixels. d3 shifts
    anything with a line by half a pixel to keep it sharp."""
    left, top, right, bottom = page["box"]
    for axis, ticks, index, (start, end) in zip(
        (part.x, part.y), page["axes"], (1, 2), ((left, right), (bottom, top)), strict=True
    ):
        assert len(ticks) > 1 or not part.rows, axis.title
        if axis.names:
            assert [tick[0] for tick in ticks] == list(axis.names)
        moved = 0 if axis.names else 0.5
        for tick in ticks:
            assert tick[index] - moved == pytest.approx(_at(axis, tick[0], start, end), abs=0.1), (axis.title, tick)
    marks = [mark for mark in part.marks if mark.kind == Kind.POINTS]
    places = [
        (_at(part.x, row[mark.x], left, right), _at(part.y, row[mark.y], bottom, top))
        for mark in marks
        for row in part.rows_of(mark)
    ]
    assert len(places) == len(page["points"])
    for some, others in ((places, page["points"]), (page["points"], places)):
        assert all(min(map(partial(dist, point), others)) < 0.2 for point in some)


def _at(axis: Axis, value: Any, start: float, end: float) -> float:
    """Return the pixel of a value or a tick's text on an axis between two pixels; names begin at the top or left."""
    if axis.scale == Scale.NAMES:
        low, high = min(start, end), max(start, end)
        return low + (axis.names.index(value) + 0.5) / len(axis.names) * (high - low)
    values = {text: number for number, text in axis.ticks}
    return start + axis.share(float(values.get(value, value))) * (end - start)
