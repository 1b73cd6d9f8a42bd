"""The pick table: which code to take, at what price. Measures what an answer needs, and says the answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...options.option import (
    Count,
    Effects,
    Encodings,
    Images,
    Names,
    Normals,
    Option,
    Reading,
    Scenes,
    Seed,
    StorageNames,
)
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW, RAW = Role.KEY, Role.HOW, Role.RAW
# One chunk of normals. More of them move the mean by less than a thousandth of itself.
COUNT = 2**18


@dataclass(frozen=True, kw_only=True)
class PickOptions(Reading):
    """What `pick` chooses from, and what it asks of the code. Names are comma-separated."""

    storage: StorageNames = "rg8,rgb10a2"
    encoding: Encodings = "all"
    against: Annotated[
        str | None,
        Option(
            "--against", f"Encodings or files of GLSL, HLSL or Slang to compare with the answer, {Names}.", files=True
        ),
    ] = None
    normals: Normals = "sphere"
    scene: Scenes = "gloss"
    power: Annotated[
        str, Option("--power", "Specular powers that the scene is rendered with, comma-separated.", in_run=True)
    ] = "47,1024"
    effects: Effects = None
    family: Annotated[str, Option("--family", "The GPU family that instructions are counted for.")] = "navi21"
    aim: Annotated[
        str,
        Option("--aim", "What decides: angle (the mean), worst (the largest angle), image (the lowest dB) or cost."),
    ] = "angle"
    most_instructions: Annotated[
        int | None, Option("--most-instructions", "The most instructions, encode and decode together.")
    ] = None
    domain: Annotated[
        str | None,
        Option(
            "--domain",
            "What the code must hold: sphere, hemisphere (z >= 0), view (facing the viewer). Default: your normals.",
        ),
    ] = None
    needs: Annotated[
        str | None,
        Option("--needs", "What stored codes must survive: filter, blend, resolve; comma-separated, or all."),
    ] = None
    count: Count = COUNT
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class PickOutputs:
    """What `pick` writes beside its rows."""

    images: Images = None


COLUMNS = (
    shared.STORAGE,
    shared.ENCODING,
    Column("normals", "The set of normals that was measured on.", KEY),
    Column("scene", "The scene that was rendered.", KEY),
    Column(
        "place",
        "best: by the aim. runner-up: next by the aim. cheaper: the best with at most half the instructions of the "
        "best. picture: the best image of those rendered. against: named by --against.",
        HOW,
    ),
    Column("front", "Whether no other code is as good in every figure and better in one.", HOW, shown=False),
    shared.BITS,
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
        "The supremum: the largest angle of exact arithmetic. Of the best; with --aim worst of all that qualify.",
        unit="degrees",
        better="less",
    ),
    Column(
        "image_db_*",
        "PSNR of the displayed image at that specular power, against 32-bit normals. Of codes that no other beats in "
        "both angles by more than 5 % at no higher cost; with --aim image of all that qualify.",
        unit="dB",
        better="more",
    ),
    Column("instructions", "Instructions to encode and to decode, in a fragment shader of `family`.", better="less"),
    Column("encode_instructions", "Instructions to encode.", better="less", drops=4),
    Column("decode_instructions", "Instructions to decode.", better="less", drops=4),
    Column("loops", "Jumps back in those shaders. A loop's body counts once.", better="less", drops=3),
    Column("invalid", "Decodes that were NaN or infinite; each counts as the opposite direction.", better="less"),
    Column("domain", "The normals that the encoding is made for: sphere, hemisphere (z >= 0) or view.", HOW, drops=1),
    Column("lost_percent", "The share of the normals that lie outside that domain.", unit="%", better="less", drops=5),
    Column("left_out", "Why the code does not qualify.", HOW),
    Column("effects", "Effects in the image.", HOW),
    Column("family", "The GPU family that instructions were counted for.", HOW),
    Column("aim", "What decides.", HOW),
    Column("most_instructions", "The most instructions that were allowed.", HOW),
    Column("needs", "The domain that was asked for.", HOW),
    Column("mixing", "What stored codes must survive, as --needs says it.", HOW),
    Column("cannot_mix", "Why the code does not survive that: the verdict of `mix`.", HOW),
    Column("against", "Whether the code was named by --against.", HOW, shown=False),
    Column("count", "How many normals were measured.", HOW),
    shared.DEVICE,
    shared.SEED,
    shared.SKIPPED,
)

TABLE = Table(
    name="pick",
    package=__package__ or "",
    help="Which code to take for each storage, at what price, and what to take instead.\n\n"
    "Codes that do not meet the constraints are left out, with the reason. Of the others the aim decides. The exit "
    "status is 1 where no code meets them.",
    example="normalbench pick --storage rg8 --most-instructions 40 --scene gloss --power 256",
    options=PickOptions,
    outputs=PickOutputs,
    columns=COLUMNS,
    partial=True,
    single={"encoding": "octahedral", "storage": "rg8"},
    files={"images": "images"},
    section=Section(
        title="Which code should I take?",
        short="Answer",
        intro="The best code for each storage, what it costs, and what to take instead.",
        method="Codes that do not meet the constraints are left out. The aim decides among the others; where two are "
        "equal the one with fewer instructions is taken. `cheaper` is the best of those with at most half the "
        "instructions. Angles are over the named normals, the largest is a supremum found in float64. Images are one "
        "frame of 320 x 240 of the hybrid pipeline, all else in 32-bit floats, lit by the normals that the emulated "
        "code gives back; `render` writes codes in shaders, and agrees to 0.02 dB. Instructions are counted in "
        "fragment shaders as Mesa compiles them, without the conversion that the render target does.",
        leads=True,
    ),
)
