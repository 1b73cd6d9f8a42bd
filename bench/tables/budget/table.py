"""The table of budgets: the fewest bytes per pixel for an image quality, and the layout that achieves it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import Families, Option, Options, Plot, Size, Verbose
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Group, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW
# The kinds of rows.
PROPOSAL, ENGINE, MINE, IMPROVED = "proposal", "engine", "mine", "improved"


@dataclass(frozen=True, kw_only=True)
class BudgetOptions(Options):
    """Options for what `budget` measures. Names and numbers are comma-separated."""

    bytes: Annotated[Names, Option("--bytes", "Bytes per pixel without native depth, comma-separated.")] = (
        "12",
        "16",
        "20",
    )
    scene: Annotated[
        Names,
        Option(
            "--scene",
            "Metallic-roughness scenes to judge by: ramps, studio, glTF files and captured frames (gbuffer.json); "
            "comma-separated.",
            files=True,
            in_run=True,
        ),
    ] = ("ramps", "studio")
    environment: Annotated[
        str | None,
        Option(
            "--environment",
            "Environment that scenes reflect: studio, sky, strips, lamp, or an .hdr or .exr file.",
            files=True,
        ),
    ] = None
    hold: Annotated[
        Names,
        Option(
            "--hold",
            "Attributes to store: normal, base_color, roughness, metallic, f0, ao, tangent; motion in a target of "
            "its own, or motion:packed; shading_model:BITS, flags:BITS, either in the stencil as flags:stencil; "
            "shadow:BITS, custom:BITS, other:BITS; emissive, or emissive:light if the light buffer holds it.",
        ),
    ] = (
        "normal",
        "base_color",
        "roughness",
        "metallic",
        "f0",
        "ao",
        "shading_model:4",
        "flags:4",
        "motion",
        "emissive:light",
    )
    speed: Annotated[
        float,
        Option(
            "--speed",
            "Fastest motion that is stored to within 1/16 pixel, in pixels per frame at 1920 x 1080, 0 to 500.",
        ),
    ] = 64.0
    targets: Annotated[int, Option("--targets", "Maximum number of render targets.")] = 6
    formats: Annotated[Names, Option("--formats", "Formats of render targets to use, comma-separated, or all.")] = (
        "all",
    )
    fields: Annotated[
        bool, Option("--fields/--no-fields", "Allow several numbers to share a channel as bit fields.")
    ] = True
    integers: Annotated[bool, Option("--integers/--no-integers", "Allow integer targets.")] = True
    limit: Annotated[
        Names | None,
        Option(
            "--limit",
            "Limits of a device. webgpu: its 32 bytes per sample and its formats; tile:16, tile:32, tile:64: bytes "
            "per pixel of a GPU's tiles.",
        ),
    ] = None
    light: Annotated[
        str, Option("--light", "Format of the light buffer; it is drawn with the G-buffer and counts for --limit.")
    ] = "r11g11b10f"
    threshold: Annotated[
        float | None,
        Option("--threshold", "Find the fewest bytes with FLIP (99th percentile) of at most this, instead of --bytes."),
    ] = None
    blend: Annotated[
        Names | None, Option("--blend", "Attributes that decals blend into, such as base_color,roughness,normal.")
    ] = None
    read_alone: Annotated[
        Names,
        Option(
            "--read-alone",
            "Attributes that some passes read without the rest; their targets total at most 4 bytes per attribute. "
            "Or none.",
        ),
    ] = ("normal", "roughness")
    classes: Annotated[
        Names, Option("--classes", "Classes of surfaces to judge by: mirror, glossy, rough, emissive; or all.")
    ] = ("all",)
    overdraw: Annotated[float, Option("--overdraw", "Number of times that each pixel is written.")] = 1.5
    readers: Annotated[
        Names,
        Option(
            "--readers",
            "Decoding passes, comma-separated: the number that read everything, or all for one such pass; for each "
            "other pass its attributes, such as 1,normal+roughness.",
            repeats=True,
        ),
    ] = ("1", "normal+roughness")
    family: Families = ("navi21",)
    most_instructions: Annotated[
        int | None, Option("--most-instructions", "Maximum number of issue slots for packing and unpacking once.")
    ] = None
    size: Size = "320x240"
    against: Annotated[
        Names | None,
        Option("--against", "Layouts to compare with: presets or your own TOML files; comma-separated.", files=True),
    ] = None
    engines: Annotated[bool, Option("--engines/--no-engines", "Measure engines' layouts as well.")] = False


@dataclass(frozen=True, kw_only=True)
class BudgetOutputs:
    """Files that `budget` writes besides its rows."""

    layouts: Annotated[Path | None, Option("--layouts", "Write the layouts to this folder, as TOML files.")] = None
    plot: Plot = None
    verbose: Verbose = False


COLUMNS = (
    Column(
        "kind",
        "proposal; mine, for a layout of --against; improved, for the same attributes in the same targets; or engine.",
        KEY,
    ),
    Column("layout", "The layout's name.", KEY),
    Column("limit", "The requested bytes per pixel.", KEY, "bytes"),
    Column("scene", "The scenes to judge by; each figure is for the worst scene.", KEY, drops=3),
    Column("bytes_per_pixel", "Bytes per pixel of the targets, without native depth.", unit="bytes", better="less"),
    Column(
        "contract_bytes",
        "`bytes_per_pixel`, plus the motion, shading model, F0 and AO of --hold if the layout lacks them, and minus "
        "emissive if it was not requested. Layouts are compared by this size.",
        unit="bytes",
        better="less",
    ),
    Column(
        "worst_db",
        "PSNR of the displayed image over its worst class of surfaces: mirror (roughness up to 0.2), glossy (up to "
        "0.5), rough, emissive.",
        unit="dB",
        better="more",
    ),
    Column("worst_class", "The worst class and its scene.", HOW),
    Column(
        "held_back_db",
        "PSNR of the worst class of each scene, from the mean error over scenes. For each scene the proposal is "
        "chosen again, with only the other scenes.",
        unit="dB",
        better="more",
    ),
    Column("psnr_db", "PSNR of the displayed image over all covered pixels.", unit="dB", better="more"),
    Column("flip_p99", "FLIP (99th percentile) over the covered pixels.", better="less", drops=6),
    Column(
        "predicted_worst_db", "`worst_db`, predicted as the sum of the attributes' separate errors.", unit="dB", drops=7
    ),
    Column("predicted_db", "`psnr_db`, predicted in the same way.", unit="dB", drops=8),
    Column("error_from", "The attributes that cause the error of the worst class.", HOW, drops=5),
    Column(
        "next_bytes",
        "The smallest of 1, 2 and 4 more bytes that gains at least half a decibel in the worst class.",
        unit="bytes",
    ),
    Column("next_db", "Gain in the worst class from the bytes in `next_bytes`.", unit="dB"),
    Column("blends", "Attributes in targets that hardware can blend decals into, as --blend requires.", HOW),
    Column("codes", "The encoding of each attribute.", HOW, drops=9),
    Column("by_contract", "Attributes that no scene shows: their bits are given, not measured.", HOW, drops=9),
    Column(
        "changes",
        "For your own layout: the changes to a proposal's encodings that gain most, and the worst class after each "
        "change.",
        HOW,
        drops=9,
    ),
    Column("targets", "The render targets, as in a layout file.", HOW, drops=10),
    Column("holds", "For an engine's layout: the quantity that sets how much a surface reflects.", HOW, drops=10),
    Column(
        "mb_1080p",
        "Megabytes written and read per frame at 1920 x 1080: pixels x (overdraw x bytes + the bytes that each of "
        "`readers` fetches). Compression is not modelled.",
        unit="MB",
        better="less",
        drops=4,
    ),
    Column("mb_4k", "Megabytes written and read per frame at 3840 x 2160.", unit="MB", better="less", drops=4),
    Column(
        "pack_slots",
        "Issue slots to pack a surface into the targets, in a compute shader. Format conversion in hardware is free.",
        unit="slots",
        better="less",
        drops=6,
    ),
    Column("unpack_slots", "Issue slots to unpack all attributes.", unit="slots", better="less", drops=6),
    Column(
        "slots",
        "Issue slots per pixel: overdraw x pack_slots, plus unpack_slots for each of `readers` that reads everything.",
        unit="slots",
        better="less",
        drops=7,
    ),
    Column(
        "dearest_family",
        "The GPU family of --family with the highest cost; the slots are for this family.",
        HOW,
        drops=10,
    ),
    Column(
        "webgpu_bytes",
        "Bytes per sample that the targets use of WebGPU's 32; empty if WebGPU cannot render to one of the formats.",
        unit="bytes",
        better="less",
        drops=10,
    ),
    Column("in_tile", "Whether the targets and the light buffer fit in the tile of --limit tile:BYTES.", HOW, drops=2),
    Column("tile_bytes", "Bytes per pixel of targets and light buffer in a tile, if --limit names one.", HOW, drops=2),
    Column("overdraw", "Number of times that each pixel is written.", HOW, drops=11),
    Column("readers", "How many passes read everything, and what other passes read.", HOW, drops=11),
    Column("size", "Width and height of the image in pixels.", HOW, drops=11),
    shared.DEVICE,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Find the smallest layout for a quality, or the best for a size.\n\nEach encoding of "
    "each attribute is measured separately, by its effect on the displayed image of mirrors, glossy and rough "
    "surfaces. An integer program then finds the encodings and targets with the best worst class, and the whole "
    "layout is drawn.",
    example="normalbench budget --bytes 12,16 --read-alone normal,roughness",
    is_kept=True,
    step_s=0.2,
    options=BudgetOptions,
    outputs=BudgetOutputs,
    columns=COLUMNS,
    # Many a scene has no metal/rough materials, which a budget is of.
    not_with="scene",
    usual=({"bytes": "12,16"},),
    single={"bytes": "12"},
    group=Group.ANSWER,
    section=Section(
        title="G-buffer layout",
        short="Budget",
        view=View.LAYOUTS,
        intro="What is the smallest G-buffer that still looks right?",
        method="Each encoding of each attribute is measured separately: the error of the displayed image, by class "
        "of surfaces. An integer program finds the layout with the best worst class for a number of bytes, and "
        "takes the simplest layout within 0.2 dB. This layout is drawn whole. For other sizes, and engines' "
        "layouts, run `normalbench budget --bytes 12,14,16,20 --engines`.",
    ),
)
