"""Structures and parameters that functions change, as in tangent frames, in the code of every language."""

import pytest
import test_structures_slow
from test_structures_slow import OWN_REST, REST

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.parametrize("name, storage, rounding, language", REST)
def test_code_for_all_tangent_frames_gives_the_catalogues_texels(name, storage, rounding, language, tmp_path):
    test_structures_slow.test_code_for_tangent_frames_gives_the_catalogues_texels(
        name, storage, rounding, language, tmp_path
    )


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("ending, language", OWN_REST)
def test_all_tangent_frame_code_from_users_is_written(ending, language, tmp_path):
    test_structures_slow.test_a_users_tangent_frame_code_is_written(ending, language, tmp_path)
