"""Figures of articles, engines and libraries for codes: their number, size and spacing."""

from __future__ import annotations

import math
from functools import partial

from normalbench.encodings.normals.optimised_rings import covering_radius

from . import counts
from .figure import DEGREES, Figure
from .measures import Counted, Quality

# Points and the optimum

SMITH = (
    Figure(
        "bound of the error in 16 bits",
        "Atyuwen, normal_encoding",
        0.562432,
        6,
        DEGREES,
        Counted(lambda: math.degrees(covering_radius()), "smith"),
        "the supremum of the code itself is below that bound, 0.56223",
    ),
    Figure(
        "optimised points for 4 degrees",
        "slides",
        1334,
        0,
        "",
        Counted(partial(counts.optimised_points, 4.0), "smith"),
    ),
    Figure(
        "uniform points for 4 degrees",
        "slides",
        2112,
        0,
        "",
        Counted(partial(counts.uniform_points, 4.0), "smith"),
    ),
)
MEYER = (
    Figure(
        "bits of octahedral above the optimum",
        "abstract",
        1,
        0,
        "bits",
        Counted(counts.bits_above_the_optimum, "meyer"),
        "the article rounds its optimum of 50.2 bits up to 51 and takes 52: 1.8 bits by the maximum",
    ),
)

# Best-fit normals

UNSTATED = (
    "the source does not say which directions of a texel it takes, nor how it rounds; ours are texel centres, nearest"
)
KAPLANYAN = (
    Figure(
        "RGB8 texels that unit normals use",
        "best-fit normals",
        289880,
        0,
        "codes",
        Counted(lambda: float(counts.cells_crossed()), "kaplanyan"),
        "the unit sphere crosses 306608 of the cells; the published count is likely of samples",
    ),
    Figure(
        "their share of all texels",
        "best-fit normals",
        1.7,
        1,
        "%",
        Counted(counts.share_of_cells, "kaplanyan"),
        "for the same reason as the count of texels",
    ),
)


def _told_apart_figures(encoding: str, title: str, count: float, share: float, why: str) -> tuple[Figure, ...]:
    return (
        Figure(
            f"directions told apart by {title}",
            "table, a cube map of 256 x 256 x 6",
            count,
            0,
            "codes",
            Counted(partial(counts.told_apart, encoding), "hillaire"),
            why,
        ),
        Figure(
            f"their share by {title}",
            "table",
            share,
            1,
            "%",
            Counted(partial(counts.share_told_apart, encoding), "hillaire"),
            why,
        ),
    )


HILLAIRE = (
    *_told_apart_figures("xyz_renormalised", "scale and bias", 219890, 55.9, UNSTATED),
    Figure(
        "share of RGB8 texels that these use",
        "table",
        1.31,
        2,
        "%",
        Counted(partial(counts.share_of_texels, "xyz_renormalised"), "hillaire"),
        UNSTATED,
    ),
    *_told_apart_figures(
        "best_fit_searched",
        "best-fit normals",
        387107,
        98.4,
        "best_fit_searched takes the best of all lengths, and tells nearly all directions apart",
    ),
)

# Engines and libraries

UNITY = (
    Figure(
        "bits of the normal in the G-buffer",
        "pull request 243",
        22,
        0,
        "bits",
        Counted(partial(counts.bits, "tetrahedral", "rgb8_10_10_2"), "unity"),
    ),
    Figure(
        "bits per normal before the change",
        "pull request 243",
        20,
        0,
        "bits",
        Counted(partial(counts.bits, "octahedral", "rgb8_10_10"), "unity"),
    ),
    Figure(
        "tetrahedral 10:10:2 over 11:11, mean",
        "Packing.hlsl: similar to 11:11",
        1.0,
        1,
        "times",
        Counted(counts.tetrahedral_over_octahedral, "unity"),
        "not similar: octahedral 11:11 has a mean error a fifth lower, and a maximum nearly half as large",
    ),
)
XEOKIT = (
    Figure(
        "worst angle of octahedral 16:16",
        "octEncodeNormalsToU16: roughly 0.001 rad",
        0.001,
        3,
        "rad",
        Counted(counts.supremum_in_radians, "xeokit"),
        "15 times smaller; 0.001 rad would be the worst angle of 12:12 bits",
    ),
)
NORMAL_PACK = (
    *(
        Figure(
            f"{axis} of a normal through two bytes",
            "its test",
            value,
            digits,
            "",
            Counted(partial(counts.truncated, index), "normal_pack"),
            # Two units in the last place of float32.
            within=1.2e-7,
        )
        for index, (axis, value, digits) in enumerate((("x", -0.52032965, 8), ("y", 0.5473598, 7), ("z", 0.6554802, 7)))
    ),
    Figure(
        "mean error of two bytes",
        "documentation: less than 1 degree",
        1,
        0,
        DEGREES,
        Quality("octahedral", "rg8", "angle_mean_deg", rounding="truncate"),
        bound="below",
    ),
)
