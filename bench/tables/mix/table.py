"""The mix table: the effect of mixing texels on an encoding."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import Backends, Encodings, Normals, Option, Plot, Reading, Seed, StorageNames
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW, RAW = Role.KEY, Role.HOW, Role.RAW
# By operation, what is done, and what the right normal is.
OPERATIONS: Mapping[str, str] = MappingProxyType(
    {
        "filter": "bilinear filtering of stored codes at random fractions",
        "mip_2x2": "a mip level: the mean of 2 x 2 codes, stored",
        "mip_4x4": "the next mip level: the mean of four codes of the first, stored",
        "resolve": "the mean of the codes of a pixel's samples, stored: a hardware resolve",
        "resolve_decoded": "the mean of the same samples, each decoded first",
        "blend": "the code of a second normal blended over the first by the target's alpha blending",
        "blend_decoded": "both decoded, the normals blended by a shader, and the result stored",
        "detail": "the code of a detail's normal blended over its base's",
        "upsample": "half-resolution texels decoded, then weighted by distance and by how close their normals are",
    }
)
# Why a code that is an integer has no figures of the operations on stored codes.
OF_INTEGER = "an integer cannot be filtered: decode the texels, then weigh the normals"
# What a code can be used for, and the operations that decide.
USES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "filter": ("filter", "mip_2x2", "mip_4x4"),
        "blend": ("blend", "detail"),
        "resolve": ("resolve",),
        "upsample": ("upsample",),
    }
)
VERDICTS: Mapping[str, str] = MappingProxyType(
    {"filter": "filterable", "blend": "blendable", "resolve": "resolvable", "upsample": "upsamplable"}
)
# Of the same verdicts, those across an edge.
ACROSS = "_across"
# A result is garbage where it is this much farther off than the texels' own errors explain, in degrees, or farther than
# every texel of the mix is from the right normal.
GARBAGE_DEG = 5.0
# What the texels' own errors explain: twice the largest, which is read once and written once. Where stored codes are
# mixed it is no more than twice this: a code that is farther off by itself is not excused for it.
MOST_ALONE_DEG = 1.0
# A code can be used where nothing is garbage and the largest error, less twice that of the texels alone, is at most
# this share of the largest angle between the right normal and a texel that was mixed. A map that has a kink and no seam
# stays below it: of those of the catalogue hemi-octahedral comes nearest, with 0.62.
MOST_ADDED = 0.75
# Verdicts are by patches whose neighbours lie at most so many degrees apart, and by an image's own neighbours.
MOST_JUDGED_DEG = 5.0
# The model agrees with the device where they differ by no more, in degrees.
AGREE_DEG = 0.01
COUNT = 4096
MOST_COUNT = 2**16


@dataclass(frozen=True, kw_only=True)
class MixOptions(Reading, SourceOptions):
    """Options for what `mix` measures. Names and numbers are comma-separated."""

    encoding: Encodings = (
        *("xyz", "xyz_renormalised", "xy", "xy_sign", "spherical", "latitude_longitude", "spheremap", "stereographic"),
        *("octahedral", "hemi_octahedral", "signed_octahedral", "spherical_fibonacci"),
    )
    storage: StorageNames = ("rgba8",)
    operation: Annotated[Names, Option("--operation", f"{', '.join(OPERATIONS)}; comma-separated, or all.")] = ("all",)
    normals: Normals = ("sphere", "axes")
    angle: Annotated[
        Names,
        Option(
            "--angle",
            "Degrees between neighbours, comma-separated. Not used for images, which have their own neighbours.",
        ),
    ] = ("1", "5", "20")
    edge: Annotated[
        Names,
        Option("--edge", "Degrees across an edge through a patch, comma-separated, or none. Not used for images."),
    ] = ("60",)
    backend: Backends = ("jax", "glsl")
    samples: Annotated[int, Option("--samples", "Samples per pixel to resolve; the device may use more.")] = 4
    power: Annotated[float, Option("--power", "Specular power that Toksvig's formula starts from.")] = 64.0
    count: Annotated[int, Option("--count", "Number of mixes per set and angle.")] = COUNT
    worst_case: Annotated[
        bool, Option("--worst-case", "Search for the worst mix of each operation; takes seconds per codec.")
    ] = False
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class MixOutputs:
    """Files that `mix` writes besides its rows."""

    plot: Plot = None


def _degrees_column(name: str, says: str, drops: int = 0) -> Column:
    return Column(name, says, unit="degrees", better="less", drops=drops)


def _verdict_column(use: str) -> Column:
    decides = ", ".join(USES[use])
    text = f"The verdict, yes or no, from all rows of {decides} for this codec and backend "
    inside = f"inside a surface: those without an edge, with angle_deg of at most {MOST_JUDGED_DEG:g}."
    return Column(VERDICTS[use], f"{text}{inside}", HOW)


def _across_column(use: str) -> Column:
    text = f"The same across an edge: from rows of {', '.join(USES[use])} with an edge."
    return Column(f"{VERDICTS[use]}{ACROSS}", text, HOW, drops=3)


COLUMNS = (
    shared.ENCODING,
    shared.STORAGE,
    Column("normals", "The set of normals: patches about its directions, or the neighbours of an image.", KEY),
    Column("angle_deg", "The angle between neighbours; empty for an image's own.", KEY, "degrees"),
    Column("edge_deg", "The angle across an edge that runs through each patch; empty for none.", KEY, "degrees"),
    Column(
        "operation",
        f"{'; '.join(f'{name}: {text}' for name, text in OPERATIONS.items())}. The right normal is the same mix of "
        "the exact unit normals, renormalised. For detail it is reoriented normal mapping of the base and the detail, "
        "whose tilt is scaled by alpha.",
        KEY,
    ),
    Column(
        "backend", "jax: a model in JAX and 32-bit floats; glsl: the OpenGL driver's own filtering and blending.", KEY
    ),
    shared.BITS,
    Column("count", "Number of mixes measured: those with all texels in the encoding's domain.", HOW, drops=9),
    Column("invalid", "Results that are NaN or infinite; each counts as 180 degrees.", better="less", drops=8),
    _degrees_column("alone_mean_deg", "Mean error of the texels without any mixing.", 7),
    _degrees_column("alone_max_deg", "Largest error of the texels without any mixing."),
    _degrees_column("angle_mean_deg", "Mean angle between the result, decoded, and the right normal."),
    _degrees_column("angle_p99_deg", "99th percentile of these angles.", 6),
    _degrees_column("angle_max_deg", "The largest of these angles among the sampled mixes: not a bound."),
    Column(
        "angle_worst_deg",
        "The largest angle found by a search that climbs from the worst sampled mix, with the model. For the whole "
        "sphere, patches are rotated and weighted freely; for other sets only the weights change. Only in rows of "
        "jax.",
        unit="degrees",
        better="less",
        option="worst_case",
    ),
    _degrees_column("added_max_deg", "What mixing adds: angle_max_deg minus alone_max_deg.", 5),
    Column(
        "geometry_max_deg",
        "Largest error with exact normals: 0 except for detail, because blending follows a straight line.",
        HOW,
        "degrees",
        drops=4,
    ),
    Column("reach_max_deg", "Largest angle between a right normal and a texel of its mix.", HOW, "degrees", drops=4),
    Column(
        "garbage_percent",
        f"Results with an error above {GARBAGE_DEG:g} degrees, or above the angle between the right normal and the "
        "farthest texel of the mix, because the texels are across a seam. Twice alone_max_deg and the error of the "
        f"geometry are added to these limits; for mixes of stored codes, at most {MOST_ALONE_DEG:g} degree counts.",
        unit="%",
        better="less",
    ),
    Column(
        "garbage_error_percent",
        "Standard error of garbage_percent, by the rule of succession: not 0 even if no garbage was found.",
        HOW,
        "%",
        drops=4,
    ),
    Column(
        "worst_first",
        "For the mix with the largest error, sampled or found: one of its two texels that are farthest apart.",
        RAW,
        drops=1,
    ),
    Column("worst_second", "The other texel.", RAW, drops=1),
    Column("worst_right", "The right normal of that mix.", RAW, drops=1),
    Column("worst_result", "The result of that mix.", RAW, drops=1),
    Column(
        "power_error_percent",
        "Mean error of the specular power that Toksvig's formula gives for the length of the result, before it is "
        "renormalised, compared with the length of the exact mean.",
        unit="%",
        better="less",
        drops=3,
    ),
    Column(
        "power_decoded_percent",
        "The same for the mean of the decoded texels, as in a tool that packs mip levels.",
        unit="%",
        better="less",
        drops=3,
    ),
    *map(_verdict_column, USES),
    *map(_across_column, USES),
    Column("why", "The reason for a verdict of no.", HOW, drops=2),
    Column(
        "mixed_by",
        "The arithmetic with which the model reproduces the device's numbers; `its own arithmetic`, with the largest "
        "difference, if no known arithmetic does. `fractions of 8 bits` refers to a filter's position between two "
        "texels.",
        HOW,
        drops=2,
    ),
    Column(
        "agree_percent",
        f"Share of the results that the model reproduces to {AGREE_DEG} degrees when it mixes the codes stored by the "
        "device in that arithmetic.",
        HOW,
        "%",
        drops=2,
    ),
    shared.CODE_SPACE,
    Column("samples", "Samples per pixel that were resolved.", HOW, drops=2),
    Column("power", "Specular power that Toksvig's formula started from.", HOW, drops=2),
    shared.DEVICE,
    shared.SEED,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure filtering, mip levels, MSAA resolve and blending of codes.\n\nThe verdict for each codec is "
    "filterable, blendable and resolvable, or why not. `pick --needs filter,blend,resolve` leaves out codecs "
    "that are not.",
    example="normalbench mix --encoding octahedral,xyz --storage rgba8 --angle 5",
    step_s=0.05,
    options=MixOptions,
    outputs=MixOutputs,
    columns=COLUMNS,
    usual=(
        {
            "encoding": "xyz,xyz_largest,xy,xy_sign,spherical,spheremap,octahedral,hemi_octahedral",
            "angle": "5",
            "count": 2048,
        },
    ),
    single={
        "encoding": "octahedral",
        "operation": "filter",
        "normals": "axes",
        "angle": "5",
        "edge": "none",
        "backend": "jax",
    },
    section=Section(
        title="Filtering, blending and resolve",
        short="Mixing",
        view=View.CODECS,
        intro="Texture filters, mip levels, multisample resolves and alpha blending average stored codes. What do "
        "these averages decode to?",
        method="Patches of 4 x 4 normals are placed about the directions of a set, rotated at random, so that seams "
        "pass between their texels. The normals are encoded and stored, their codes are mixed, and the result "
        "is decoded and compared with the same mix of the exact normals. GLSL mixes with the OpenGL driver's "
        "own filtering, resolve and blending; the model computes the same in 32-bit floats.",
    ),
)
