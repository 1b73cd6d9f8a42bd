"""Encoders in the forms that engines use, read unchanged and measured like the catalogue's encodings."""

import pytest
import test_engines_forms_slow


@pytest.mark.usefixtures("slang")
def test_thousands_of_invalid_functions_do_not_block_a_pair(tmp_path):
    test_engines_forms_slow.test_hundreds_of_invalid_functions_do_not_block_a_pair(tmp_path, 1000)


OF_OCTAHEDRAL = (
    *("names.glsl", "other.glsl", "prelude.glsl", "namespace.hlsl", "select.hlsl", "other.hlsl", "modify.hlsl"),
    *("mine.ush", "mine.hlsl.h", "a+b/mine.hlsl"),
)
OF_XY = ("mediump.glsl", "binding.wgsl", "taken.wgsl", "struct.hlsl", "half_literal.hlsl", "f16.hlsl")


@pytest.mark.usefixtures("gl")
def test_octahedral_has_the_expected_mean_in_more_forms(run, tmp_path):
    test_engines_forms_slow.test_octahedral_has_the_expected_mean_in_every_form(run, tmp_path, OF_OCTAHEDRAL)


@pytest.mark.usefixtures("gl")
def test_xy_has_the_expected_mean_in_more_forms(run, tmp_path):
    test_engines_forms_slow.test_xy_has_the_expected_mean_in_every_form(run, tmp_path, OF_XY)
