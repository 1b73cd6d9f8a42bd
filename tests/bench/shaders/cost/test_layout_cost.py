"""Costs of packing and unpacking whole layouts: counted by hand, and zero for floats with every vendor's compiler."""

from dataclasses import replace

import pytest

from normalbench.bench.shaders.code.whole.kernel import pack_operation
from normalbench.bench.shaders.translator.glsl_parser import read_glsl
from normalbench.bench.shaders.translator.tree import TranslationError
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.gl.shader import ShaderError
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import targets_of


def test_a_layout_whose_code_cannot_be_written_has_no_kernel():
    view = replace(
        LAYOUTS["fp32"], targets=targets_of("rgba8: normal.x normal.y"), encoding=ENCODINGS["per_pixel_view"]
    )
    with pytest.raises(ShaderError, match="depends on the pixel's position"):
        pack_operation(view)


def test_array_types_can_be_parameters_return_values_and_macros():
    program = read_glsl(
        "#version 430\n#define FOUR float[4]\n"
        "FOUR same(float[4] x, float y[4]) { FOUR made; made[0] = x[0] + y[0]; return made; }"
    )
    (function,) = program.functions
    assert [function.kind, *(parameter.kind for parameter in function.parameters)] == ["float[4]"] * 3
    with pytest.raises(TranslationError):
        read_glsl("#version 430\nfloat f(float[4] x[2]) { return x[0][0]; }")
