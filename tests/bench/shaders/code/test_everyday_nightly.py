"""Everyday shaders of users, read and translated to every language with the same meaning."""

import pytest
import test_everyday_slow
from everyday import GLSL
from test_everyday_slow import OTHERS

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.parametrize("name", GLSL)
@pytest.mark.parametrize("language", ["slang", "essl"])
def test_everyday_glsl_is_read_and_means_the_same_in_slang_and_essl(language, name, tmp_path):
    test_everyday_slow.test_everyday_glsl_is_read_and_means_the_same(language, name, tmp_path)


@pytest.mark.parametrize("language, name", OTHERS)
def test_all_everyday_glsl_is_read_and_means_the_same_in_hlsl_and_wgsl(language, name, tmp_path):
    test_everyday_slow.test_everyday_glsl_is_read_and_means_the_same(language, name, tmp_path)
