"""Chart colours: distinct on either paper, also for people who do not see red, green or blue."""

import itertools
import re

import numpy as np
import pytest

from normalbench.reports.charts.chart import COLOURS, DARK, Names
from normalbench.reports.page.page import WEB

# What is seen without one kind of cones, of linear RGB: G. M. Machado, M. M. Oliveira and L. A. F. Fernandes, A
# Physiologically-based Model for Simulation of Color Vision Deficiency (2009), severity 1.0.
SIGHTS = {
    "all": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "no red": ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)),
    "no green": ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)),
    "no blue": ((1.255528, -0.076749, -0.178779), (-0.078411, 0.930809, 0.147602), (0.004733, 0.691367, 0.303900)),
}
# Linear RGB to cones, and their cube roots to OKLab: B. Ottosson, A perceptual color space for image processing (2020).
CONES = ((0.4122214708, 0.5363325363, 0.0514459929), (0.2119034982, 0.6806995451, 0.1073969566))
CONES = np.array((*CONES, (0.0883024619, 0.2817188376, 0.6299787005)))
OKLAB = ((0.2104542553, 0.7936177850, -0.0040720468), (1.9779984951, -2.4285922050, 0.4505937099))
OKLAB = np.array((*OKLAB, (0.0259040371, 0.7827717662, -0.8086757660)))
# In OKLab, where 0.02 is about the least that is seen; and of neighbours in a sequence, which are never far in hue.
APART, NEIGHBOURS = 0.075, 0.04
PALETTES = {"white": COLOURS, "dark": DARK}


def linear(colours) -> np.ndarray:
    """Return linear RGB of #RRGGBB, of shape (count, 3)."""
    bytes_ = np.array([[int(colour[start : start + 2], 16) for start in (1, 3, 5)] for colour in colours]) / 255
    return np.where(bytes_ <= 0.04045, bytes_ / 12.92, ((bytes_ + 0.055) / 1.055) ** 2.4)


def seen(colours, sight: str) -> np.ndarray:
    """Return colours in OKLab as this kind of sight shows them, of shape (count, 3)."""
    return np.cbrt(np.clip(linear(colours) @ np.array(SIGHTS[sight]).T, 0, 1) @ CONES.T) @ OKLAB.T


def least(colours, sight: str) -> tuple[float, str, str]:
    """Return the smallest distance between two colours, and these two colours."""
    pairs = itertools.combinations(zip(seen(colours, sight), colours, strict=True), 2)
    return min((float(np.linalg.norm(a - b)), colour, other) for (a, colour), (b, other) in pairs)


def papers() -> dict[str, str]:
    """Return the colour of the page's paper in each theme."""
    match = re.search(r"--paper: light-dark\((#\w+), (#\w+)\)", (WEB / "page.css").read_text())
    assert match
    return {"white": match[1], "dark": match[2]}


def contrasts(colours, paper: str) -> np.ndarray:
    """Return the contrast of each colour with the paper, by WCAG 2.1."""
    light = linear([*colours, paper]) @ (0.2126, 0.7152, 0.0722) + 0.05
    return np.maximum(light[:-1], light[-1]) / np.minimum(light[:-1], light[-1])


def test_white_has_lightness_one_and_black_has_lightness_zero():
    """The matrices have no typing errors: rows of cones and of sights sum to one, so that grey stays grey."""
    for sight in SIGHTS:
        assert seen(["#FFFFFF", "#000000"], sight) == pytest.approx(np.array([[1, 0, 0], [0, 0, 0]]), abs=2e-3)


def test_former_grey_and_pink_look_alike_without_green_vision():
    """Okabe and Ito's grey and pink were two of the nine colours that charts had before."""
    assert least(("#CC79A7", "#999999"), "no green")[0] < 0.02


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("paper", PALETTES)
def test_any_two_colours_are_distinct(paper, sight):
    assert least(PALETTES[paper], sight)[0] >= APART, least(PALETTES[paper], sight)


@pytest.mark.parametrize("paper", PALETTES)
def test_colours_stand_out_from_the_paper(paper):
    ordered = Names("bits", tuple(range(7)), is_ordered=True).colours(paper == "dark")
    for colours in (PALETTES[paper], ordered):
        assert contrasts(colours, papers()[paper]).min() >= 3, dict(
            zip(colours, contrasts(colours, papers()[paper]), strict=True)
        )


@pytest.mark.parametrize("sight", SIGHTS)
@pytest.mark.parametrize("count", [2, 5, 7])
def test_ordered_colours_go_from_near_the_paper_to_far_from_it(count, sight):
    names = Names("bits", tuple(range(count)), is_ordered=True)
    for is_dark, way in ((False, -1), (True, 1)):
        shown = seen(names.colours(is_dark), sight)
        assert (way * np.diff(shown[:, 0]) > 0).all()
        assert np.linalg.norm(np.diff(shown, axis=0), axis=1).min() >= NEIGHBOURS


def test_one_ordered_value_has_a_colour_and_the_palette_repeats():
    assert len(Names("bits", (16,), is_ordered=True).colours()) == 1
    assert Names("codec", tuple(range(len(COLOURS) + 1))).colours()[-1] == COLOURS[0]
