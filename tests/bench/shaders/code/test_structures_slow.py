"""Structures, and parameters that functions change, in the code of every language; tangent frames are such."""

import pytest
import test_structures
from languages import RUN
from slowly import a_tenth
from test_structures import ENDINGS, FAST, FRAMES, agreement_of, frame_codec, in_languages
from test_structures import test_the_code_of_tangent_frames_gives_the_catalogues_texels as code_gives_the_texels

from normalbench.encodings.catalogue import FRAME_ENCODINGS

pytestmark = pytest.mark.usefixtures("gl")


OTHERS = [language for language in RUN if language not in FAST]


# Words of bits, and half floats: the rest of the catalogue is drawn.
FIRST = [row for row in FRAMES if row[0] in ("smallest_three", "qtangent")]
REST = in_languages([row for row in FRAMES if row not in FIRST], OTHERS)
# Of users' files that in HLSL, whose structures are read by the most rules.
OWN_FIRST, OWN_REST = (
    in_languages([("hlsl",)], OTHERS),
    in_languages([ending for ending in ENDINGS if ending != ("hlsl",)], OTHERS),
)


@pytest.mark.parametrize("name, storage, rounding, language", [*in_languages(FIRST, OTHERS), *a_tenth(REST)])
def test_the_code_of_tangent_frames_gives_the_catalogues_texels_in_any_language(
    name, storage, rounding, language, tmp_path
):
    code_gives_the_texels(name, storage, rounding, language, tmp_path)


def test_every_code_of_tangent_frames_is_written(tmp_path):
    """In the first storage where each usually lies, in C."""
    for name in FRAME_ENCODINGS:
        found = agreement_of(frame_codec(name, ""), "c", tmp_path)
        assert found.holds, f"{name}: {found.says}"


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize("ending, language", [*OWN_FIRST, *a_tenth(OWN_REST)])
def test_a_users_code_of_tangent_frames_is_written_in_any_language(ending, language, tmp_path):
    test_structures.test_a_users_code_of_tangent_frames_is_written(ending, language, tmp_path)


@pytest.mark.parametrize("language", OTHERS)
def test_structures_of_users_are_written_in_any_language(language, tmp_path):
    test_structures.test_structures_of_users_are_written(language, tmp_path)
