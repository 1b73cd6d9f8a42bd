"""The article's scene, which reproduces the article's quality table."""

import numpy as np
import pytest
from speed import numpy_baseline as independent

from normalbench.gbuffer.scenes.built_in.playground import playground as rendered
from normalbench.gbuffer.scenes.rasterise import Rendered

pytestmark = pytest.mark.usefixtures("rows_are_shared")


def of_picture(seen: Rendered, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return normals, (0, 0, 1) on the background; the decoded normals; and which pixels are covered."""
    n = np.where(seen.covered[..., None], seen.normals, (0, 0, 1)).reshape(-1, 3).astype(np.float64)
    view = seen.positions.reshape(-1, 3).astype(np.float64)
    return n, independent.BASELINES[name](n, view, independent.quantise_unorm), seen.covered.ravel()


def article_mse(n: np.ndarray, decoded: np.ndarray, covered: np.ndarray) -> float:
    """Return the mean squared error of the difference image in 8 bits, including the background."""
    difference = np.where(covered[:, None], np.abs(n - decoded), 0)
    return float(np.mean((np.round(np.minimum(difference, 1) * 255) / 255) ** 2))


@pytest.mark.parametrize("name", sorted(independent.BASELINES))
def test_an_independent_float64_implementation_gives_the_same_row(normalbench, name):
    """NumPy in float64, whole arrays, nothing shared with the catalogue: PSNR within 0.005 dB, angles within 0.2%."""
    n, decoded, covered = of_picture(rendered(), name)
    mse, _, mean, rms, p99, largest = independent.whole_row(n[covered], decoded[covered])
    row = normalbench.quality(encoding=name)
    assert row["psnr_db"] == pytest.approx(10 * np.log10(1 / mse), abs=0.005)
    article = article_mse(n, decoded, covered)
    assert row["psnr_article_db"] == pytest.approx(10 * np.log10(1 / article), abs=0.005)
    expected = {"angle_mean_deg": mean, "angle_rms_deg": rms, "angle_p99_deg": p99, "angle_max_deg": largest}
    for column, value in expected.items():
        assert row[column] == pytest.approx(value, rel=2e-3), f"{name} {column}"


def test_the_scene_matches_the_article():
    """Facts about the original: about 2% background, 15% of the rest with z < 0, under 0.5% facing away."""
    seen = rendered()
    normals, positions = seen.normals[seen.covered], seen.positions[seen.covered]
    assert seen.covered.shape == (480, 640)
    assert 0.01 < 1 - seen.covered.mean() < 0.035
    assert 0.14 < (normals[:, 2] < 0).mean() < 0.16
    assert 0 < (np.sum(normals * positions, axis=1) > 0).mean() < 0.005
    assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
