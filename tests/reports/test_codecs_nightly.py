"""The view Codecs: a list of all, and everything about one codec in a card, as the run's rows have it."""

import test_codecs_slow

codecs_page = test_codecs_slow.codecs_page
shown = test_codecs_slow.shown


def test_a_further_card_has_the_figures_of_the_runs_rows_and_their_places(shown):
    test_codecs_slow.test_a_card_has_the_figures_of_the_runs_rows_and_their_places(shown, "stereographic rgba8", 3)
