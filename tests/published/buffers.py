"""Figures of slides and articles for layouts, light buffers and depth buffers."""

from __future__ import annotations

from functools import partial

from . import counts
from .figure import Figure
from .measures import Counted

# Layouts and light


def _bytes_figure(layout: str, what: str, value: int, source: str) -> Figure:
    return Figure(what, "slides", value, 0, "bytes", Counted(partial(counts.bytes_of_targets, layout), source))


DROBOT = (
    _bytes_figure("normal_depth", "normal 8:8 and depth of 16 bits", 4, "drobot"),
    _bytes_figure("normal_depth_material", "normal 16:16, depth and material", 8, "drobot"),
    _bytes_figure("normal_motion", "normal 8:8, motion, depth and material", 8, "drobot"),
)
JO = (_bytes_figure("hybrid", "RGBA8, two FP16 channels and RGBA8", 12, "jo kyeong"),)


def _light_figure(what: str, light_buffer: str, value: float, source: str, bound: str = "") -> Figure:
    return Figure(what, "tests", value, 1, "", Counted(partial(counts.most_light, light_buffer), source), bound=bound)


OLS_2010 = (
    _light_figure("most light of RGBA8 scaled to [0, 2]", "linear", 2.0, "blending"),
    _light_figure("most light of sRGB8 scaled to [0, 2]", "srgb", 2.0, "blending"),
)
OLS_2009 = (_light_figure("a lamp that log light holds", "log", 3.0, "log-lights", "above"),)
SHARED_EXPONENT = (_light_figure("largest number of RGB9E5", "rgb9e5", 65408.0, "shared_exponent"),)

# Depth

FAR = 1e7
OWN_LOGARITHM = (
    "his code is log(C x + 1), ours log(x / near) with near = 1 / C; they differ where C x is not large, and our "
    "encoding has one code for all depths below 1 / C"
)


def _kemen_figure(c: float, at: float, value: float, digits: int) -> Figure:
    step = partial(counts.depth_step, "logarithmic", 1 / c, FAR, 2**24, at)
    what = f"step at {at / 1e3:g} km, C = {c:g}"
    return Figure(what, "table, 24 bits, far 10,000 km", value, digits, "m", Counted(step, "kemen"), OWN_LOGARITHM)


KEMEN = (
    _kemen_figure(1, 1e0, 0.0000019, 7),
    _kemen_figure(1, 1e1, 0.000011, 6),
    _kemen_figure(1, 1e2, 0.000097, 6),
    _kemen_figure(1, 1e3, 0.001, 3),
    _kemen_figure(1, 1e4, 0.01, 2),
    _kemen_figure(1, 1e5, 0.096, 3),
    _kemen_figure(1, 1e6, 0.96, 2),
    _kemen_figure(1, 1e7, 9.6, 1),
    _kemen_figure(0.001, 1e0, 0.0005, 4),
    _kemen_figure(0.001, 1e1, 0.0005, 4),
    _kemen_figure(0.001, 1e2, 0.0006, 4),
    _kemen_figure(0.001, 1e3, 0.001, 3),
    _kemen_figure(0.001, 1e4, 0.006, 3),
    _kemen_figure(0.001, 1e5, 0.055, 3),
    _kemen_figure(0.001, 1e6, 0.549, 3),
    _kemen_figure(0.001, 1e7, 5.49, 2),
)
KEMEN_2012 = (
    Figure(
        "share of codes up to twice near",
        "half of the range",
        50,
        0,
        "%",
        Counted(partial(counts.share_of_codes, "window", 0.1, 1000.0, 0.2), "2012"),
    ),
)
GOLUBEV_PLANES = (0.1, 10000.0)
GOLUBEV = (
    Figure(
        "share of codes nearer than 1 m",
        "over 90 %",
        90,
        0,
        "%",
        Counted(partial(counts.share_of_codes, "reversed_window", *GOLUBEV_PLANES, 1.0), "golubev"),
        bound="above",
    ),
    Figure(
        "distance where a step exceeds 1 m",
        "a graph",
        1000,
        0,
        "m",
        Counted(partial(counts.depth_of_step, "reversed_window", *GOLUBEV_PLANES, 2**24, 1.0), "golubev"),
        "read off a graph; at 1000 m the step is 0.6 m",
    ),
    Figure(
        "largest step in 32-bit floats",
        "sub-millimetre",
        0.001,
        3,
        "m",
        Counted(partial(counts.largest_float_step, *GOLUBEV_PLANES), "golubev"),
        bound="below",
    ),
    Figure(
        "floats up to 1 for a 24-bit code",
        "63 times",
        63,
        0,
        "times",
        Counted(lambda: 126 * 2**23 / 2**24, "golubev"),
    ),
)
