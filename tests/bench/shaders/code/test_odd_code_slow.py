"""Emitted code of light, quantities, motion and depth, given what no image should hold: it gives the catalogue's
texels, which encodings/test_odd_values.py holds to what formats' specifications say."""

import pytest
import test_odd_code
from languages import RUN

# What C's compiler alone does not show: each language has its own max, and a way of its own to compare.
FEW = [
    ("light", "rgb9e5", "rgba8"),
    ("light", "log", "rgba8"),
    ("curve", "srgb", "r8"),
    ("depth", "window", "packed24"),
]


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    "kind, name, storage, language", [(*codec, language) for codec in FEW for language in RUN if language != "c"]
)
def test_code_gives_the_catalogues_texels_of_odd_values_in_others(kind, name, storage, language, tmp_path):
    test_odd_code.test_code_gives_the_catalogues_texels_of_odd_values(kind, name, storage, language, tmp_path)
