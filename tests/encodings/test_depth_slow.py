"""Depth codes: the projection is the encoding's own, signs survive, and no error is above its bound."""

import numpy as np
import pytest
from parity.depth import CAMERAS, CODECS

from normalbench.bench.tables.depth import measure as depth
from normalbench.encodings.shared.position import Camera


def cases(backend: str, camera: Camera) -> list:
    distances = (*np.geomspace(camera.near, camera.far, 4).tolist(), None)
    return [
        depth.Case(codec, way, backend, camera, distances, 2**10, 7) for codec in CODECS for way in depth.ways(codec)
    ]


@pytest.mark.parametrize("camera", CAMERAS, ids=lambda c: f"{c.near:g} to {c.far:g}")
@pytest.mark.parametrize("backend", ["jax", "glsl"])
@pytest.mark.usefixtures("gl")
def test_no_error_is_above_its_bound(backend, camera):
    """Every code in every storage by every way: each point's own bound, not the row's."""
    for case in cases(backend, camera):
        on = depth.all_points(camera, case.distances, case.count, case.seed)
        found = depth.through(case, on)
        with np.errstate(invalid="ignore"):
            share = np.where(np.isfinite(found.bounds), found.errors / found.bounds, 0)
        i = int(np.argmax(share))
        story = f"{case.name} by {case.rebuilt}, depth {on.depths[i]!r}"
        assert share[i] <= 1, f"{story}: off by {found.errors[i]:.6g}, bound {found.bounds[i]:.6g}"
        assert not found.lost.any(), f"{case.name}: {found.lost.sum()} signs lost"
