"""A translation is measured once a second compiler has given the same."""

import numpy as np
import pytest

from normalbench.bench.ground.angles import angles_deg
from normalbench.bench.ground.directions import directions
from normalbench.bench.ground.output import cache as kept
from normalbench.bench.subjects.codecs import second_look

pytestmark = pytest.mark.usefixtures("gl", "in_this_process")


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    """What was found before is not what these tests find."""
    monkeypatch.setattr(kept, "folder", lambda: tmp_path / "cache")


def test_codes_on_the_two_sides_of_a_seam_are_no_difference():
    """-0 and 0, and normals that rounding moves across a seam, are on either side of it; a changed constant is not."""
    n = directions()

    def folded(given):
        return np.where(given[:, 2:] < 0, given[:, :2] * 0.5, given[:, :2])

    moved = n.copy()
    moved[np.abs(n[:, 2]) < 1e-7, 2] *= -1
    assert second_look._first_apart(folded, n, folded(n), folded(moved), 2.0**-16) is None
    at = second_look._first_apart(folded, n, folded(n), folded(n) * 1.001, 2.0**-16)
    assert at is not None and angles_deg(n[at : at + 1], n[at : at + 1])[0] == 0
