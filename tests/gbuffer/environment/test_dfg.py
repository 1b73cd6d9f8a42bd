"""The split-sum table, compared with known figures and with sums over directions from the formulas of glTF 2.0."""

import numpy as np
import pytest

from normalbench.gbuffer.environment.dfg import SIZE, dfg, dfg_table

N_V = 1, 0.8, 0.5, 0.2


# Height-correlated Smith by quadrature in float64, (scale, bias) at N_V, from the materials' fact sheet.
CORRELATED = {
    0.1: [(0.9999, 0), (0.9995, 0.0003), (0.9683, 0.0314), (0.6734, 0.3252)],
    0.3: [(0.9907, 0), (0.9869, 0.0008), (0.9427, 0.0324), (0.6886, 0.2254)],
    0.5: [(0.9158, 0), (0.8958, 0.0015), (0.8349, 0.0223), (0.7499, 0.0983)],
    0.7: [(0.6977, 0), (0.6893, 0.0012), (0.6935, 0.0105), (0.7505, 0.0422)],
    1.0: [(0.3068, 0), (0.3508, 0.0004), (0.4477, 0.0030), (0.6276, 0.0140)],
}


def correlated(n_l, n_v, a):
    return 0.5 / (n_l * np.sqrt(n_v**2 * (1 - a**2) + a**2) + n_v * np.sqrt(n_l**2 * (1 - a**2) + a**2))


def summed(n_v, roughness, visibility, side=1200):
    """Return scale and bias, summed over light directions at the centres of `side` x `side` cells of equal area."""
    a = roughness**2
    n_l, p = np.meshgrid((np.arange(side) + 0.5) / side, (np.arange(side) + 0.5) / side * np.pi, indexing="ij")
    v, light = (np.sqrt(1 - n_v**2), n_v), (np.sqrt(1 - n_l**2) * np.cos(p), n_l)
    v_l = v[0] * light[0] + v[1] * light[1]
    v_h = np.sqrt((1 + v_l) / 2)
    n_h = (n_v + n_l) / (2 * v_h)
    d = a**2 / (np.pi * (n_h**2 * (a**2 - 1) + 1) ** 2)
    weight = d * visibility(n_l, n_v, a) * n_l * 2 * np.pi / side**2
    fresnel = (1 - v_h) ** 5
    return (weight * (1 - fresnel)).sum(), (weight * fresnel).sum()


@pytest.mark.parametrize("roughness", CORRELATED)
def test_scale_and_bias_match_the_known_figures(roughness):
    factors = np.stack(dfg(np.array(N_V), np.array(roughness)), -1)
    worst = np.abs(factors - CORRELATED[roughness]).max()
    assert worst < 2e-4, f"{worst}: {factors}"


@pytest.mark.parametrize("roughness", [0.3, 0.5, 0.8, 1])
@pytest.mark.parametrize("n_v", [1, 0.6, 0.1])
def test_scale_and_bias_match_a_sum_over_directions(n_v, roughness):
    direct = summed(n_v, roughness, correlated)
    factors = dfg(np.array(n_v), np.array(roughness))
    assert np.abs(np.subtract(factors, direct)).max() < 3e-4, f"{factors} against {direct}"


def test_mirror_has_only_the_fresnel_term():
    n_v = np.linspace(0, 1, SIZE) ** 2
    mirror = dfg_table()[0]
    expected = np.stack([1 - (1 - n_v) ** 5, (1 - n_v) ** 5], -1)
    assert np.abs(mirror - expected).max() < 1e-5


def test_grazing_views_are_finite_and_conserve_energy():
    """At n.v = 0 every visible microfacet is edge-on: a smooth surface reflects all light by its Fresnel term."""
    table = dfg_table()
    assert np.isfinite(table).all() and table.min() >= 0
    assert np.abs(table[1, 0].sum() - 1) < 1e-3
    assert table.sum(-1).max() < 1 + 1e-6


def looked_up(table, n_v, roughness):
    """Return values of the table, bilinear in roughness and the root of n.v, with nodes at the corners."""
    last = len(table) - 1
    x, y = np.sqrt(n_v) * last, roughness * last
    column, row = np.minimum(x.astype(int), last - 1), np.minimum(y.astype(int), last - 1)
    u, v = (x - column)[:, None], (y - row)[:, None]
    upper = table[row, column] * (1 - u) + table[row, column + 1] * u
    lower = table[row + 1, column] * (1 - u) + table[row + 1, column + 1] * u
    return upper * (1 - v) + lower * v


def test_lookup_between_nodes_matches_the_integral():
    """Half of the samples are where the table changes fastest."""
    rng = np.random.default_rng(4)
    n_v = np.concatenate([rng.uniform(0.01, 1, 2000), rng.uniform(0.01, 0.15, 2000)])
    roughness = np.concatenate([rng.uniform(0, 1, 2000), rng.uniform(0, 0.4, 2000)])
    error = np.abs(looked_up(dfg_table(), n_v, roughness) - np.stack(dfg(n_v, roughness), -1)).max(-1)
    worst = int(error.argmax())
    assert error[worst] < 1e-3, f"{error[worst]} at n.v = {n_v[worst]}, roughness {roughness[worst]}"


def test_the_table_is_computed_once():
    assert dfg_table(16) is dfg_table(16)
    with pytest.raises(ValueError, match="read-only"):
        dfg_table(16)[0, 0] = 0
