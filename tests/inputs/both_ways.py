"""Charts drawn by both renderers, and what each of them shows."""

import json
import re
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

import pytest
import vl_convert
from matplotlib import pyplot
from matplotlib.collections import FillBetweenPolyCollection, LineCollection, PathCollection
from matplotlib.patches import Rectangle

from normalbench.bench.tables.registry import TABLES
from normalbench.reports.charts import draw, vega
from normalbench.reports.charts.chart import Chart, Kind, Scale

WIDTH = 900
SVG = "{http://www.w3.org/2000/svg}"
# Marks of the page that a file has as parts of others.
NOT_COUNTED = ("hits", "leaders")
TITLE = re.compile(r"([XY])-axis (?:titled '(.*)' )?for a")


@dataclass
class Shown:
    """A panel: how many marks of each kind, where its axes end, their titles, what is at their ticks, and labels."""

    marks: dict[str, int] = field(default_factory=dict)
    extents: dict[str, tuple[float, ...]] = field(default_factory=dict)
    titles: dict[str, str] = field(default_factory=dict)
    texts: list[str] = field(default_factory=list)
    ticks: set[str] = field(default_factory=set)


def in_files(chart: Chart) -> list[Shown]:
    """What each panel shows, drawn by matplotlib."""
    figure = draw.figure([chart])
    try:
        return [_in_axes(axes, part) for axes, (_, part) in zip(figure.axes, chart.still(), strict=False)]
    finally:
        pyplot.close(figure)


def _in_axes(axes, part: Chart) -> Shown:
    points = [one for one in axes.collections if isinstance(one, PathCollection)]
    rules = [one for one in axes.collections if isinstance(one, LineCollection)]
    areas = [one for one in axes.collections if isinstance(one, FillBetweenPolyCollection)]
    is_cell = part.x.scale == Scale.NAMES
    found = Shown(texts=sorted(text.get_text().replace(r"\$", "$") for text in axes.texts))
    found.marks = {
        Kind.POINTS: sum(len(one.get_offsets()) for one in points),
        Kind.LINES: len(axes.lines),
        Kind.RULES: sum(len(one.get_segments()) for one in rules),
        Kind.AREAS: len(areas),
        Kind.CELLS if is_cell else Kind.BARS: sum(isinstance(one, Rectangle) for one in axes.patches),
    }
    found.marks = {kind: count for kind, count in found.marks.items() if count}
    for name, said, ends in (("x", part.x, axes.get_xlim()), ("y", part.y, axes.get_ylim())):
        found.extents[name] = (len(said.names),) if said.scale == Scale.NAMES else ends
    found.titles = {"x": axes.get_xlabel(), "y": axes.get_ylabel()}
    found.ticks = {label.get_text() for label in (*axes.get_xticklabels(), *axes.get_yticklabels())}
    return found


def in_pages(chart: Chart) -> list[Shown]:
    """What each panel shows, drawn by Vega-Lite, with what a switch has chosen at first."""
    switch = chart.switch
    choices = switch.values if switch and switch.has_panels else [None]
    return [_in_svg(_chosen(spec, choice)) for choice in choices for spec in vega.specs(chart)]


def _chosen(spec, choice):
    """A specification as it is where a reader has chosen something else."""
    if choice is None:
        return spec
    param = spec["usermeta"]["switch"]["param"]
    chosen = [one | {"value": choice} if one["name"] == param else one for one in spec["params"]]
    return spec | {"params": chosen}


def _in_svg(spec) -> Shown:
    # What follows the container is as wide as it is told here.
    text = json.dumps(spec | {"width": WIDTH}, allow_nan=False).replace("containerSize()[0]", str(WIDTH))
    whole = json.loads(text)
    scales = {scale["name"]: scale for scale in vl_convert.vegalite_to_vega(whole)["scales"]}
    found = Shown(extents={name: _ends(scales[name]) for name in ("x", "y") if name in scales})
    for element in ElementTree.fromstring(vl_convert.vegalite_to_svg(whole)).iter():
        if element.tag == f"{SVG}g":
            _count(element, found)
            if "role-axis-label" in element.get("class", ""):
                found.ticks |= {"".join(one.itertext()) for one in element.iter(f"{SVG}text")}
        if said := TITLE.match(element.get("aria-label", "")):
            found.titles[said[1].lower()] = said[2] or ""
    found.texts.sort()
    return found


def _ends(scale) -> tuple[float, ...]:
    """The values at the ends of an axis, or how many names it has."""
    return (len(scale["domain"]),) if scale["type"] in ("band", "point") else tuple(scale["domain"])


def _count(group, found: Shown) -> None:
    named = re.search(r"role-mark ([a-z]+)_\d+_marks", group.get("class", ""))
    if not named or named[1] in NOT_COUNTED:
        return
    kind, marks = named[1], [one for one in group if one.get("opacity") != "0"]
    if kind in (Kind.TEXTS, Kind.LABELS, Kind.ENDS):
        found.texts += ["".join(one.itertext()) for one in group.iter(f"{SVG}text")]
    else:
        found.marks[kind] = found.marks.get(kind, 0) + len(marks)


def rows_of_tables() -> dict[str, list[dict]]:
    """Rows of a run of every table that has charts, by table; kept in a file, less what charts do not read.

    The sweep's were measured at one number of objects, and multiplied for others.
    """
    kept = json.loads((Path(__file__).parent / "charted_rows.json").read_text())
    return {
        name: [TABLES[name].as_now(dict(zip(t["columns"], row, strict=True))) for row in t["rows"]]
        for name, t in kept.items()
    }


def same(file: Shown, page: Shown) -> None:
    """A file and the page agree; the page names points of the rest only when they are picked."""
    assert file.marks == page.marks
    assert Counter(page.texts) <= Counter(file.texts)
    assert file.titles == page.titles and set(file.extents) == {"x", "y"}
    for name, ends in file.extents.items():
        assert ends == pytest.approx(page.extents[name], rel=1e-6), name


def agree(chart: Chart) -> list[Shown]:
    """Panels of a chart that both renderers show alike."""
    files, pages = in_files(chart), in_pages(chart)
    assert len(files) == len(pages)
    named = {name for axis in (chart.x, chart.y) for name in (*axis.names, *(name for _, name in axis.ticks))}
    for file, page in zip(files, pages, strict=True):
        same(file, page)
        assert named <= file.ticks and named <= page.ticks, (named - file.ticks, named - page.ticks)
    return files
