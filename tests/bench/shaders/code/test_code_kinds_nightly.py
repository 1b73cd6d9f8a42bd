"""Code of motion vectors, depth, light and curves, run in each language and compared with the catalogue."""

import pytest
import test_code_kinds_slow
from test_code_kinds_slow import pairs


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind, name, storage, language", pairs())
def test_code_for_a_kind_gives_the_catalogues_texels_in_any_language(kind, name, storage, language, tmp_path):
    test_code_kinds_slow.test_code_for_a_kind_gives_the_catalogues_texels(kind, name, storage, language, tmp_path)
