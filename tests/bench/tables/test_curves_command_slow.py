"""`normalbench curves`: errors known from theory, dithering, output and messages for bad input."""

import json
from pathlib import Path

import pytest
from test_curves_command import QUICK

OWN = Path(__file__).parents[2] / "inputs/own_codes/roughness.hlsl"


@pytest.mark.usefixtures("gl")
def test_a_users_copy_of_a_curve_has_the_catalogues_rows(run):
    """roughness.hlsl is a copy of `squared` and gives the same figures in GLSL."""
    words = ("--encoding", f"{OWN},squared", "--storage", "r8,unorm:6", "--backend", "glsl", "--count", "4096")
    status, out, _ = run("curves", *words, "--format", "json")
    rows = json.loads(out)
    own, known = ([row for row in rows if (row["encoding"] == "squared") == is_known] for is_known in (False, True))
    assert status == 0 and len(own) == len(known) == 2
    for new, other in zip(own, known, strict=True):
        assert all(new[name] == other[name] for name in ("storage", "error_mean", "error_max", "relative_max", "least"))


def test_rows_are_sorted_by_bits_and_then_by_error(run):
    status, out, err = run(*QUICK, "--encoding", "linear,srgb", "--storage", "unorm:4..6")
    rows = json.loads(out)
    assert status == 0 and not err and [row["bits"] for row in rows] == [4, 4, 5, 5, 6, 6]
    assert all(best["error_max"] <= other["error_max"] for best, other in zip(rows[::2], rows[1::2], strict=True))
