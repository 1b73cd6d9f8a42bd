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

    bytes: Annotated[Names, Option("--bytes", "Bytes a pixel without native depth, comma-separated.")] = (
        "12",
        "16",
        "20",
    )
    scene: Annotated[
        Names,
        Option(
            "--scene",
            "Metal/rough scenes that judge: ramps, studio, glTF files, and captured frames (gbuffer.json); "
            "comma-separated.",
            files=True,
            in_run=True,
        ),
    ] = ("ramps", "studio")
    environment: Annotated[
        str | None,
        Option("--environment", "What they reflect: studio, sky, strips, lamp, or an .hdr or .exr file.", files=True),
    ] = None
    hold: Annotated[
        Names,
        Option(
            "--hold",
            "What is stored: normal, base_color, roughness, metallic, f0, ao, tangent; motion in a target "
            "of its own, or motion:packed; shading_model:BITS, flags:BITS, either in the stencil as flags:stencil; "
            "shadow:BITS, custom:BITS, other:BITS; emissive, or emissive:light where the light buffer has it.",
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
        Option("--speed", "Pixels a frame at 1920 x 1080 up to which motion must be within 1/16 pixel, 0 to 500."),
    ] = 64.0
    targets: Annotated[int, Option("--targets", "The most render targets that there may be.")] = 6
    formats: Annotated[Names, Option("--formats", "Formats that targets may have, comma-separated, or all.")] = ("all",)
    fields: Annotated[
        bool, Option("--fields/--no-fields", "Allow several numbers to share a channel as bit fields.")
    ] = True
    integers: Annotated[bool, Option("--integers/--no-integers", "Allow integer targets.")] = True
    limit: Annotated[
        Names | None,
        Option(
            "--limit",
            "webgpu: its 32 bytes a sample and its formats; tile:16, tile:32, tile:64: a GPU's bytes a pixel in tiles.",
        ),
    ] = None
    light: Annotated[
        str, Option("--light", "Format of the light buffer, which is drawn with the G-buffer: it counts for --limit.")
    ] = "r11g11b10f"
    threshold: Annotated[
        float | None,
        Option("--threshold", "The fewest bytes whose FLIP (99th percentile) is at most this, in place of --bytes."),
    ] = None
    blend: Annotated[Names | None, Option("--blend", "What decals blend into: base_color,roughness,normal.")] = None
    read_alone: Annotated[
        Names,
        Option(
            "--read-alone",
            "What a pass reads by itself: at most 4 bytes for each, in targets with nothing else of 16 bits; or none.",
        ),
    ] = ("normal", "roughness")
    classes: Annotated[
        Names, Option("--classes", "Classes of surfaces that judge: mirror, glossy, rough, emissive; or all.")
    ] = ("all",)
    overdraw: Annotated[float, Option("--overdraw", "How often a pixel is written.")] = 1.5
    readers: Annotated[
        Names,
        Option(
            "--readers",
            "The passes that read the G-buffer, comma-separated: a number of passes that read all of it, or all for "
            "one of them, and for each other pass its attributes, such as 1,normal+roughness.",
            repeats=True,
        ),
    ] = ("1", "normal+roughness")
    family: Families = ("navi21",)
    most_instructions: Annotated[
        int | None, Option("--most-instructions", "The most issue slots that packing and unpacking once may execute.")
    ] = None
    size: Size = "320x240"
    against: Annotated[
        Names | None,
        Option("--against", "Layouts to compare with: presets, or TOML files of yours; comma-separated.", files=True),
    ] = None
    engines: Annotated[bool, Option("--engines/--no-engines", "Whether engines' layouts are measured as well.")] = False


@dataclass(frozen=True, kw_only=True)
class BudgetOutputs:
    """Files that `budget` writes besides its rows."""

    layouts: Annotated[Path | None, Option("--layouts", "Folder for the layouts, as TOML files.")] = None
    plot: Plot = None
    verbose: Verbose = False


COLUMNS = (
    Column(
        "kind",
        "proposal; mine, for a layout of --against; improved, for the same attributes in the same targets; or engine.",
        KEY,
    ),
    Column("layout", "The layout's name.", KEY),
    Column("limit", "The bytes a pixel that were asked for.", KEY, "bytes"),
    Column("scene", "The scenes that judged; each figure is of the worst of them.", KEY, drops=3),
    Column("bytes_per_pixel", "Of the targets, without native depth.", unit="bytes", better="less"),
    Column(
        "contract_bytes",
        "The same with the motion, shading model, F0 and AO of --hold added where it lacks them, and less "
        "emissive that nobody asked for: layouts are compared by it.",
        unit="bytes",
        better="less",
    ),
    Column(
        "worst_db",
        "The displayed image over the pixels of the class of surfaces that it is worst for: mirror (roughness up to "
        "0.2), glossy (up to 0.5), rough, emissive.",
        unit="dB",
        better="more",
    ),
    Column("worst_class", "That class, and its scene.", HOW),
    Column(
        "held_back_db",
        "The worst class of each scene, as the mean error over scenes. A proposal is chosen anew for each of them, on "
        "the other scenes alone.",
        unit="dB",
        better="more",
    ),
    Column("psnr_db", "The displayed image over all covered pixels.", unit="dB", better="more"),
    Column("flip_p99", "FLIP's 99th percentile over the covered pixels.", better="less", drops=6),
    Column("predicted_worst_db", "`worst_db` as the sum of the codes' own errors.", unit="dB", drops=7),
    Column("predicted_db", "`psnr_db` likewise.", unit="dB", drops=8),
    Column("error_from", "Where the error of the worst class comes from.", HOW, drops=5),
    Column(
        "next_bytes", "Of 1, 2 and 4 bytes more the fewest that gain half a decibel in the worst class.", unit="bytes"
    ),
    Column("next_db", "What these bytes gain there.", unit="dB"),
    Column("blends", "The attributes whose targets are kept for decals that hardware blends, as --blend asks.", HOW),
    Column("codes", "The code of each attribute.", HOW, drops=9),
    Column("by_contract", "What no scene showed: its bits are by contract, not measured.", HOW, drops=9),
    Column(
        "changes",
        "Of a layout of yours: the changes to a proposal's codes that bring most, and the worst class after each.",
        HOW,
        drops=9,
    ),
    Column("targets", "The render targets, as a layout file says them.", HOW, drops=10),
    Column("holds", "What says how much a surface reflects, of an engine's layout.", HOW, drops=10),
    Column(
        "mb_1080p",
        "Bytes written and read a frame at 1920 x 1080: pixels x (overdraw x bytes + the bytes that each of `readers` "
        "fetches). Compression is not modelled.",
        unit="MB",
        better="less",
        drops=4,
    ),
    Column("mb_4k", "The same at 3840 x 2160.", unit="MB", better="less", drops=4),
    Column(
        "pack_slots",
        "Issue slots to pack a surface into the targets, in a compute shader. What formats convert costs nothing.",
        unit="slots",
        better="less",
        drops=6,
    ),
    Column("unpack_slots", "Issue slots to unpack all of it.", unit="slots", better="less", drops=6),
    Column(
        "slots",
        "Issue slots a pixel: overdraw x pack_slots + unpack_slots for each of `readers` that reads all.",
        unit="slots",
        better="less",
        drops=7,
    ),
    Column("dearest_family", "The GPU family of --family where that is most, which the slots are of.", HOW, drops=10),
    Column(
        "webgpu_bytes",
        "What the targets cost of WebGPU's 32 bytes a sample; empty where it does not render to one of them.",
        unit="bytes",
        better="less",
        drops=10,
    ),
    Column("in_tile", "Whether targets and light buffer fit the tile of --limit tile:BYTES.", HOW, drops=2),
    Column("tile_bytes", "Bytes a pixel of targets and light buffer in a tile, where --limit names one.", HOW, drops=2),
    Column("overdraw", "How often a pixel is written.", HOW, drops=11),
    Column("readers", "How many passes read all of it, and what others read of it.", HOW, drops=11),
    Column("size", "Width and height of the image in pixels.", HOW, drops=11),
    shared.DEVICE,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Find the smallest layout for a quality, or the best for a size.\n\nEach code of each attribute "
    "is measured by itself, by what it does to the displayed image of mirrors, glossy and rough surfaces. An "
    "integer program then finds the codes and targets whose worst class is best, and the layout is drawn "
    "whole.",
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
        title="How few bytes does the whole G-buffer need?",
        short="Budget",
        view=View.LAYOUTS,
        intro="How few bytes a pixel does an image bear, and what lies in them?",
        method="Each code of each attribute is measured by itself: the error of the displayed image, by class of "
        "surfaces. An integer program finds the layout whose worst class is best in a number of bytes, and the "
        "plainest one within 0.2 dB. That is drawn whole. Other bytes, next to engines' layouts, are by "
        "`normalbench budget --bytes 12,14,16,20 --engines`.",
    ),
)
