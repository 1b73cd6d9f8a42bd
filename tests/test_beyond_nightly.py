"""The tables of docs/beyond-octahedral.md, measured again."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from tests import joint_word, relative_to_depth

PAGE = (Path(__file__).parents[1] / "docs" / "beyond-octahedral.md").read_text()


def table(marker: str) -> list[list[str]]:
    """Return the rows of the table below a marker."""
    (text,) = re.findall(rf"<!-- {marker} -->\n\|.*\n\|.*\n((?:\|.*\n)+)", PAGE)
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()]


def test_the_page_has_the_gains_of_a_frame_from_depth():
    for shown, measured in zip(table("relative_to_depth"), relative_to_depth.rows(), strict=True):
        assert shown[0] == measured[0]
        for cell, other in zip(shown[1:], measured[1:], strict=True):
            figures = [[float(text) for text in re.findall(r"[\d.]+", part)] for part in (cell, other)]
            assert figures[0] == pytest.approx(figures[1], rel=0.01, abs=0.2), (shown, measured)


def test_kept_errors_are_those_of_the_worst_object():
    """One object, two roughnesses and two codes of eighteen and fourteen: nowhere worse, and somewhere as bad."""
    kept = np.array(json.loads(joint_word.KEPT.read_text())["errors"])
    rough, bits = (0.1, 0.5), (8, 12)
    errors, _ = joint_word.measured((("panel4", "lamp"), ("panel20", "lamp")), rough, bits)
    rows, columns = (
        [list(of).index(value) for value in some]
        for of, some in ((joint_word.ROUGHNESS, rough), (joint_word.BITS, bits))
    )
    of_kept = kept[np.ix_(rows, columns)]
    assert (errors <= of_kept + 0.01).all() and (errors >= of_kept - 0.01).any(), (errors, of_kept)
