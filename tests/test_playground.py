"""The seeds' quality table comes out of the seeds' scene."""

import numpy as np
import pytest

from normalbench.bench import numpy_baseline as independent
from normalbench.bench import quality, seeds
from normalbench.bench.normal_sets import playground
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codec import Codec
from normalbench.encodings.storage import STORAGES
from normalbench.gbuffer.scenes.playground import playground as rendered


def table(backend: str) -> dict[str, float]:
    codecs = {name: Codec(ENCODINGS[name], STORAGES[seeds.STORAGE]) for name in seeds.PSNR_DB}
    cases = {name: quality.Case(codec, playground(), backend) for name, codec in codecs.items()}
    return {name: quality.measure(case)["psnr_seed_db"] for name, case in cases.items()}


@pytest.mark.parametrize("backend", ["jax", "glsl"])
@pytest.mark.usefixtures("gl")
def test_every_row_is_within_0_6_db_of_the_seeds_and_in_their_order(backend):
    measured = table(backend)
    for name, seed in seeds.PSNR_DB.items():
        assert abs(measured[name] - seed) <= 0.6, f"{name} by {backend}: {measured[name]:.3f} dB, the seeds {seed}"
    assert sorted(measured, key=measured.get) == sorted(seeds.PSNR_DB, key=seeds.PSNR_DB.get)


@pytest.mark.parametrize("name", sorted(independent.BASELINES))
def test_an_independent_float64_implementation_gives_the_same_row(name):
    """NumPy in float64, whole arrays, nothing shared with the catalogue: PSNR within 0.005 dB, angles within 0.1 %."""
    seen = rendered()
    n = seen.normals.reshape(-1, 3).astype(np.float64)
    view = seen.positions.reshape(-1, 3).astype(np.float64)
    covered = seen.covered.ravel()
    n[~covered] = (0, 0, 1)
    decoded = independent.BASELINES[name](n, view, independent.quantise_unorm)
    mse, _, mean, rms, p99, largest = independent.whole_row(n[covered], decoded[covered])
    difference = np.where(covered[:, None], np.abs(n - decoded), 0)
    seed_mse = np.mean((np.round(np.minimum(difference, 1) * 255) / 255) ** 2)
    row = quality.measure(quality.Case(Codec(ENCODINGS[name], STORAGES["rgba8"]), playground(), "jax"))
    assert row["psnr_db"] == pytest.approx(10 * np.log10(1 / mse), abs=0.005)
    assert row["psnr_seed_db"] == pytest.approx(10 * np.log10(1 / seed_mse), abs=0.005)
    expected = {"angle_mean_deg": mean, "angle_rms_deg": rms, "angle_p99_deg": p99, "angle_max_deg": largest}
    for column, value in expected.items():
        assert row[column] == pytest.approx(value, rel=2e-3), f"{name} {column}"


def test_the_scene_is_the_seeds():
    """Facts of the original: about 2 % background, 15 % of the rest with z < 0, under 0.5 % facing away."""
    seen = rendered()
    normals, positions = seen.normals[seen.covered], seen.positions[seen.covered]
    assert seen.covered.shape == (480, 640)
    assert 0.01 < 1 - seen.covered.mean() < 0.035
    assert 0.14 < (normals[:, 2] < 0).mean() < 0.16
    assert 0 < (np.sum(normals * positions, axis=1) > 0).mean() < 0.005
    assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
