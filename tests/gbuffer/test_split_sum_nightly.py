"""The error of the split sum against the integral of light, view and Fresnel, as printed in the manual."""

import re
from pathlib import Path

import numpy as np
import pytest

from normalbench.gbuffer.environment.catalogue import ENVIRONMENTS
from normalbench.gbuffer.environment.dfg import dfg
from normalbench.gbuffer.environment.environment import directions, solid_angles

PAGE = Path(__file__).parents[2] / "docs" / "render.md"


ROUGHNESSES, COSINES, COUNT, ROWS = (0.2, 0.3, 0.5, 0.7, 1.0), (0.9, 0.7, 0.5, 0.3), 200, 64


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300)


def errors(light: np.ndarray, towards: np.ndarray, area: np.ndarray, n_v: float, roughness: float) -> np.ndarray:
    """Return relative errors of the split sum for random normals and viewers on a perfect reflector, in float64.

    Args:
        light, towards, area: radiance (texels,), directions (texels, 3) and solid angles of an environment's texels.
    """
    rng, a2, relative = np.random.default_rng(0), roughness**4, []
    scale, bias = dfg(np.array(n_v), np.array(roughness))
    for _ in range(COUNT):
        n = unit(rng.normal(size=3))
        v = n_v * n + np.sqrt(1 - n_v**2) * unit(np.cross(n, rng.normal(size=3)))
        mirrored = 2 * n_v * n - v

        def lobe(eye: np.ndarray, normal: np.ndarray) -> np.ndarray:
            return a2 / (np.pi * ((unit(towards + eye) @ normal) ** 2 * (a2 - 1) + 1) ** 2)

        n_l = np.maximum(towards @ n, 0)
        smith = n_l * np.sqrt(n_v**2 * (1 - a2) + a2) + n_v * np.sqrt(n_l**2 * (1 - a2) + a2)
        right = np.sum(light * area * lobe(v, n) * n_l * 0.5 / np.maximum(smith, 1e-300))
        weights = lobe(mirrored, mirrored) * np.maximum(towards @ mirrored, 0) * area
        relative.append((light @ weights) / weights.sum() * (scale + bias) / right - 1)
    return np.abs(relative)


def test_the_manual_gives_the_error_of_the_split_sum():
    """The figures are medians in `studio`, by roughness and n.v. Blocks of 4 x 4 texels, which even the narrowest
    lobe here covers, are averaged."""
    radiance = ENVIRONMENTS["studio"].make().radiance.astype(np.float64).mean(axis=-1)
    height = radiance.shape[0]
    light = radiance.reshape(ROWS, height // ROWS, 2 * ROWS, height // ROWS).mean(axis=(1, 3)).ravel()
    area = np.broadcast_to(solid_angles(ROWS), (ROWS, 2 * ROWS)).ravel()
    towards = directions(ROWS).reshape(-1, 3)
    table = re.findall(r"^\| (0\.\d|1\.0) \|((?: +\d+ % \|)+)$", PAGE.read_text(), re.M)
    measured = {
        str(roughness): [100 * np.median(errors(light, towards, area, n_v, roughness)) for n_v in COSINES]
        for roughness in ROUGHNESSES
    }
    kept = {roughness: [float(number) for number in re.findall(r"\d+", row)] for roughness, row in table}
    assert list(kept) == list(measured)
    for roughness, row in measured.items():
        assert row == pytest.approx(kept[roughness], abs=1), f"{roughness}: {np.round(row, 1)}"
