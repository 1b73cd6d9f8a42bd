"""The published figures, as their sources print them."""

from __future__ import annotations

import math
from functools import partial

from ....encodings.catalogue import ENCODINGS
from ....encodings.normals.optimised_rings import covering_radius
from ...metrics import published
from . import counts
from .figure import Figure, Source
from .measures import ArticleMse, Counted, InACube, Instructions, Quality

DEGREES, DECIBELS = "degrees", "dB"
LAMPS = (
    "four copies of a lamp arm in the article's scene may not be redistributed, "
    "and curved surfaces may be cut more or less finely"
)

# Pranckevicius

# The squared error as the article prints it.
ARTICLE_MSE = {
    "xyz": 0.000008,
    "xy": 0.013514,
    "spherical": 0.000062,
    "spheremap": 0.000016,
    "stereographic": 0.000038,
    "per_pixel_view": 0.000134,
}
SLOTS = (
    "a slot of ps_3_0 computes up to four numbers, and scale and bias are among the article's; "
    "an instruction here computes one number"
)
INSTRUCTIONS_2009 = (
    "an instruction of SM3.0 computes up to four numbers (a sincos is one); one here computes a single number"
)


def _of_2010() -> tuple[Figure, ...]:
    pictures = [Quality(name, published.STORAGE, "psnr_article_db", published.NORMALS) for name in published.PSNR_DB]
    return (
        *(
            Figure(f"PSNR of {by.encoding} in RGBA8", "quality", published.PSNR_DB[by.encoding], 3, DECIBELS, by, LAMPS)
            for by in pictures
        ),
        *(
            Figure(f"MSE of {name} in RGBA8", "quality", value, 6, "", ArticleMse(name), LAMPS)
            for name, value in ARTICLE_MSE.items()
        ),
        Figure(
            "PSNR of xy in RGBA8, in the summary",
            "quality comparison",
            18.629,
            3,
            DECIBELS,
            pictures[1],
            "a misprint: the article's text says 18.692, which is also what its MSE says",
        ),
        *(
            Figure(
                f"slots to {operation} {name}",
                "D3D ALU instruction slots",
                arithmetic,
                0,
                "slots",
                Instructions(name, operation),
                SLOTS,
                is_comparable=False,
            )
            for (name, operation), (arithmetic, _) in published.SLOTS.items()
        ),
    )


def _of_2009() -> tuple[Figure, ...]:
    return tuple(
        Figure(
            f"instructions to {operation} {name}",
            "instruction slots, SM3.0",
            value,
            0,
            "instructions",
            Instructions(name, operation),
            INSTRUCTIONS_2009,
            is_comparable=False,
        )
        for (name, operation), value in published.SLOTS_2009.items()
    )


# Cigolle and others

# Mean and maximum in degrees by code: digits of both as they are quoted.
CIGOLLE = {
    "oct16, 8:8": ("octahedral", "rg8_snorm", 0.33709, 0.94424),
    "oct20, 10:10": ("octahedral", "rgb8_10_10_snorm", 0.08380, 0.23467),
    "oct24, 12:12": ("octahedral", "rgb8_12_12_snorm", 0.02091, 0.05874),
    "oct32P, 16:16 precise": ("octahedral_precise", "rg16_snorm", 0.00122, 0.00246),
    "snorm 8:8:8": ("xyz_renormalised", "rgba8_snorm", 0.17015, 0.38588),
    "snorm 10:10:10": ("xyz_renormalised", "rgba8_10_10_10_snorm", 0.04228, 0.09598),
}


def _of_cigolle() -> tuple[Figure, ...]:
    table = "table of mean and maximum error"
    found = []
    for code, (encoding, storage, mean, most) in CIGOLLE.items():
        found += [
            Figure(f"mean of {code}", table, mean, 5, DEGREES, Quality(encoding, storage, "angle_mean_deg")),
            Figure(
                f"maximum of {code}",
                table,
                most,
                5,
                DEGREES,
                Quality(encoding, storage, "angle_sup_deg"),
                is_maximum=True,
            ),
        ]
    return (
        *found,
        Figure(
            "mean of oct32, 16:16", table, 0.00131, 5, DEGREES, Quality("octahedral", "rg16_snorm", "angle_mean_deg")
        ),
        Figure(
            "maximum of oct32, 16:16", table, 0.0037, 4, DEGREES, Quality("octahedral", "rg16_snorm", "angle_sup_deg")
        ),
        Figure(
            "compression of three float32 by oct16P",
            "figure 1",
            8,
            0,
            "times",
            Counted(lambda: 96 / counts.bits("octahedral_precise", "rg8_snorm"), "cigolle"),
            "three float32 have 96 bits; 8 times holds for four of them",
        ),
    )


# Digits as printed; RH is the octahedron of a half, turned by 45 degrees, which hemi_octahedral is.
TYLER = {
    "14 bits, 7:7": ("octahedral", "rg8_7_7", 0.703610, 1.905714),
    "16 bits, 8:8": ("octahedral", "rg8", 0.350526, 0.946480),
    "18 bits, 9:9": ("octahedral", "rgb8_9_9", 0.174814, 0.473682),
    "20 bits, 10:10": ("octahedral", "rgb8_10_10", 0.087357, 0.235790),
    "22 bits, 11:11": ("octahedral", "rgb8_11_11", 0.043663, 0.117949),
    "24 bits, 12:12": ("octahedral", "rgb8_12_12", 0.021842, 0.058642),
    "26 bits, 13:13": ("octahedral", "rgba8_13_13", 0.010909, 0.029560),
    "17 bits, 9:8": ("octahedral", "rgb8_9_8", 0.273192, 0.724812),
    "18 bits, 10:8": ("octahedral", "rgb8_10_8", 0.246261, 0.625927),
    "19 bits, 11:8": ("octahedral", "rgb8_11_8", 0.237676, 0.586377),
    "16P, 8:8 precise": ("octahedral_precise", "rg8", 0.327725, 0.631641),
    "18P, 9:9 precise": ("octahedral_precise", "rgb8_9_9", 0.163475, 0.315057),
    "20P, 10:10 precise": ("octahedral_precise", "rgb8_10_10", 0.081684, 0.158212),
    "14RH, 7:7 of a half": ("hemi_octahedral", "rg8_7_7", 0.501312, 1.099875),
    "16RH, 8:8 of a half": ("hemi_octahedral", "rg8", 0.249797, 0.546843),
    "18RH, 9:9 of a half": ("hemi_octahedral", "rgb8_9_9", 0.124669, 0.273832),
    "20RH, 10:10 of a half": ("hemi_octahedral", "rgb8_10_10", 0.062234, 0.136537),
    "22RH, 11:11 of a half": ("hemi_octahedral", "rgb8_11_11", 0.031113, 0.068080),
}
CUBE = "on directions of points in a cube, normalize(2 rand - 1), which are denser towards its corners"


def _of_tyler() -> tuple[Figure, ...]:
    found = []
    for code, (encoding, storage, mean, most) in TYLER.items():
        is_half = ENCODINGS[encoding].domain == "hemisphere"
        supremum = Quality(encoding, storage, "angle_sup_deg", "hemisphere" if is_half else "sphere")
        found += [
            Figure(f"mean of {code}", "tables of errors", mean, 6, DEGREES, InACube(encoding, storage, is_half), CUBE),
            Figure(f"maximum of {code}", "tables of errors", most, 6, DEGREES, supremum, is_maximum=True),
        ]
    return (
        *found,
        Figure(
            "his means above those of Cigolle et al.",
            "the slight sticking point",
            4.25,
            2,
            "%",
            Counted(counts.mean_in_a_cube_over_uniform, "tyler"),
            f"4 to 4.5 % are printed, unexplained: his means are {CUBE}",
            within=0.25,
        ),
        Figure(
            "precise rounding lowers the mean by",
            "precise encoding",
            6.5,
            1,
            "%",
            Counted(counts.mean_saved_by_precision, "tyler"),
            # Two means of a million angles each.
            within=0.12,
        ),
        Figure(
            "precise rounding lowers the maximum by",
            "precise encoding",
            33,
            0,
            "%",
            Counted(counts.maximum_saved_by_precision, "tyler"),
        ),
    )


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
        "as the count of texels",
    ),
)


def _told_apart(encoding: str, title: str, count: float, share: float, why: str) -> tuple[Figure, ...]:
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
    *_told_apart("xyz_renormalised", "scale and bias", 219890, 55.9, UNSTATED),
    Figure(
        "share of RGB8 texels that these use",
        "table",
        1.31,
        2,
        "%",
        Counted(partial(counts.share_of_texels, "xyz_renormalised"), "hillaire"),
        UNSTATED,
    ),
    *_told_apart(
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
        "bits of the normal before",
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
        "similar it is not: octahedral 11:11 is a fifth better in the mean, and nearly half in the maximum",
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
        "fifteen times less; 0.001 rad would be that of 12 bits",
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
            Counted(partial(counts.truncated, at), "normal_pack"),
            # Two units in the last place of float32.
            within=1.2e-7,
        )
        for at, (axis, value, digits) in enumerate((("x", -0.52032965, 8), ("y", 0.5473598, 7), ("z", 0.6554802, 7)))
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

# Layouts and light


def _bytes(layout: str, what: str, value: int, source: str) -> Figure:
    return Figure(what, "slides", value, 0, "bytes", Counted(partial(counts.bytes_of_targets, layout), source))


DROBOT = (
    _bytes("normal_depth", "normal 8:8 and depth of 16 bits", 4, "drobot"),
    _bytes("normal_depth_material", "normal 16:16, depth and material", 8, "drobot"),
    _bytes("normal_motion", "normal 8:8, motion, depth and material", 8, "drobot"),
)
JO = (_bytes("hybrid", "RGBA8, two FP16 channels and RGBA8", 12, "jo kyeong"),)


def _light(what: str, light_buffer: str, value: float, source: str, bound: str = "") -> Figure:
    return Figure(what, "tests", value, 1, "", Counted(partial(counts.most_light, light_buffer), source), bound=bound)


OLS_2010 = (
    _light("most light of RGBA8 scaled to [0, 2]", "linear", 2.0, "blending"),
    _light("most light of sRGB8 scaled to [0, 2]", "srgb", 2.0, "blending"),
)
OLS_2009 = (_light("a lamp that log light holds", "log", 3.0, "log-lights", "above"),)
SHARED_EXPONENT = (_light("largest number of RGB9E5", "rgb9e5", 65408.0, "shared_exponent"),)

# Depth

FAR = 1e7
OWN_LOGARITHM = "his code is log(C x + 1), ours log(x / near) with near = 1 / C; they differ where C x is not large"


def _kemen(c: float, at: float, value: float, digits: int) -> Figure:
    step = partial(counts.depth_step, "logarithmic", 1 / c, FAR, 2**24, at)
    what = f"step at {at / 1e3:g} km, C = {c:g}"
    return Figure(what, "table, 24 bits, far 10,000 km", value, digits, "m", Counted(step, "kemen"), OWN_LOGARITHM)


KEMEN = (
    _kemen(1, 1e2, 0.000097, 6),
    _kemen(1, 1e3, 0.001, 3),
    _kemen(1, 1e4, 0.01, 2),
    _kemen(1, 1e5, 0.096, 3),
    _kemen(1, 1e6, 0.96, 2),
    _kemen(1, 1e7, 9.6, 1),
    _kemen(0.001, 1e5, 0.055, 3),
    _kemen(0.001, 1e6, 0.549, 3),
    _kemen(0.001, 1e7, 5.49, 2),
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

SOURCES = (
    Source("A. Pranckevicius, Compact Normal Storage for Small G-Buffers, 2010", _of_2010()),
    Source("A. Pranckevicius, Compact Normal Storage for Small G-Buffers (Old and Wrong), 2009", _of_2009()),
    Source(
        "Z. Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014", _of_cigolle()
    ),
    Source("L. Tyler, Analyzing Octahedral Encoded Normals, 2025", _of_tyler()),
    Source("J. Smith et al., Encoding Normal Vectors using Optimized Spherical Coordinates, 2012", SMITH),
    Source("Q. Meyer et al., On Floating-Point Normal Vectors, 2010", MEYER),
    Source("A. Kaplanyan, CryENGINE 3: Reaching the Speed of Light, 2010, as a forum retells it", KAPLANYAN),
    Source("S. Hillaire, Crytek's Best Fit Normals, 2010", HILLAIRE),
    Source("Unity, ScriptableRenderPipeline, 2017", UNITY),
    Source("xeokit SDK, documentation", XEOKIT),
    Source("normal_pack 0.1.4, 2024", NORMAL_PACK),
    Source("M. Drobot, Architektury Deferred (slides)", DROBOT),
    Source("Jo Kyeong-jun, Advanced Rendering with Vision Engine (slides)", JO),
    Source("J. Ols, Linear sRGB Blending & Deferred Lighting, 2010", OLS_2010),
    Source("J. Ols, Prelighting & Log-Lights, 2009", OLS_2009),
    Source("EXT_texture_shared_exponent, 2004", SHARED_EXPONENT),
    Source("B. Kemen, Logarithmic Depth Buffer, 2009", KEMEN),
    Source("B. Kemen, Maximizing Depth Buffer Range and Precision, 2012", KEMEN_2012),
    Source("E. Golubev, Quantitative Analysis of Z-Buffer Precision, 2020", GOLUBEV),
)
