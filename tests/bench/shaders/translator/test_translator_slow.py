"""Programs read as syntax trees and written in every language, with their meaning, comments and positions."""

import pytest

from normalbench.bench.shaders.translator.glsl_parser import read_glsl
from normalbench.bench.shaders.translator.tree import TranslationError


def test_macros_that_expand_to_millions_of_tokens_are_refused():
    """A macro bomb of 2^30 tokens is refused before it takes memory."""
    bomb = "#define A0 1.0 +\n" + "".join(f"#define A{n} A{n - 1} A{n - 1}\n" for n in range(1, 31))
    with pytest.raises(TranslationError, match="more than 200000 tokens"):
        read_glsl(bomb + "float f() { return A30 1.0; }")
