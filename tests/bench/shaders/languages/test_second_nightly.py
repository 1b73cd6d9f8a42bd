"""Translations, confirmed by a second compiler before they are measured."""

import pytest
import test_second
import test_second_slow
from test_second_slow import DIVISIONS, FEW

pytestmark = pytest.mark.usefixtures("gl", "in_this_process")
empty_cache = test_second.empty_cache


@pytest.mark.usefixtures("hlsl", "slang")
def test_a_remainder_that_glslang_misreads_is_measured_as_hlsl_defines_it(tmp_path):
    test_second_slow.test_hlsl_that_glslang_misreads_is_measured_as_hlsl_defines_it("remainder", tmp_path)


@pytest.mark.usefixtures("hlsl", "slang")
def test_matrix_that_glslang_misreads_is_not_measured_by_glslang_alone(tmp_path):
    test_second_slow.test_code_that_glslang_misreads_is_not_measured_by_glslang_alone(
        tmp_path, "float2x2", "mul((float2x2)1, p)"
    )


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("name", [name for name in DIVISIONS if name not in FEW])
def test_all_integer_divisions_are_noted(name, tmp_path):
    test_second_slow.test_integer_divisions_are_noted(name, tmp_path)


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize(
    "body",
    [
        "return float2(int(n.x * 1e12) * 1e-10, n.y);",
        "int2 k = int2(n.xy * 1000.0); return n.xy + float2(k % 7) * 1e-3;",
    ],
    ids=["beyond whole numbers", "negative remainder"],
)
def test_other_driver_dependent_results_are_refused(body, tmp_path):
    test_second_slow.test_driver_dependent_results_are_refused(body, tmp_path)
