"""The quality table, measured by WGSL on Vulkan."""

import pytest
import test_wgsl_backend
from test_wgsl_backend import row_of
from typed import codecs_named

vulkan = test_wgsl_backend.vulkan


@pytest.mark.usefixtures("vulkan")
@pytest.mark.parametrize("name", ["spheremap/rg8", "octahedral_precise/rgb10a2", "spherical_lut/rg8", "xy_sign/rg16f"])
def test_rows_measured_by_wgsl_and_by_jax_agree(name):
    """Errors agree to 1e-5, with the shader's rounding on the Vulkan device."""
    (codec,) = codecs_named(*name.split("/"), "nearest")
    row, expected = row_of(codec, "wgsl"), row_of(codec, "jax")
    assert not row["skipped"] and row["rounded_by"] == "shader" and "Vulkan" in row["device"]
    for column in ("mse", "angle_mean_deg", "angle_max_deg"):
        assert row[column] == pytest.approx(expected[column], rel=1e-5, abs=1e-12), column
    assert row["count"] == expected["count"] and not row["invalid"]


def test_a_table_without_wgsl_uses_the_other_backends_and_says_so(run):
    """`run --backend jax,wgsl` must not fail for tables without WGSL; `wgsl` alone is an error."""
    arguments = ("depth", "--depth", "linear", "--storage", "r16f", "--count", "1024", "--backend")
    status, out, err = run(*arguments, "jax,wgsl")
    assert status == 0 and "linear" in out
    assert err == "normalbench: left out: wgsl: this table measures only with jax and glsl\n"
    status, out, err = run(*arguments, "wgsl")
    assert (status, out, err) == (2, "", "normalbench: wgsl: this table measures only with jax and glsl\n")
