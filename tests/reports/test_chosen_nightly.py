"""Sixty pairs of codes in Choose, each with its own images."""

from test_chosen_slow import check_pairs


def test_sixty_pairs_show_their_own_images(gl_browser, tmp_path):
    check_pairs(gl_browser, tmp_path / "run", count=60)
