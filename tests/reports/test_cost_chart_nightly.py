"""The interactive chart of cost against error: a switch between GPUs, readable names and no crowded corner."""

import test_cost_chart_slow
from browsing import DESKTOP

run_folder = test_cost_chart_slow.run_folder


def test_a_wide_pages_switch_shows_another_gpu_and_no_names_overlap(run, run_folder, browser):
    test_cost_chart_slow.test_the_pages_switch_shows_another_gpu_and_no_names_overlap(run, run_folder, browser, DESKTOP)
