"""Files that declare 16-bit numbers, also measured in half arithmetic, on which the answer is based."""

import pytest

from normalbench.bench.shaders.languages.programs import has_halves


@pytest.mark.parametrize("text", ["half2 f()", "min16float3 x;", "float16_t x;", "mediump vec2 f();", "f16vec3 n;"])
def test_16_bit_numbers_are_recognised_by_their_types(text):
    assert has_halves(text)
    assert not has_halves(text.replace("half", "float").replace("16", "32").replace("mediump", "highp"))
