"""The article's quality table comes out of the article's scene."""

from collections.abc import Sequence

import numpy as np
import pytest
from speed import numpy_baseline as independent

from normalbench.bench.measures.metrics import published
from normalbench.gbuffer.scenes.built_in.playground import ARMS, CAMERA, in_view_space
from normalbench.gbuffer.scenes.built_in.playground import playground as rendered
from normalbench.gbuffer.scenes.mesh import Mesh, facing, joined
from normalbench.gbuffer.scenes.rasterise import Rendered, rasterise

pytestmark = pytest.mark.usefixtures("rows_are_shared")


# How far from the article's figures the rows may be, in dB. The original scene, measured with its own arms, is up to
# 0.33 dB off itself. The arms' statistics leave open what they hide of the backdrop's middle, where z is near 1 and
# spherical is worst, and how far from 0 in each of their bins normals face away, which per-pixel view space pays for.
WITHIN, WIDER = 0.35, {"spherical": 0.8, "per_pixel_view": 0.5}


@pytest.mark.parametrize("backend", ["jax", "glsl"])
def test_every_row_is_near_the_articles_and_in_its_order(normalbench, backend):
    rows = {name: normalbench.quality(encoding=name, backend=backend) for name in published.PSNR_DB}
    for name, figure in published.PSNR_DB.items():
        within = WIDER.get(name, WITHIN)
        rows[name].assert_that(psnr_article_db=f"at least {figure - within}")
        rows[name].assert_that(psnr_article_db=f"at most {figure + within}")
    measured = {name: row["psnr_article_db"] for name, row in rows.items()}
    assert sorted(measured, key=measured.get) == sorted(published.PSNR_DB, key=published.PSNR_DB.get)


def article_rows(seen: Rendered) -> dict[str, float]:
    """The article's rows of a picture, by the independent implementation."""
    return {name: 10 * np.log10(1 / article_mse(*of_picture(seen, name))) for name in published.PSNR_DB}


def of_picture(seen: Rendered, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals, (0, 0, 1) on the background; what comes back of them; and which are covered."""
    n = np.where(seen.covered[..., None], seen.normals, (0, 0, 1)).reshape(-1, 3).astype(np.float64)
    view = seen.positions.reshape(-1, 3).astype(np.float64)
    return n, independent.BASELINES[name](n, view, independent.quantise_unorm), seen.covered.ravel()


def article_mse(n: np.ndarray, decoded: np.ndarray, covered: np.ndarray) -> float:
    """Of the difference image in 8 bits, background included."""
    difference = np.where(covered[:, None], np.abs(n - decoded), 0)
    return float(np.mean((np.round(np.minimum(difference, 1) * 255) / 255) ** 2))


def off(meshes: Sequence[Mesh], culls: bool) -> dict[str, float]:
    """How far the rows of a scene are from the article's, in dB."""
    whole = joined(meshes)
    rows = article_rows(rasterise(facing(whole) if culls else whole, CAMERA))
    return {name: rows[name] - figure for name, figure in published.PSNR_DB.items()}


def test_the_arms_and_culling_are_each_needed():
    """Without the arms nothing faces away, and per-pixel view space is 8 dB too good. With both sides drawn one looks
    into the teapots, whose insides face away. The one in place of the other makes up for it, which is two errors."""
    meshes = in_view_space()
    without_arms, both_sides = off(meshes[: -len(ARMS)], True), off(meshes, False)
    assert without_arms["per_pixel_view"] > 8 and without_arms["spherical"] < -WITHIN
    assert both_sides["per_pixel_view"] < -1 and both_sides["stereographic"] < -WITHIN


@pytest.mark.parametrize("name", sorted(independent.BASELINES))
def test_an_independent_float64_implementation_gives_the_same_row(normalbench, name):
    """NumPy in float64, whole arrays, nothing shared with the catalogue: PSNR within 0.005 dB, angles within 0.1 %."""
    n, decoded, covered = of_picture(rendered(), name)
    mse, _, mean, rms, p99, largest = independent.whole_row(n[covered], decoded[covered])
    row = normalbench.quality(encoding=name)
    assert row["psnr_db"] == pytest.approx(10 * np.log10(1 / mse), abs=0.005)
    article = article_mse(n, decoded, covered)
    assert row["psnr_article_db"] == pytest.approx(10 * np.log10(1 / article), abs=0.005)
    expected = {"angle_mean_deg": mean, "angle_rms_deg": rms, "angle_p99_deg": p99, "angle_max_deg": largest}
    for column, value in expected.items():
        assert row[column] == pytest.approx(value, rel=2e-3), f"{name} {column}"


def test_the_scene_is_the_articles():
    """Facts of the original: about 2 % background, 15 % of the rest with z < 0, under 0.5 % facing away."""
    seen = rendered()
    normals, positions = seen.normals[seen.covered], seen.positions[seen.covered]
    assert seen.covered.shape == (480, 640)
    assert 0.01 < 1 - seen.covered.mean() < 0.035
    assert 0.14 < (normals[:, 2] < 0).mean() < 0.16
    assert 0 < (np.sum(normals * positions, axis=1) > 0).mean() < 0.005
    assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
