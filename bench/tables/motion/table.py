"""The motion table: how much a code's error changes from frame to frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import Encodings, Images, Lights, Option, Plot, Roundings, Seed, Size, StorageNames
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW
# The article's three ways: view space with either code, and world space.
USUAL = ("octahedral", "spheremap", "per_pixel_view")


@dataclass(frozen=True, kw_only=True)
class MotionOptions(SourceOptions):
    """Options for what `motion` measures. Names and numbers are comma-separated."""

    encoding: Encodings = USUAL
    storage: StorageNames = ("rg8",)
    rounding: Roundings = ("nearest",)
    space: Annotated[
        Names,
        Option(
            "--space",
            "view, world: the space that normals are encoded in; comma-separated, or all. Of several spaces a code "
            "is measured in those that it is made for.",
        ),
    ] = ("view", "world")
    moves: Annotated[Names, Option("--moves", "camera, object: what turns; comma-separated, or all.", in_run=True)] = (
        "camera",
    )
    axis: Annotated[Names, Option("--axis", "yaw, pitch, roll; comma-separated, or all.", in_run=True)] = ("yaw",)
    turn: Annotated[Names, Option("--turn", "Degrees a frame, comma-separated.", in_run=True)] = (
        "0.01",
        "0.05",
        "0.25",
        "0.5",
        "1",
    )
    picture_turn: Annotated[
        Names | None,
        Option(
            "--picture-turn",
            "Those of --turn that frames are rendered of as well; none: no frames. Default: the one nearest to 0.25.",
        ),
    ] = None
    frames: Annotated[int, Option("--frames", "Frames of a sequence.")] = 32
    count: Annotated[
        int,
        Option("--count", "Normals whose codes are followed. Frames take longer; --picture-turn none leaves them out."),
    ] = 2**16
    size: Size = "320x240"
    lights: Lights = 16
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class MotionOutputs:
    """Files that `motion` writes besides its rows."""

    plot: Plot = None
    images: Images = None


COLUMNS = (
    shared.ENCODING,
    shared.STORAGE,
    Column("rounding", "How the storage rounds.", KEY, drops=5),
    Column("space", "The space that normals are encoded in: view or world.", KEY),
    Column("moves", "What turns: the camera, or the surface under a still camera.", KEY, drops=6),
    Column("axis", "What it turns about: yaw is about the camera's up, pitch its right, roll its line of sight.", KEY),
    Column("turn_deg", "How far it turns from one frame to the next.", KEY, "degrees"),
    Column("bits", shared.BITS.says, drops=9),
    Column("static_rms_deg", "RMS angle between normal and decode, over all frames.", unit="degrees", better="less"),
    Column(
        "wobble_deg",
        "RMS change of the error from one frame to the next, where the error is decoded less true normal on the "
        "surface. 0: the error stays where it is.",
        unit="degrees",
        better="less",
    ),
    Column(
        "ratio",
        "wobble_deg over sqrt(2) static_rms_deg. 1: the error of each frame has nothing to do with that of the frame "
        "before, as noise; near 0: it creeps.",
        better="less",
    ),
    Column("jumps_percent", "Normals whose code changes from one frame to the next.", unit="%", better="less"),
    Column("jump_deg", "Mean change of the error where the code changes.", unit="degrees", better="less", drops=8),
    Column(
        "highlight_px",
        "RMS change of a highlight's centroid from one frame to the next, on the surface: the picture turns with the "
        "camera. Three lights on nine spheres of specular power 4 to 1024.",
        unit="pixels",
        better="less",
    ),
    Column(
        "peak_percent",
        "RMS change of a highlight's brightest pixel from one frame to the next, over that of exact normals.",
        unit="%",
        better="less",
    ),
    Column("highlight_px_*", "highlight_px of that specular power.", unit="pixels", better="less", drops=11),
    Column("peak_percent_*", "peak_percent of that specular power.", unit="%", better="less", drops=10),
    Column(
        "static_psnr_db",
        "The displayed image of scene gloss against that of exact normals; covered pixels of all frames, peak 1.",
        unit="dB",
        better="more",
        drops=7,
    ),
    Column(
        "wobble_psnr_db",
        "The same of the change of their difference from one frame to the next, pixel by pixel while surfaces move "
        "across them. 3 dB below static_psnr_db where the errors of two frames have nothing to do with each other.",
        unit="dB",
        better="more",
    ),
    Column(
        "reprojected_psnr_db",
        "The same of a picture that turns with the camera, every surface at its pixel, as frames are after exact "
        "reprojection: what is left is the code's doing. Infinite where codes stay.",
        unit="dB",
        better="more",
    ),
    Column(
        "panel_psnr_db",
        "The displayed image of a panel whose normal turns by 4 degrees across the picture, of a metal of roughness "
        "0.1, under thin strips, against that of exact normals; all frames of a camera that goes around it, peak 1.",
        unit="dB",
        better="more",
    ),
    Column(
        "crawl_psnr_db",
        "The same of the change of their difference from one frame to the next: steps that crawl.",
        unit="dB",
        better="more",
    ),
    Column("invalid", "Decodes that were NaN or infinite; each counts as the opposite direction.", shown=False),
    Column("frames", "Frames of a sequence.", HOW, drops=13),
    Column(
        "count",
        "Normals whose codes were followed; where no frame changes a code, more, in two frames.",
        HOW,
        drops=14,
    ),
    Column("size", "Width and height in pixels of rendered frames.", HOW, drops=12),
    Column("lights", "Point lights of the displayed image.", HOW, drops=15),
    Column("backend", "jax emulates the storage; glsl, where the encoding has no Python half.", HOW, drops=3),
    Column("device", "What it was measured on; the renderer's where frames were rendered.", HOW, drops=1),
    Column("seed", "The random seed of the normals and of the scene's lights.", HOW, drops=4),
    shared.EXACT,
    shared.SKIPPED,
)
ALSO = (
    Column("worst_turn_deg", "Of the turns measured, the one with the largest wobble; empty for none.", unit="degrees"),
    Column("worst_wobble_deg", "wobble_deg of that turn.", unit="degrees", better="less"),
)

TABLE = Table(
    package=__package__ or "",
    help="Measure how errors change while the camera or an object turns.\n\nA code in view space is another one in "
    "each frame of a turning camera, so highlights wobble; a code in world space stays. Measured of the "
    "normals, of highlights and of the displayed image.",
    example="normalbench motion --encoding octahedral,spheremap --storage rg8,rgb10a2 --axis yaw,roll",
    step_s=0.5,
    options=MotionOptions,
    outputs=MotionOutputs,
    columns=COLUMNS,
    also=ALSO,
    usual=({"frames": 16, "count": 2**15},),
    single={"encoding": "octahedral", "space": "view", "turn": "0.25", "picture_turn": "none"},
    files={"images": "motion"},
    section=Section(
        title="What wobbles when the camera turns",
        short="Motion",
        view=View.CODECS,
        intro="A code in view space changes while the camera turns, and highlights wobble. How much, and how much "
        "less in world space?",
        method="Normals that are fixed on surfaces are encoded in each frame of a turn, stored and decoded; the error "
        "is followed on the surface. Highlights and images are rendered with these decodes in place of exact normals. "
        "Highlights are those of a picture that turns with the camera, so that what changes is the code's doing; "
        "the image is that of a camera that turns, where the raster of pixels has a share.",
    ),
)
