"""The tables of docs/beyond-octahedral.md on words with normal and roughness, solved anew from the measured errors."""

from test_beyond_nightly import table

from tests import joint_word


def test_the_page_has_the_solved_figures():
    assert table("joint_word") == joint_word.rows()
    assert table("words") == joint_word.word_rows()
