"""The view Codecs: a list of all codecs, and everything about one codec in a card, from the run's rows."""

import test_codecs_slow

codecs_page = test_codecs_slow.codecs_page
shown = test_codecs_slow.shown


def test_another_card_has_the_figures_and_ranks_of_the_run(shown):
    test_codecs_slow.test_card_has_the_figures_and_ranks_of_the_run(shown, "stereographic rgba8", 3)
