"""Translations, confirmed by a second compiler before they are measured."""

import numpy as np
import pytest

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.ground.directions import directions
from normalbench.bench.ground.output import cache as kept
from normalbench.bench.subjects.codecs import second_look

pytestmark = pytest.mark.usefixtures("gl", "in_this_process")


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    """An empty cache, so that no earlier result is found."""
    monkeypatch.setattr(kept, "folder", lambda: tmp_path / "cache")


def test_codes_on_both_sides_of_a_seam_count_as_equal():
    """Rounding may move a normal, or -0 and 0, across a seam; a changed constant is a difference."""
    n = directions()

    def folded(given):
        return np.where(given[:, 2:] < 0, given[:, :2] * 0.5, given[:, :2])

    moved = n.copy()
    moved[np.abs(n[:, 2]) < 1e-7, 2] *= -1
    assert second_look._first_apart(folded, n, folded(n), folded(moved), 2.0**-16) is None
    index = second_look._first_apart(folded, n, folded(n), folded(n) * 1.001, 2.0**-16)
    assert index is not None and angles_deg(n[index : index + 1], n[index : index + 1])[0] == 0
