"""The quality table: the errors of each codec on the normals of a set."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.counts import DEFAULT_COUNT
from ...ground.options.option import (
    NAMED,
    Arithmetics,
    BackendsAndWgsl,
    Count,
    Encodings,
    Images,
    Live,
    Option,
    Reading,
    RoundingsAndDithered,
    Seed,
    StorageNames,
)
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW, RAW = Role.KEY, Role.HOW, Role.RAW


@dataclass(frozen=True, kw_only=True)
class QualityOptions(Reading, SourceOptions):
    """Options of `quality`. Names are comma-separated."""

    encoding: Encodings = ("all",)
    storage: StorageNames = ("rgba8",)
    rounding: RoundingsAndDithered = ("nearest",)
    arithmetic: Arithmetics = ("declared",)
    normals: Annotated[
        Names,
        Option(
            "--normals",
            f"Normal sets or files, {NAMED}. `domain`: all directions of the encoding (sphere, axes; or hemisphere).",
            files=True,
            in_run=True,
        ),
    ] = ("playground",)
    backend: BackendsAndWgsl = ("jax", "glsl")
    count: Count = DEFAULT_COUNT
    seed: Seed = 0
    worst_case: Annotated[
        bool,
        Option("--worst-case", "Find the supremum and its normal, in float64; takes seconds per codec.", in_run=True),
    ] = False
    codes: Annotated[
        bool,
        Option(
            "--codes",
            "Count unused, duplicate and unstable codes, up to 2^24 codes; takes seconds per codec.",
            in_run=True,
        ),
    ] = False


@dataclass(frozen=True, kw_only=True)
class QualityOutputs:
    """Outputs of `quality` other than its rows."""

    images: Images = None
    maps: Annotated[
        Path | None, Option("--maps", "Write the angle in each direction to this folder, one array per codec.")
    ] = None
    live: Live = None


def _supremum_column(name: str, says: str, role: Role = Role.FIGURE, unit: str = "", drops: int = 0) -> Column:
    return Column(name, says, role, unit, "less" if name == "angle_sup_deg" else "", drops, option="worst_case")


def _angle_column(name: str, says: str, drops: int = 0) -> Column:
    return Column(name, says, unit="degrees", better="less", drops=drops)


COLUMNS = (
    shared.ENCODING,
    shared.STORAGE,
    shared.ROUNDING_OR_DITHERED,
    Column("normals", "The set of normals that was measured.", KEY),
    shared.BACKEND,
    shared.BITS,
    Column("count", "How many normals were measured.", HOW, drops=13),
    Column(
        "background", "Pixels without a surface and vertices without a direction; these are not counted.", HOW, drops=3
    ),
    Column(
        "own_error_deg",
        "Estimated mean error of the file's own normals, if its vertices, maps or pixels are rounded: the mean angle "
        "to the same normals with steps four times as wide, divided by 4.",
        HOW,
        "degrees",
        drops=12,
    ),
    Column("not_finite", "Normals of the set that were NaN or infinite; these are not counted.", HOW, drops=4),
    shared.CODE_SPACE,
    Column(
        "invalid",
        "Decodes that were NaN or infinite; each counts as the opposite direction.",
        better="less",
        shown=False,
    ),
    Column("mse", "Mean squared error of a normal's three components.", better="less", drops=8),
    Column(
        "psnr_db",
        "Peak signal-to-noise ratio, peak 1, over covered pixels. Decodes are not renormalised before the comparison.",
        unit="dB",
        better="more",
    ),
    Column(
        "psnr_article_db",
        "PSNR as the article measures it: the difference rounded to 8 bits, background included.",
        unit="dB",
        better="more",
    ),
    _angle_column("angle_mean_deg", "Mean angle between normal and decode."),
    _angle_column("angle_rms_deg", "Root of the mean squared angle.", drops=12),
    _angle_column("angle_p99_deg", "99th percentile of the angles.", drops=14),
    _angle_column("angle_max_deg", "The largest sampled angle; the supremum is angle_sup_deg."),
    Column("worst_normal", "The normal with the largest error: x, y and z.", RAW, drops=1),
    Column("worst_decode", "The decode of `worst_normal`.", RAW, drops=1),
    _supremum_column(
        "angle_sup_deg",
        "The supremum: the largest angle in exact arithmetic, searched for in float64. For a finite set it is the "
        "maximum over the set. Empty if the set is larger than `domain`. The error of float32 is in angle_max_deg "
        "only.",
        unit="degrees",
    ),
    _supremum_column("sup_x", "The normal at the supremum, x.", RAW, drops=11),
    _supremum_column("sup_y", "The normal at the supremum, y.", RAW, drops=10),
    _supremum_column("sup_z", "The normal at the supremum, z.", RAW, drops=9),
    _supremum_column(
        "sup_found_by",
        "How the supremum was found: `all corners` of all cells, `corners` of selected cells if there are more than "
        "2^24, `nearest codes` between points of a lookup, or `climbing` from the worst of many directions.",
        HOW,
    ),
    _supremum_column(
        "sup_moved_deg", "How much the last round of the search still raised the supremum.", HOW, "degrees"
    ),
    Column(
        "half_loss_percent",
        "For half arithmetic: how much larger the RMS angle is than with the same encoding in float32.",
        unit="percent",
        better="less",
    ),
    shared.ANGLE_COUNTS,
    Column(
        "effective_bits",
        "log2 of the number of ideally placed codes that have this RMS angle; uniform sets only.",
        unit="bits",
        better="more",
    ),
    Column(
        "domain",
        "Directions that bounds and suprema are for: sphere, or hemisphere (z >= 0); empty if the set is not uniform.",
        HOW,
        drops=7,
    ),
    shared.CODES,
    Column(
        "code_range",
        "[0, 1] if the encoder's numbers fill that range, so that every storage holds them unchanged. Otherwise empty.",
        HOW,
        drops=7,
    ),
    Column(
        "best_codec",
        "For an encoding that packs itself: the codec of the catalogue with the smallest mean angle at the same bit "
        "count, or at the next lower bit count.",
        HOW,
        drops=2,
    ),
    Column("best_mean_deg", "The mean angle of best_codec on 16384 random normals.", HOW, "degrees", drops=2),
    Column(
        "limit_mean_deg",
        "Bound on the mean angle for this number of codes.",
        HOW,
        "degrees",
    ),
    Column("limit_rms_deg", "Bound on the RMS angle for this number of codes.", HOW, "degrees"),
    Column("limit_max_deg", "Bound on the largest angle for this number of codes.", HOW, "degrees"),
    *shared.REACHED,
    shared.BELOW_LIMIT,
    Column(
        "codes_unused",
        "Codes that no normal of `domain` was encoded to. The search tries the middle, edges and corners of each "
        "cell, and 64 directions per code (4 for 24 bits, where the count is an upper bound for three components and "
        "for lookup tables).",
        better="less",
        option="codes",
    ),
    Column(
        "codes_duplicate",
        "All codes, used or not, minus the distinct directions that they decode to: the number of codes that could "
        "be saved.",
        better="less",
        option="codes",
    ),
    Column(
        "codes_unstable",
        "Used codes whose decoded normal, in float32, encodes to a different code.",
        better="less",
        option="codes",
    ),
    shared.EXACT,
    shared.DEVICE,
    shared.ROUNDED_BY,
    shared.SEED,
    shared.SKIPPED,
)
ALSO = (
    Column(
        "article_db",
        "The article's figure: A. Pranckevicius, Compact Normal Storage for Small G-Buffers, 2010.",
        unit="dB",
    ),
    Column("psnr_article_db_*", "PSNR as the article measures it, for that backend.", unit="dB", better="more"),
    Column("psnr_db_*", "PSNR over covered pixels, peak 1, for that backend.", unit="dB", better="more"),
    Column("mean", "Mean angle between normal and decode.", unit="degrees", better="less"),
    Column("p99", "99th percentile of the angles.", unit="degrees", better="less"),
    Column("max", "The largest sampled angle; not the supremum.", unit="degrees", better="less"),
)
# The article's methods, what engines ship, and what stands on the ladder of the default answer.
COMMON = (
    *("xyz", "xyz_renormalised", "xy", "xy_sign", "spherical", "spherical_lut", "spheremap", "spheremap_classic"),
    *("cryengine3", "stereographic", "per_pixel_view", "octahedral", "octahedral_precise", "best_fit"),
    *("xyz_largest", "warped_cube", "spherical_fibonacci"),
)
# Of these, the ones with two numbers.
TWO = (
    *("xy", "xy_sign", "spherical", "spherical_lut", "spheremap", "spheremap_classic", "cryengine3"),
    *("stereographic", "per_pixel_view", "octahedral", "spherical_fibonacci"),
)
# Of these, what is worth more than 16 bits.
WIDE = ("octahedral", "octahedral_precise", "spheremap", "spherical")
SETS = "playground,hemisphere"
# A code that somebody names is measured on all directions that it is made for.
SETS_OF_NAMED = f"{SETS},domain"

TABLE = Table(
    is_usual=True,
    package=__package__ or "",
    help="Measure the error of encodings: PSNR, angles, effective bits.\n\nA set may be a file: a captured frame "
    "(EXR, PNG, TIFF, DDS, HDR, WebP, NPY), a mesh seen by a camera (glTF, GLB, OBJ, PLY), its vertex normals "
    "in object space (mesh.glb#vertices), or a point cloud (PLY).",
    example="normalbench quality --encoding octahedral,spheremap --storage rg8,rgb10a2 --normals sphere",
    step_s=0.008,
    options=QualityOptions,
    outputs=QualityOutputs,
    columns=COLUMNS,
    also=ALSO,
    usual=(
        {"encoding": ",".join(COMMON), "normals": SETS, "storage": "rgba8"},
        {"encoding": ",".join(TWO), "normals": SETS, "storage": "rg16f"},
        {"encoding": ",".join(WIDE), "normals": SETS, "storage": "rgb10a2,rg16,rgb8_12_12"},
        {"encoding": "xyz_largest,warped_cube", "normals": SETS, "storage": "rgb10a2"},
    ),
    usual_where_said={"encoding": {"normals": SETS_OF_NAMED}},
    single={"encoding": "octahedral", "backend": "jax"},
    files={"images": "images", "maps": "sphere", "live": "live"},
    section=Section(
        title="Normal accuracy",
        short="Normals",
        view=View.CODECS,
        intro="Every encoding in its storage, on a scene and on uniform directions: how far is the decoded normal "
        "from the original?",
        method="Each normal is encoded, stored as the render target stores it, decoded and compared with the "
        "original. JAX emulates the storage bit for bit; GLSL encodes in a fragment shader into the real "
        "target and decodes from it. Sums are in 64 bits; an angle is the atan2 of cross and dot product. "
        "Decodes are not renormalised for the PSNR.",
        extras=("angles", "sphere"),
    ),
)
