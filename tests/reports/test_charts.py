"""Charts as values: a file and the page show the same marks, axes and labels of a chart."""

import json

from both_ways import codecs_in, rows_of_tables

from normalbench.bench.tables.registry import TABLES
from normalbench.reports.charts import wire
from normalbench.reports.charts.chart import (
    Axis,
    Chart,
    Kind,
    Mark,
    Names,
    Scale,
)

ROWS = rows_of_tables()


HOSTILE = "$a\\b\"'</script>"


def a_chart(**more) -> Chart:
    """Return a chart with lines of two codecs over a logarithmic axis, with names at their ends."""
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


def test_title_of_an_angle_axis_gives_degrees():
    """A wrong unit would be the same in the file and on the page, because both show one value."""
    titles = {chart.x.title for chart in TABLES["quality"].work.charts(ROWS["quality"])}
    assert titles == {"angle between normal and decode (degrees)"}


def test_a_specification_is_plain_data():
    text = json.dumps(wire.spec(a_chart()), allow_nan=False)
    assert codecs_in(json.loads(text)) == {"xy rg8", HOSTILE}
