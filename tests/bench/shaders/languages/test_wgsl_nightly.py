"""Encoders in WGSL: arrays of every type."""

import pytest
import test_wgsl_slow

pytestmark = pytest.mark.usefixtures("gl")


def test_an_array_in_wgsl_has_elements_of_every_type(run, tmp_path):
    test_wgsl_slow.test_an_array_in_wgsl_has_elements_of_any_type(run, tmp_path, test_wgsl_slow.ARRAYS)
