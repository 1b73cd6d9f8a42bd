"""Shaders as people write them: read, and meant the same in every language."""

from itertools import product

import pytest
import test_everyday
from everyday import GLSL
from slowly import a_tenth
from test_everyday import NESTED

pytestmark = pytest.mark.usefixtures("gl")

TWO = ["hlsl", "wgsl"]
OTHERS = [*product(TWO, [name for name in GLSL if name not in NESTED])]


@pytest.mark.parametrize("language, name", [*product(TWO, NESTED), *a_tenth(OTHERS)])
def test_everyday_glsl_is_read_and_means_the_same_in_two_more(language, name, tmp_path):
    test_everyday.test_everyday_glsl_is_read_and_means_the_same(language, name, tmp_path)
