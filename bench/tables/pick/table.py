"""The pick table: which encoding to use, and its cost. It measures only what the answer needs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import (
    NAMED,
    Count,
    Effects,
    Encodings,
    Families,
    Images,
    Live,
    Option,
    Reading,
    Roundings,
    Scenes,
    Seed,
    StorageNames,
    Verbose,
)
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..mix.table import USES
from ..table import Column, Group, Role, Section, Table

KEY, HOW, RAW = Role.KEY, Role.HOW, Role.RAW
# One chunk of normals. More of them move the mean by less than a thousandth of itself.
COUNT = 2**18
# The decibels that a code must gain for twice the price: half a bit of each component.
WORTH_DB = 3.0
# Passes that decode: light, reflections, occlusion, and a denoiser or temporal antialiasing.
READERS = 4
# A code has a hole where its largest angle is more than so many times the least of those that qualify.
HOLE = 4.0
# A texel of an environment map of 1024 x 512, in degrees: it does not show what moves a reflection by less.
TEXEL_DEG = 360 / 1024


@dataclass(frozen=True, kw_only=True)
class PickOptions(Reading, SourceOptions):
    """Options for `pick`: the candidates and the constraints. Names are comma-separated."""

    storage: StorageNames = ("rg8", "rgb10a2")
    bytes: Annotated[
        Names | None,
        Option("--bytes", "Bytes per texel, comma-separated: all storages of that size, instead of --storage."),
    ] = None
    rounding: Roundings = ("nearest",)
    encoding: Encodings = ("all",)
    against: Annotated[
        Names | None,
        Option(
            "--against", f"Encodings or files of GLSL, HLSL or Slang to compare with the answer, {NAMED}.", files=True
        ),
    ] = None
    normals: Annotated[
        Names | None,
        Option("--normals", f"Normal sets or files, {NAMED}. Default: those of --domain.", files=True, in_run=True),
    ] = None
    scene: Scenes = ("studio", "room")
    power: Annotated[
        Names, Option("--power", "Specular powers to render the scenes with, comma-separated.", in_run=True)
    ] = ("47", "1024")
    effects: Effects = None
    family: Families = ("navi21",)
    aim: Annotated[
        str,
        Option(
            "--aim",
            "Quality to optimise: angle (the mean), worst (the largest angle), image (the lowest dB), or cost (cheap "
            "before accurate).",
        ),
    ] = "angle"
    readers: Annotated[
        int,
        Option(
            "--readers", "Number of decoding passes: light, reflections, occlusion, denoiser. Encoding counts once."
        ),
    ] = READERS
    worth: Annotated[float, Option("--worth", "Decibels that an encoding must gain for twice the cost.")] = WORTH_DB
    enough: Annotated[
        float,
        Option(
            "--enough", "Degrees by which a mirror's reflection may move. Default: a texel of a 1k environment map."
        ),
    ] = TEXEL_DEG
    accept_holes: Annotated[
        bool, Option("--accept-holes", f"Allow encodings whose largest angle is over {HOLE:g} times the smallest.")
    ] = False
    accept_lengths: Annotated[
        bool, Option("--accept-lengths", "Allow encodings whose decodes are not unit length.")
    ] = False
    look_ups: Annotated[
        bool, Option("--look-ups/--no-look-ups", "Allow encodings that read a lookup table, or exclude them.")
    ] = True
    most_instructions: Annotated[
        int | None, Option("--most-instructions", "Maximum number of issue slots for encoding and decoding once.")
    ] = None
    domain: Annotated[
        str | None,
        Option(
            "--domain",
            "Normals to represent and to measure on: sphere; tangent, terrain or map (z >= 0); view "
            "(facing the viewer). Default: your normals.",
        ),
    ] = None
    needs: Annotated[
        Names | None,
        Option("--needs", f"Operations that stored codes must survive: {', '.join(USES)}; comma-separated, or all."),
    ] = None
    survey: Annotated[
        bool,
        Option(
            "--survey",
            "Also measure what users of the report page may ask: each use of --needs, and other GPU families.",
        ),
    ] = False
    count: Count = COUNT
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class PickOutputs:
    """Outputs of `pick` other than its rows."""

    images: Images = None
    live: Live = None
    verbose: Verbose = False


COLUMNS = (
    Column("asked", "The requested storage, or the number of bytes.", KEY, shown=False),
    shared.STORAGE,
    replace(shared.ROUNDING_NOW_SAID, says="How the storage rounds; your own packed integers are stored unchanged."),
    shared.ENCODING,
    Column("normals", "The set of normals that was measured.", KEY),
    Column("scene", "The scenes that were rendered.", KEY),
    Column(
        "place",
        "best: the answer. tie: its image ties with the best. more accurate, most accurate, cheaper, fewer bits: the "
        "alternatives. inside a surface: better, but meets --needs only inside a surface. plain channels: the best "
        "without packing. against: named by --against. elsewhere: in a different storage of the same size, 6 dB "
        "better.",
        HOW,
    ),
    Column(
        "front",
        "Whether no other encoding is at least as good in error, cost and bits, and better in one of them.",
        HOW,
        shown=False,
    ),
    shared.BITS,
    Column("free_bits", "Free bits of the texel.", better="more", drops=2),
    Column("angle_mean_deg", "Mean angle between normal and decode.", unit="degrees", better="less"),
    Column(
        "angle_max_deg",
        "The largest sampled angle, among `count` normals. The largest error in the answer's sentences is "
        "angle_sup_deg if that is larger.",
        unit="degrees",
        better="less",
    ),
    Column(
        "angle_sup_deg",
        "The supremum: the largest angle in exact arithmetic. Only for encodings in the answer; with --aim worst for "
        "all that qualify.",
        unit="degrees",
        better="less",
    ),
    Column(
        "angle_axes_deg",
        "Largest error of axis-aligned normals, such as those of floors and walls. Only for encodings in the answer.",
        unit="degrees",
        better="less",
        drops=5,
    ),
    shared.ANGLE_COUNTS,
    Column("worst_normal", "The normal with the largest error: x, y and z.", Role.RAW, shown=False),
    Column(
        "image_db_*",
        "PSNR of the displayed image of that scene, at that specular power if its materials have one, against 32-bit "
        "normals, over covered pixels whose normals the encoding can represent: from the mean squared error over "
        "yaws of the encoding's axes about the vertical, at `image_pole`. Only for encodings in the answer; with "
        "--aim image for all that qualify, but with four yaws if far from the best.",
        unit="dB",
        better="more",
        drops=6,
    ),
    Column("image_conditions", "Size, exposure and display of each image.", HOW, shown=False),
    Column(
        "image_se_db",
        "Standard error of the lowest image PSNR, by leaving out one yaw at a time (jackknife).",
        HOW,
        "dB",
        shown=False,
    ),
    Column(
        "image_two_worst_db", "Lowest image PSNR, over only its two worst yaws.", unit="dB", better="more", shown=False
    ),
    Column(
        "image_pole",
        "The axis of the world (y up) that the encoding's z axis should point along, for the best images. Empty for "
        "an encoding in view space.",
        HOW,
        shown=False,
    ),
    Column("image_wrong_pole_db", "How much worse the image is with the worst axis.", HOW, "dB", shown=False),
    Column(
        "image_turned_db",
        "The lowest PSNR with random rotations instead of yaws, as for rotating objects.",
        unit="dB",
        better="more",
        shown=False,
    ),
    Column(
        "image_classes",
        "PSNR by image and class of surfaces: surfaces along the world's axes, and the others by roughness. JSON.",
        Role.RAW,
        shown=False,
    ),
    Column("image_errors", "The mean squared error by image, axis and yaw. JSON.", Role.RAW, shown=False),
    Column(
        "image_lost_percent",
        "The share of covered pixels whose normals the encoding cannot represent, in the scene with most of these "
        "pixels.",
        unit="%",
        better="less",
        shown=False,
    ),
    Column("image_lost_scene", "The scene of `image_lost_percent`.", HOW, shown=False),
    Column("image_view_angles", "The angle of visible normals to the line of sight, in words.", HOW, shown=False),
    Column(
        "slots",
        "The cost: executed issue slots to encode once and to decode for each of `readers`.",
        better="less",
    ),
    Column("slots_once", "Executed issue slots to encode and decode once.", better="less", shown=False),
    Column("encode_slots", "Issue slots to encode.", better="less", drops=4),
    Column("decode_slots", "Issue slots to decode.", better="less", drops=4),
    Column("instructions", "Instructions to encode and decode, as in the shader.", better="less", shown=False),
    Column("encode_instructions", "Instructions to encode.", better="less", shown=False),
    Column("decode_instructions", "Instructions to decode.", better="less", shown=False),
    Column("loops", "Backward jumps in the shaders that encode and decode.", better="less", drops=3),
    Column("table", "Whether the encoding reads a lookup table; the cost excludes the fetches.", HOW, drops=3),
    Column("invalid", "Decodes that were NaN or infinite; each counts as the opposite direction.", better="less"),
    Column(
        "length_share",
        "RMS error of the lengths of decodes divided by the RMS error of their directions in radians.",
        better="less",
        shown=False,
    ),
    Column("domain", "The normals that the encoding can represent: sphere, hemisphere (z >= 0) or view.", HOW, drops=1),
    Column("lost_percent", "The share of the normals outside `domain`.", unit="%", better="less", drops=5),
    Column("left_out", "Why the encoding does not qualify.", HOW),
    Column("hole", "The size of the encoding's hole in degrees, and the normal where it is.", HOW, shown=False),
    Column("effects", "Effects in the image.", HOW),
    Column("family", "The GPU families that slots were counted for.", HOW),
    Column("dearest_family", "The GPU family with the highest cost; the slots are for this family.", HOW),
    Column("recorded_by", "Compiler that counted the slots elsewhere, if this machine has no compilers.", HOW),
    Column("aim", "The quality to optimise.", HOW),
    Column("readers", "Number of decoding passes.", HOW),
    Column("worth", "Decibels that an encoding must gain for twice the cost.", HOW, "dB"),
    Column("enough", "Angle by which a mirror's reflection may move.", HOW, "degrees", shown=False),
    Column("accept_holes", "Whether encodings with a hole may be recommended.", HOW, shown=False),
    Column(
        "accept_lengths",
        "Whether encodings that decode to normals of other than unit length may be recommended.",
        HOW,
        shown=False,
    ),
    Column("look_ups", "Whether encodings that read a lookup table may be recommended.", HOW, shown=False),
    Column("most_instructions", "The maximum number of issue slots to encode and decode once.", HOW),
    Column("needs", "The requested domain.", HOW),
    Column("mixing", "Operations that stored codes must survive, as in --needs.", HOW),
    Column("cannot_mix", "Why codes do not survive the required mixing inside a surface, according to `mix`.", HOW),
    Column(
        "mixed_mean_deg",
        "Mean error after the required mixing inside a surface, over neighbours 1 and 5 degrees apart or an image's "
        "own. It decides if it is larger than the mean angle.",
        HOW,
        "degrees",
        shown=False,
    ),
    Column("mixed_max_deg", "Largest error after the required mixing inside a surface.", HOW, "degrees", shown=False),
    Column("mixed_across", "The result of the required mixing across an edge, if it is unusable.", HOW),
    Column("by_use", "The verdict on each kind of mixing, for the constraints on the page.", RAW, shown=False),
    Column("by_family", "The issue slots on other GPU families, for the constraints on the page.", RAW, shown=False),
    Column("against", "Whether the encoding was named by --against.", HOW, shown=False),
    Column("beside", "Whether the row is for a different storage of the same size.", HOW, shown=False),
    Column("packed", "Whether the encoding is packed into the requested texel.", HOW, shown=False),
    Column(
        "code_bits",
        "Base-2 logarithm of the number of codes, if no storage gives more.",
        HOW,
        shown=False,
    ),
    Column("bytes", "Bytes of the requested texel.", HOW, shown=False),
    Column("count", "How many normals were measured.", HOW),
    shared.CODE_SPACE,
    shared.DEVICE,
    shared.SEED,
    shared.SKIPPED,
)

ALSO = (
    Column(
        "largest_deg",
        "The supremum, or the largest sampled angle if that is larger.",
        unit="degrees",
        better="less",
    ),
)

TABLE = Table(
    package=__package__ or "",
    group=Group.ANSWER,
    help="Choose an encoding for each storage, with alternatives and cost.\n\nEncodings that do not meet the "
    "constraints are left out, with the reason. Otherwise an encoding may cost twice as much if it is --worth "
    "decibels better. The exit status is 1 if no encoding meets the constraints.",
    example="normalbench pick --storage rg8 --most-instructions 40 --scene room --power 256",
    is_kept=True,
    step_s=0.4,
    options=PickOptions,
    outputs=PickOutputs,
    columns=COLUMNS,
    also=ALSO,
    partial=True,
    single={"encoding": "octahedral", "storage": "rg8"},
    files={"images": "images", "live": "live"},
    usual=({"survey": True},),
    section=Section(
        title="Recommended encodings",
        short="Answer",
        view=View.CHOOSE,
        intro="The best encoding for each storage, its cost, and the alternatives.",
        method="Encodings that do not meet the constraints are left out. If the error of an encoding is not visible, "
        "it is accurate enough: among such encodings of low cost the cheapest is chosen. Otherwise an encoding may "
        "cost twice as much if it is 3 dB better, which is half a bit per component. The cost is in executed "
        "issue slots, to encode once and to decode for four passes; 80 of the slots are hidden by the target's "
        "memory traffic. Angles are over the named normals, and the largest is a supremum found in float64. "
        "Images are 640 x 480 frames of deferred shading, with everything else in 32-bit floats, lit by the "
        "decoded normals. Some thousand pixels of each image are compared, in 16 or more yaws of the "
        "encoding's axes, because the result of a single orientation depends on chance; images with effects are "
        "drawn whole, in four yaws. Slots are counted in the output of the vendors' compilers, without the "
        "conversion by the render target.",
        leads=True,
    ),
)
