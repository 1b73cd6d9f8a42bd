"""The chart of cost against error: sums, Pareto fronts and positions of labels."""

import test_cost_fronts
from test_cost_fronts import POINTS

from normalbench.reports.charts.pareto import Panel

drawn = test_cost_fronts.drawn


def test_legend_covers_no_point(drawn):
    """The legend is also outside all axes."""
    figure = drawn(Panel("encode", POINTS), Panel("decode", POINTS[::-1]))
    ((legend,),) = [part.legends for part in figure.subfigs]
    box = legend.get_window_extent()
    for axis in figure.axes:
        assert axis.get_legend() is None and not box.overlaps(axis.get_window_extent())
        assert not [1 for x, y in axis.transData.transform([(p.cost, p.psnr) for p in POINTS]) if box.contains(x, y)]
    assert [text.get_text() for text in legend.get_texts()] == ["16 bits", "24 bits"]
