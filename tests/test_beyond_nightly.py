"""The tables of docs/beyond-octahedral.md, measured again."""

import re
from pathlib import Path

import pytest

from tests import joint_word, relative_to_depth

PAGE = (Path(__file__).parents[1] / "docs" / "beyond-octahedral.md").read_text()


def table(marker: str) -> list[list[str]]:
    """Return the rows of the table below a marker."""
    (text,) = re.findall(rf"<!-- {marker} -->\n\|.*\n\|.*\n((?:\|.*\n)+)", PAGE)
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()]


@pytest.mark.parametrize("module, tolerance", [(joint_word, 0.3), (relative_to_depth, 0.2)])
def test_the_page_has_the_measured_figures(module, tolerance):
    for shown, measured in zip(table(module.__name__.split(".")[1]), module.rows(), strict=True):
        assert shown[0] == measured[0]
        for one, other in zip(shown[1:], measured[1:], strict=True):
            figures = [[float(text) for text in re.findall(r"[\d.]+", cell)] for cell in (one, other)]
            assert figures[0] == pytest.approx(figures[1], rel=0.01, abs=tolerance), (shown, measured)
