"""The pick table: which encoding to use, and its cost. Measures what an answer needs, and writes the answer."""

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
    """Options of `pick`: the candidates and the constraints. Names are comma-separated."""

    storage: StorageNames = ("rg8", "rgb10a2")
    bytes: Annotated[
        Names | None,
        Option("--bytes", "Bytes of a texel, comma-separated: all storages of that size, not --storage."),
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
        Names, Option("--power", "Specular powers that the scenes are rendered with, comma-separated.", in_run=True)
    ] = ("47", "1024")
    effects: Effects = None
    family: Families = ("navi21",)
    aim: Annotated[
        str,
        Option(
            "--aim",
            "What a code must be good at: angle (the mean), worst (the largest angle), image (the lowest dB), or cost "
            "(cheap before exact).",
        ),
    ] = "angle"
    readers: Annotated[
        int, Option("--readers", "Passes that decode: light, reflections, occlusion, denoiser. Encoding counts once.")
    ] = READERS
    worth: Annotated[float, Option("--worth", "The decibels that a code must gain for twice the price.")] = WORTH_DB
    enough: Annotated[
        float,
        Option("--enough", "Degrees that a mirror's reflection may move. Default: a texel of a 1k environment map."),
    ] = TEXEL_DEG
    accept_holes: Annotated[
        bool, Option("--accept-holes", f"Take codes whose largest angle is over {HOLE:g} times the least.")
    ] = False
    accept_lengths: Annotated[bool, Option("--accept-lengths", "Take codes whose decodes are not of length 1.")] = False
    look_ups: Annotated[
        bool, Option("--look-ups/--no-look-ups", "Take codes that read a look-up table, or leave them out.")
    ] = True
    most_instructions: Annotated[
        int | None, Option("--most-instructions", "The most issue slots that encoding and decoding once may execute.")
    ] = None
    domain: Annotated[
        str | None,
        Option(
            "--domain",
            "What the code must hold and is measured on: sphere; tangent, terrain or map (z >= 0); view (facing the "
            "viewer). Default: your normals.",
        ),
    ] = None
    needs: Annotated[
        Names | None,
        Option("--needs", f"What stored codes must survive: {', '.join(USES)}; comma-separated, or all."),
    ] = None
    survey: Annotated[
        bool,
        Option(
            "--survey", "Measure too what a reader of the page may ask: each use of --needs, and other GPU families."
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
    Column("asked", "The storage that was asked for, or the number of bytes.", KEY, shown=False),
    shared.STORAGE,
    replace(
        shared.ROUNDING_NOW_SAID, says="How the storage rounds; an integer of a user's is as its encoder makes it."
    ),
    shared.ENCODING,
    Column("normals", "The set of normals that was measured on.", KEY),
    Column("scene", "The scenes that were rendered.", KEY),
    Column(
        "place",
        "best: the answer. tie: its image ties with the best. more accurate, most accurate, cheaper, fewer bits: the "
        "alternatives. inside a surface: better, but survives --needs only there. plain channels: the first that is "
        "not packed. against: named by --against. elsewhere: in another storage of the same bytes, 6 dB better.",
        HOW,
    ),
    Column(
        "front",
        "Whether no other encoding is at least as good in error, cost and bits and better in one.",
        HOW,
        shown=False,
    ),
    shared.BITS,
    Column("free_bits", "Bits of the texel that are free.", better="more", drops=2),
    Column("angle_mean_deg", "Mean angle between normal and decode.", unit="degrees", better="less"),
    Column(
        "angle_max_deg",
        "The largest angle among the `count` normals that were measured. The largest error in the answer's sentences "
        "is angle_sup_deg where that is larger.",
        unit="degrees",
        better="less",
    ),
    Column(
        "angle_sup_deg",
        "The supremum: the largest angle of exact arithmetic. Of codes with a place; with --aim worst of all that "
        "qualify.",
        unit="degrees",
        better="less",
    ),
    Column(
        "angle_axes_deg",
        "Largest angle of axis-aligned normals: floors and walls. Of codes with a place.",
        unit="degrees",
        better="less",
        drops=5,
    ),
    shared.ANGLE_COUNTS,
    Column("worst_normal", "The normal that came back farthest off: x, y and z.", Role.RAW, shown=False),
    Column(
        "image_db_*",
        "PSNR of the displayed image of that scene, at that specular power if its materials have one, against 32-bit "
        "normals, over covered pixels whose normals the encoding is made for: the mean squared error over yaws of the "
        "encoding's axes about the vertical, at `image_pole`. Of codes with a place; with --aim image of all that "
        "qualify, those far from the best by four yaws.",
        unit="dB",
        better="more",
        drops=6,
    ),
    Column("image_conditions", "Size, exposure and display of each image.", HOW, shown=False),
    Column(
        "image_se_db",
        "The standard error of the lowest of these, by leaving out one yaw after the other (jackknife).",
        HOW,
        "dB",
        shown=False,
    ),
    Column("image_two_worst_db", "That image by its two worst yaws alone.", unit="dB", better="more", shown=False),
    Column(
        "image_pole",
        "The axis of the world, y up, that the encoding's z axis should lie along: images are best so. Empty for an "
        "encoding in view space.",
        HOW,
        shown=False,
    ),
    Column("image_wrong_pole_db", "How much worse the image is at the worst axis.", HOW, "dB", shown=False),
    Column(
        "image_turned_db",
        "The lowest PSNR by random rotations in place of yaws, as objects have them that turn.",
        unit="dB",
        better="more",
        shown=False,
    ),
    Column(
        "image_classes",
        "PSNR by image and class of surfaces: those along the world's axes, the others by roughness. JSON.",
        Role.RAW,
        shown=False,
    ),
    Column("image_errors", "The mean squared error by image, axis and yaw. JSON.", Role.RAW, shown=False),
    Column(
        "image_lost_percent",
        "The share of covered pixels, in the scene with most of them, whose normals the encoding is not made for.",
        unit="%",
        better="less",
        shown=False,
    ),
    Column("image_lost_scene", "That scene.", HOW, shown=False),
    Column("image_view_angles", "How far visible normals lie from the line of sight, in words.", HOW, shown=False),
    Column(
        "slots",
        "The price: issue slots to encode once and to decode for each of `readers`, as they are executed.",
        better="less",
    ),
    Column("slots_once", "Issue slots to encode and decode once, as they are executed.", better="less", shown=False),
    Column("encode_slots", "Issue slots to encode.", better="less", drops=4),
    Column("decode_slots", "Issue slots to decode.", better="less", drops=4),
    Column(
        "instructions", "Instructions to encode and to decode, as they stand in the shader.", better="less", shown=False
    ),
    Column("encode_instructions", "Instructions to encode.", better="less", shown=False),
    Column("decode_instructions", "Instructions to decode.", better="less", shown=False),
    Column("loops", "Jumps back in those shaders.", better="less", drops=3),
    Column("table", "Whether it reads a look-up table; a fetch is not in the price.", HOW, drops=3),
    Column("invalid", "Decodes that were NaN or infinite; each counts as the opposite direction.", better="less"),
    Column(
        "length_share",
        "The root mean squared error of the lengths of decodes over that of the directions, in radians.",
        better="less",
        shown=False,
    ),
    Column("domain", "The normals that the encoding is made for: sphere, hemisphere (z >= 0) or view.", HOW, drops=1),
    Column("lost_percent", "The share of the normals that lie outside that domain.", unit="%", better="less", drops=5),
    Column("left_out", "Why the code does not qualify.", HOW),
    Column("hole", "How large its hole is, in degrees, and at which normal.", HOW, shown=False),
    Column("effects", "Effects in the image.", HOW),
    Column("family", "The GPU families that slots were counted for.", HOW),
    Column("dearest_family", "The one where the code is dearest, which the slots are of.", HOW),
    Column("recorded_by", "What counted the slots on another machine, where this one has no compilers.", HOW),
    Column("aim", "What decides.", HOW),
    Column("readers", "The passes that decode.", HOW),
    Column("worth", "The decibels that a code must gain for twice the price.", HOW, "dB"),
    Column("enough", "What a mirror's reflection may move by.", HOW, "degrees", shown=False),
    Column("accept_holes", "Whether codes with a hole may be the answer.", HOW, shown=False),
    Column("accept_lengths", "Whether codes whose decodes are not of length 1 may be the answer.", HOW, shown=False),
    Column("look_ups", "Whether codes that read a look-up table may be the answer.", HOW, shown=False),
    Column("most_instructions", "The most issue slots that were allowed, encode and decode once.", HOW),
    Column("needs", "The domain that was asked for.", HOW),
    Column("mixing", "What stored codes must survive, as --needs says it.", HOW),
    Column("cannot_mix", "Why the code does not survive that inside a surface: the verdict of `mix`.", HOW),
    Column(
        "mixed_mean_deg",
        "Mean error after that mixing inside a surface, over neighbours 1 and 5 degrees apart or an image's own. If it "
        "is larger than the mean angle, it decides.",
        HOW,
        "degrees",
        shown=False,
    ),
    Column("mixed_max_deg", "Largest error after that mixing inside a surface.", HOW, "degrees", shown=False),
    Column("mixed_across", "What it does to the code across an edge, where that is garbage.", HOW),
    Column("by_use", "What each use of mixing does to the code, for the page's constraints.", RAW, shown=False),
    Column("by_family", "Its issue slots on other GPU families, for the page's constraints.", RAW, shown=False),
    Column("against", "Whether the code was named by --against.", HOW, shown=False),
    Column("beside", "Whether it is of another storage of the same bytes.", HOW, shown=False),
    Column("packed", "Whether it is packed into the texel that was asked for.", HOW, shown=False),
    Column(
        "code_bits",
        "The logarithm to base 2 of how many codes it has, where no storage gives it more.",
        HOW,
        shown=False,
    ),
    Column("bytes", "Bytes of the texel that was asked for.", HOW, shown=False),
    Column("count", "How many normals were measured.", HOW),
    shared.CODE_SPACE,
    shared.DEVICE,
    shared.SEED,
    shared.SKIPPED,
)

ALSO = (
    Column(
        "largest_deg",
        "The supremum, or the largest angle that was met if that is larger.",
        unit="degrees",
        better="less",
    ),
)

TABLE = Table(
    package=__package__ or "",
    group=Group.ANSWER,
    help="Choose an encoding for each storage, with alternatives and cost.\n\nCodes that do not meet the "
    "constraints are left out, with the reason. Of the others a code may cost twice as much if it is --worth "
    "decibels better. The exit status is 1 where no code meets the constraints.",
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
        title="Which code should I take?",
        short="Answer",
        view=View.CHOOSE,
        intro="The best code for each storage, what it costs, and what to take instead.",
        method="Codes that do not meet the constraints are left out. A code whose error nobody sees is enough: of "
        "those that cost little the cheapest is taken. Of others a code may cost twice as much if it is 3 dB better, "
        "half a bit of each component. The price is in issue slots as they are executed, to encode once and to decode "
        "for four readers; 80 of these take no longer than the target's memory traffic. Angles are over the named "
        "normals, the largest is a supremum found in float64. Images are frames of 640 x 480 by deferred shading, "
        "all else in 32-bit floats, lit by the normals that the emulated code gives back. Some thousand pixels of each "
        "are compared, in 16 yaws or more of the encoding's axes, as one orientation is a matter of luck; effects are "
        "drawn whole, in four. Slots are counted in shaders as the vendors' "
        "compilers make them, without the conversion that the render target does.",
        leads=True,
    ),
)
