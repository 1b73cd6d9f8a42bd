"""The roofline table: the time that an encoding's bytes and instructions take per frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import Encodings, Option, Plot, StorageNames
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table
from .rates import GPUS, USUAL

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class RooflineOptions(SourceOptions):
    """Options of `roofline`. Names are comma-separated."""

    encoding: Encodings = ("xyz", "spheremap", "octahedral", "octahedral_precise")
    storage: StorageNames = ("rg8", "rgb10a2", "rgba16f")
    gpu: Annotated[
        Names,
        Option(
            "--gpu",
            f"GPUs, comma-separated, or all: {', '.join(f'{name} ({gpu.title})' for name, gpu in GPUS.items())}. "
            "NAME:memory=400 changes a rate; rates: lanes, clock (GHz), memory (GB/s), cache (MB), cached (GB/s). "
            "A family with these rates also works.",
            in_run=True,
        ),
    ] = USUAL
    size: Annotated[Names, Option("--size", "WIDTHxHEIGHT of the G-buffer, comma-separated.")] = (
        "1920x1080",
        "3840x2160",
    )
    reads: Annotated[
        Names, Option("--reads", "Numbers of passes that read and decode each pixel's normal, comma-separated.")
    ] = (
        "1",
        "4",
    )
    overdraw: Annotated[float, Option("--overdraw", "How often each pixel's normal is encoded and written.")] = 1.0
    cache_share: Annotated[
        float, Option("--cache-share", "Share of the last-level cache that normals may use, 0 to 1.")
    ] = 0.25
    shared: Annotated[
        bool,
        Option("--shared", "Share texels with other data: count only the encoding's own bits as traffic."),
    ] = False


@dataclass(frozen=True, kw_only=True)
class RooflineOutputs:
    """Outputs of `roofline` other than its rows."""

    plot: Plot = None


COLUMNS = (
    shared.ENCODING,
    shared.STORAGE,
    Column("gpu", "The GPU, with changed rates.", KEY),
    Column("size", "Width and height of the G-buffer in pixels.", KEY),
    Column("reads", "Number of passes that read and decode each pixel's normal.", KEY),
    shared.BITS,
    Column("bytes_per_pixel", "Bytes of the texel; with --shared, only of the encoding's own bits.", better="less"),
    Column(
        "encode",
        "Instructions to encode and pack; in full-rate instructions if these are known.",
        better="less",
        drops=5,
    ),
    Column("decode", "Instructions to unpack and decode.", better="less", drops=5),
    Column("instructions", "Instructions per pixel and frame: `overdraw` encodes and `reads` decodes.", better="less"),
    Column("megabytes", "Megabytes written and read per frame.", better="less", drops=8),
    Column("memory_us", "Time for the bytes.", unit="us", better="less", drops=4),
    Column("alu_us", "Time for the instructions.", unit="us", better="less", drops=4),
    Column("frame_us", "The longer of memory_us and alu_us, because both run at once.", unit="us", better="less"),
    Column("bound", "Which time is longer: memory, for the bytes, or alu, for the instructions.", HOW),
    Column(
        "rank",
        "Rank by frame_us among the codecs with the same GPU, size and number of reads; equal times share a rank.",
        HOW,
    ),
    Column("in_cache", "Whether the normals fit into their share of the last-level cache.", HOW, drops=7),
    Column("ridge", "Instructions that take as long as moving one byte, at the bandwidth of the row.", HOW, drops=6),
    Column("shared", "Whether other data uses the rest of the texel.", HOW, drops=10),
    Column("overdraw", "How often each pixel's normal is encoded and written.", HOW, drops=10),
    Column("family", "The GPU family that instructions are counted for.", HOW, drops=9),
    Column("driver", "The compiler whose instructions were counted.", HOW, drops=11),
    shared.SKIPPED,
)
ALSO = (
    Column("code", "An encoding in its storage."),
    Column("* *x*", "frame_us on that GPU at that size.", unit="us", better="less"),
)

TABLE = Table(
    package=__package__ or "",
    help="Estimate which encoding is faster on which GPU, with a model.\n\nThe time for bytes depends on "
    "memory bandwidth, the time for instructions, as `cost --isa` counts them, on arithmetic. The longer time counts. "
    "Nothing is timed, and no GPU is needed.",
    example="normalbench roofline --encoding xyz,octahedral --storage rgba16f,rg8 --gpu rx6800xt,iris_xe",
    options=RooflineOptions,
    outputs=RooflineOutputs,
    columns=COLUMNS,
    also=ALSO,
    usual=({"encoding": "xyz,spheremap,octahedral,octahedral_precise", "storage": "rg8,rgb10a2,rgba16f"},),
    single={"encoding": "octahedral", "storage": "rg8", "gpu": "rx6800xt", "size": "1920x1080", "reads": "1"},
    by="gpu",
    in_all=False,
    compilers=("driver",),
    section=Section(
        title="Memory traffic and instructions",
        short="Roofline",
        view=View.CODECS,
        of_texels=True,
        intro="Is a smaller encoding worth its instructions?",
        method="Instructions are counted for the GPU's family: encoding with packing, and unpacking with decoding. A "
        "frame encodes and writes each pixel's normal `overdraw` times. Each pass reads and decodes it once. "
        "One time is bytes over bandwidth, the other is instructions over the full rate. The longer counts. "
        "If the normals fit into their share of the last-level cache, the cache's bandwidth is used. "
        "Compression of targets, latency and the other work of the passes are left out.",
    ),
)
