"""Interactive figures: pointing, picking, keys, zoom, files and print."""

import json

import pytest

from normalbench.bench.tables.cost.charts import front_chart
from normalbench.reports.charts import wire
from normalbench.reports.charts.chart import Chart, Kind
from normalbench.reports.charts.pareto import Panel, Point
from normalbench.reports.charts.plots import PlotError
from normalbench.reports.page.page import WEB

# What the script that draws may take, unpacked.
MOST_BYTES = 20_000


def a_front(count: int = 40) -> Chart:
    """Return a chart of codecs in a cloud of points; two codecs are one encoding in two storages."""
    points = [
        Point(f"encoding_{n}", 5 + n % 7 * 4 + n / 10, 40.0 + n * 17 % 23, 16 + n % 2 * 8, codec=f"e{n} rgba8")
        for n in range(count)
    ]
    others = [Point("e1", 3, 70.0, 24, codec="e1 rgb10a2"), Point("name", 90, 38.0, 16, codec=HOSTILE)]
    return front_chart("cost-0", "PSNR", [Panel("encode", [*points, *others])])


HOSTILE = 'a\\b"] , * { } </style> rgba8'


def test_the_script_is_small():
    assert len((WEB / "charts.js").read_bytes()) <= MOST_BYTES


def test_rows_shared_by_several_marks_are_stored_once():
    (part,) = wire.spec(a_front())["panels"]
    tables = {mark["kind"]: mark["table"] for mark in part["marks"]}
    assert tables[Kind.POINTS] == tables[Kind.LABELS] != tables[Kind.LINES] and len(part["tables"]) == 2
    assert len(json.dumps(part)) < 6000


def test_package_without_the_library_is_a_one_line_error(monkeypatch):
    monkeypatch.setattr(wire, "LIBRARY", "js/none.js")
    with pytest.raises(PlotError, match=r"^mpld3 \S+ has no js/none.js, .* install mpld3 0.5.12$"):
        wire.library()
    monkeypatch.setattr(wire, "find_spec", lambda _: None)
    with pytest.raises(PlotError, match="mpld3 is missing"):
        wire.library()
