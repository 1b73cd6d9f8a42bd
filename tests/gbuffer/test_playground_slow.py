"""The article's scene, which reproduces the article's quality table."""

from collections.abc import Sequence

import numpy as np
import pytest
from test_playground import article_mse, of_picture

from normalbench.bench.measures.metrics import published
from normalbench.gbuffer.scenes.built_in.playground import ARMS, CAMERA, in_view_space
from normalbench.gbuffer.scenes.mesh import Mesh, facing, joined
from normalbench.gbuffer.scenes.rasterise import Rendered, rasterise

pytestmark = pytest.mark.usefixtures("rows_are_shared")


# How far from the article's figures the rows may be, in dB. The original scene, measured with its own arms, is up to
# 0.33 dB off itself. The arms' statistics leave open what they hide of the backdrop's middle, where z is near 1 and
# spherical is worst, and how far from 0 in each of their bins normals face away, which per-pixel view space pays for.
WITHIN, WIDER = 0.35, {"spherical": 0.8, "per_pixel_view": 0.5}


@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_every_row_is_near_the_article_and_in_the_same_order(normalbench, backend):
    rows = {name: normalbench.quality(encoding=name, backend=backend) for name in published.PSNR_DB}
    for name, figure in published.PSNR_DB.items():
        within = WIDER.get(name, WITHIN)
        rows[name].assert_that(psnr_article_db=f"at least {figure - within}")
        rows[name].assert_that(psnr_article_db=f"at most {figure + within}")
    measured = {name: row["psnr_article_db"] for name, row in rows.items()}
    assert sorted(measured, key=measured.get) == sorted(published.PSNR_DB, key=published.PSNR_DB.get)


def article_rows(seen: Rendered) -> dict[str, float]:
    """Return the article's rows for an image, by the independent implementation."""
    return {name: 10 * np.log10(1 / article_mse(*of_picture(seen, name))) for name in published.PSNR_DB}


def off(meshes: Sequence[Mesh], culls: bool) -> dict[str, float]:
    """Return the differences between the rows of a scene and those of the article, in dB."""
    whole = joined(meshes)
    rows = article_rows(rasterise(facing(whole) if culls else whole, CAMERA))
    return {name: rows[name] - figure for name, figure in published.PSNR_DB.items()}


def test_the_arms_and_culling_are_each_needed():
    """Without the arms nothing faces away, and per-pixel view space is 8 dB too good. If both sides are drawn, the
    camera looks into the teapots, whose insides face away. The two errors would compensate for each other."""
    meshes = in_view_space()
    without_arms, both_sides = off(meshes[: -len(ARMS)], True), off(meshes, False)
    assert without_arms["per_pixel_view"] > 8 and without_arms["spherical"] < -WITHIN
    assert both_sides["per_pixel_view"] < -1 and both_sides["stereographic"] < -WITHIN
