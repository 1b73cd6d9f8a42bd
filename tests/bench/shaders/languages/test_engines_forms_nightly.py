"""Encoders in the forms that engines write: each is read as it lies, and has the figures of the code that it is."""

import pytest
import test_engines_forms_slow


@pytest.mark.usefixtures("slang")
def test_thousands_of_functions_that_are_wrong_stand_in_no_pairs_way(tmp_path):
    test_engines_forms_slow.test_hundreds_of_functions_that_are_wrong_stand_in_no_pairs_way(tmp_path, 1000)


OF_OCTAHEDRAL = (
    *("names.glsl", "other.glsl", "prelude.glsl", "namespace.hlsl", "select.hlsl", "other.hlsl", "modify.hlsl"),
    *("mine.ush", "mine.hlsl.h", "a+b/mine.hlsl"),
)
OF_XY = ("mediump.glsl", "binding.wgsl", "taken.wgsl", "struct.hlsl", "half_literal.hlsl", "f16.hlsl")


@pytest.mark.usefixtures("gl")
def test_octahedral_has_its_mean_in_further_forms(run, tmp_path):
    test_engines_forms_slow.test_octahedral_has_its_mean_in_every_form(run, tmp_path, OF_OCTAHEDRAL)


@pytest.mark.usefixtures("gl")
def test_xy_has_its_mean_in_further_forms(run, tmp_path):
    test_engines_forms_slow.test_xy_has_its_mean_in_every_form(run, tmp_path, OF_XY)
