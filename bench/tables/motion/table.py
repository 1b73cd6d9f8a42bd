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
            "view, world: the space that normals are encoded in; comma-separated, or all. With several spaces, an "
            "encoding is measured in the spaces that it supports.",
        ),
    ] = ("view", "world")
    moves: Annotated[Names, Option("--moves", "camera, object: what turns; comma-separated, or all.", in_run=True)] = (
        "camera",
    )
    axis: Annotated[Names, Option("--axis", "yaw, pitch, roll; comma-separated, or all.", in_run=True)] = ("yaw",)
    turn: Annotated[Names, Option("--turn", "Degrees per frame, comma-separated.", in_run=True)] = (
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
            "Values of --turn to render frames for as well; none: no frames. Default: the value nearest to 0.25.",
        ),
    ] = None
    frames: Annotated[int, Option("--frames", "Number of frames in a sequence.")] = 32
    count: Annotated[
        int,
        Option(
            "--count",
            "Number of normals whose codes are followed. Rendering frames takes longer; --picture-turn none skips it.",
        ),
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
    Column("moves", "Whether the camera turns, or the surface in front of a still camera.", KEY, drops=6),
    Column("axis", "The axis of the turn: yaw is about the camera's up, pitch its right, roll its line of sight.", KEY),
    Column("turn_deg", "Angle of the turn from one frame to the next.", KEY, "degrees"),
    Column("bits", shared.BITS.says, drops=9),
    Column("static_rms_deg", "RMS angle between normal and decode, over all frames.", unit="degrees", better="less"),
    Column(
        "wobble_deg",
        "RMS change of the error from one frame to the next; the error is the decoded minus the true normal on the "
        "surface. 0: the error does not change.",
        unit="degrees",
        better="less",
    ),
    Column(
        "ratio",
        "wobble_deg divided by sqrt(2) static_rms_deg. 1: the errors of successive frames are unrelated, like noise; "
        "near 0: the error changes slowly.",
        better="less",
    ),
    Column("jumps_percent", "Normals whose code changes from one frame to the next.", unit="%", better="less"),
    Column("jump_deg", "Mean change of the error when the code changes.", unit="degrees", better="less", drops=8),
    Column(
        "highlight_px",
        "RMS change of a highlight's centroid from one frame to the next, on the surface: the image turns with the "
        "camera. Three lights on nine spheres of specular power 4 to 1024.",
        unit="pixels",
        better="less",
    ),
    Column(
        "peak_percent",
        "RMS change of a highlight's brightest pixel from one frame to the next, relative to the pixel with exact "
        "normals.",
        unit="%",
        better="less",
    ),
    Column("highlight_px_*", "highlight_px at that specular power.", unit="pixels", better="less", drops=11),
    Column("peak_percent_*", "peak_percent at that specular power.", unit="%", better="less", drops=10),
    Column(
        "static_psnr_db",
        "PSNR of the displayed image of scene gloss against the image with exact normals; covered pixels of all "
        "frames, peak 1.",
        unit="dB",
        better="more",
        drops=7,
    ),
    Column(
        "wobble_psnr_db",
        "PSNR of the change of the two images' difference from one frame to the next, pixel by pixel while surfaces "
        "move across the pixels. 3 dB below static_psnr_db if the errors of two frames are unrelated.",
        unit="dB",
        better="more",
    ),
    Column(
        "reprojected_psnr_db",
        "`wobble_psnr_db` for an image that turns with the camera, with every surface at its pixel, as after exact "
        "reprojection: the remaining change is due to the encoding. Infinite if codes do not change.",
        unit="dB",
        better="more",
    ),
    Column(
        "panel_psnr_db",
        "PSNR of the displayed image of a metal panel of roughness 0.1 whose normal turns by 4 degrees across the "
        "image, under thin strips, against the image with exact normals; all frames of a camera that goes around it, "
        "peak 1.",
        unit="dB",
        better="more",
    ),
    Column(
        "crawl_psnr_db",
        "`wobble_psnr_db` for the image of the panel. It is low if steps crawl over the panel.",
        unit="dB",
        better="more",
    ),
    Column("invalid", "Decodes that were NaN or infinite; each counts as the opposite direction.", shown=False),
    Column("frames", "Number of frames in a sequence.", HOW, drops=13),
    Column(
        "count",
        "Number of normals whose codes were followed; if no frame changes a code, more normals in two frames.",
        HOW,
        drops=14,
    ),
    Column("size", "Width and height of rendered frames in pixels.", HOW, drops=12),
    Column("lights", "Number of point lights in the displayed image.", HOW, drops=15),
    Column(
        "backend", "jax emulates the storage; glsl is used if the encoding has no Python implementation.", HOW, drops=3
    ),
    Column("device", "The device of the measurement; the renderer's device if frames were rendered.", HOW, drops=1),
    Column("seed", "The random seed of the normals and of the scene's lights.", HOW, drops=4),
    shared.EXACT,
    shared.SKIPPED,
)
ALSO = (
    Column("worst_turn_deg", "The measured turn with the largest wobble; empty if nothing wobbles.", unit="degrees"),
    Column("worst_wobble_deg", "wobble_deg at that turn.", unit="degrees", better="less"),
)

TABLE = Table(
    package=__package__ or "",
    help="Measure how errors change while the camera or an object turns.\n\nIn view space a normal's code changes in "
    "each frame of a turning camera, so highlights wobble; in world space it stays the same. Normals, "
    "highlights and the displayed image are measured.",
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
        title="Temporal stability",
        short="Motion",
        view=View.CODECS,
        intro="In view space codes change while the camera turns, and highlights wobble. How much, and how much less "
        "in world space?",
        method="Normals fixed on surfaces are encoded in each frame of a turn, stored and decoded; the error is "
        "followed on the surface. Highlights and images are rendered with these decodes instead of exact "
        "normals. Highlights are taken from an image that turns with the camera, so that only the encoding "
        "changes them. The displayed image is from a turning camera, so the pixel grid also has an effect.",
    ),
)
