"""The cost table: the cost of encoding and decoding."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.gpu_families import CHOICES, titled
from ...ground.options.option import Arithmetics, Encodings, Option
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..quality.table import COMMON
from ..table import Column, Role, Section, Table

KEY, HOW, TIME = Role.KEY, Role.HOW, Role.TIME


@dataclass(frozen=True, kw_only=True)
class CostOptions(SourceOptions):
    """Options for what `cost` measures. Names are comma-separated."""

    encoding: Encodings = ("all",)
    isa: Annotated[bool, Option("--isa", "Count the instructions that compilers generate from GLSL; needs no GPU.")] = (
        False
    )
    time: Annotated[bool, Option("--time", "Measure nanoseconds per megapixel on the OpenGL device.")] = False
    article: Annotated[bool, Option("--article", "Show the figures of Pranckevicius' article as well.")] = False
    family: Annotated[
        Names,
        Option(
            "--family",
            f"GPUs, comma-separated: {', '.join(CHOICES['radeon'])}, or radeon for these; {titled('intel')}, or intel "
            f"for these; {titled('nvidia')}, or nvidia for these; all.",
            in_run=True,
        ),
    ] = ("radeon",)
    stage: Annotated[Names, Option("--stage", "fragment, compute; comma-separated, or all.")] = ("fragment", "compute")
    operation: Annotated[Names, Option("--operation", "encode, decode; comma-separated, or all.")] = (
        "encode",
        "decode",
    )
    arithmetic: Arithmetics = ("declared",)
    storage: Annotated[
        Names,
        Option("--storage", "Storages and packings to show the cost of, comma-separated, or all.", in_run=True),
    ] = ("rgba8", "rgba8_snorm", "11:11", "12:12", "16:16", "11:10:11", "depth16", "depth24", "depth24_sign")
    size: Annotated[
        str | None,
        Option("--size", "WIDTHxHEIGHT of the target to time. Default: 64x64 in software, or 1024x1024."),
    ] = None
    repeats: Annotated[int, Option("--repeats", "Number of repetitions to take medians over.")] = 9


@dataclass(frozen=True, kw_only=True)
class CostOutputs:
    """Files that `cost` writes besides its rows."""

    disassembly: Annotated[
        Path | None, Option("--disassembly", "Write the output of each family's compiler to this folder.")
    ] = None


def _count_column(name: str, says: str, drops: int = 0) -> Column:
    return Column(name, says, better="less", drops=drops)


COLUMNS = (
    Column("measure", "isa: instructions; time: on the OpenGL device; article: published figures.", KEY),
    Column("encoding", "How a normal is turned into numbers; empty in the rows of storages.", KEY),
    Column("storage", "A storage's packing of bit fields into channels; empty in the rows of encodings.", KEY),
    Column("operation", "encode or decode; pack or unpack.", KEY),
    Column("stage", "The kind of shader.", KEY),
    Column("family", "The GPU family that the shader was compiled for.", KEY),
    _count_column(
        "instructions",
        "Instructions of one lane, minus those of an empty kernel that moves the same numbers. The columns "
        "full_rate, conversion, quarter_rate, transcendental, scalar, memory, waiting, control_flow and other_alu "
        "add up to this count if there is a disassembly.",
    ),
    _count_column(
        "issue_slots",
        "How long the instructions keep the vector unit busy, in full-rate instructions: on GCN slow instructions "
        "count 4; on RDNA a transcendental instruction issues once and runs in a separate unit. Empty for Intel and "
        "NVIDIA.",
    ),
    _count_column(
        "executed_slots",
        "Issue slots that one lane takes, with each loop counted as often as it runs on average over the sphere, "
        "measured on the OpenGL device. A transcendental instruction counts as the vendor's compiler or documents "
        "state: 4 on GCN, 2 on Intel from Broadwell on, 4 on Turing, 8 on later GPUs of NVIDIA, 1 elsewhere. Empty "
        "if the number of loop iterations is not known.",
    ),
    _count_column("full_rate", "Radeon: instructions at the full rate.", 17),
    _count_column(
        "conversion",
        "Conversions between floats and integers: at a quarter of the rate on Polaris and Vega. Intel: also between "
        "two sizes of floats. NVIDIA: also rounding to whole numbers, in the same unit.",
        13,
    ),
    _count_column(
        "quarter_rate",
        "Radeon: instructions at a quarter of the full rate: 32-bit integer multiplications and, on Polaris, fused "
        "multiply-adds.",
        11,
    ),
    _count_column(
        "transcendental",
        "Reciprocal, root, logarithm, sine: at a quarter of the rate; from Navi on in a separate unit. Intel: "
        "`math`, which also divides integers. NVIDIA: `MUFU`.",
    ),
    _count_column("scalar", "Radeon, Intel, NVIDIA: instructions that run once for all lanes.", 14),
    _count_column(
        "memory",
        "Loads, stores, export; Radeon: also interpolation; Intel: messages (`send`); NVIDIA: also reads of constants.",
        15,
    ),
    _count_column(
        "waiting",
        "Waits and scheduling hints; NVIDIA: without the padding after a kernel's end.",
        10,
    ),
    _count_column("control_flow", "Jumps and the ends of branches and programs. Radeon: in `scalar`.", 18),
    _count_column(
        "other_alu", "All other arithmetic, moves, compares and selections; also interpolation. Radeon: empty.", 19
    ),
    _count_column("packed", "Radeon: the part of full_rate that works on two 16-bit numbers at once.", 20),
    _count_column("branches", "Conditional jumps, minus the empty kernel's. Both sides of a branch count.", 12),
    _count_column("loops", "Backward jumps, minus the empty kernel's. The body of a loop counts once."),
    _count_column("looped", "Instructions in loops, which run again in each iteration.", 21),
    _count_column(
        "spirv_instructions",
        "SPIR-V instructions after spirv-opt, with loops unrolled. The count is portable; it counts an operation on a "
        "vector once, and depends on how the code is written. Empty if a loop remains.",
    ),
    _count_column(
        "vgprs",
        "Vector registers, minus the empty kernel's; a driver allots 4, 8 or more at once. NVIDIA: all registers.",
        16,
    ),
    _count_column("sgprs", "Scalar registers, minus the empty kernel's.", 8),
    _count_column(
        "spills", "Registers spilled to memory, or Intel's messages that spill, minus the empty kernel's.", 9
    ),
    _count_column("code_bytes", "Bytes of code, minus the empty kernel's.", 7),
    _count_column(
        "stall_cycles",
        "NVIDIA: cycles that a warp waits after its instructions, as set by the compiler and added up along the "
        "code, minus the empty kernel's. Waits at barriers, such as for memory, are not included.",
        6,
    ),
    Column(
        "simd_width",
        "Lanes that an instruction works on. For Intel's kernels with 8, 16 and 32 lanes: the widest that does not "
        "spill and that the empty kernel also has.",
        HOW,
        drops=5,
    ),
    Column("kernel_vgprs", "All vector registers of the kernel.", HOW, drops=6),
    Column("kernel_sgprs", "All scalar registers of the kernel.", HOW, drops=5),
    Column(
        "kernel_waves",
        "How many waves of 64 lanes of the whole kernel fit on a Radeon's SIMD, by its vector registers. Intel: "
        "threads of an execution unit, each with its own registers. NVIDIA: warps of 32 lanes in a quarter of a "
        "multiprocessor. More waves hide more latency.",
        HOW,
        drops=6,
    ),
    Column(
        "kernel_latency",
        "Cycles of the whole kernel by the driver's own model: a maximum over units, so not a sum of parts. Models "
        "of different vendors cannot be compared.",
        HOW,
        drops=3,
    ),
    Column(
        "kernel_inverse_throughput",
        "Cycles of the whole kernel by the driver's own model, if many instances run at once.",
        HOW,
        drops=4,
    ),
    Column("cycles", "Cycles per pixel, from the article.", HOW),
    Column(
        "ns_per_megapixel",
        "On the OpenGL device: median of the differences from the empty pass, with the operation run `turns` times "
        "in the shader.",
        TIME,
        "ns",
        "less",
    ),
    Column("spread", "Width of the 95% confidence interval of the median.", TIME),
    Column("turns", "How often the operation runs in the timed shader.", HOW),
    Column("size", "Width and height of the target in pixels.", HOW),
    Column("repeats", "Number of repetitions that the median is taken over.", HOW),
    Column("software", "Whether the OpenGL device is a software rasteriser.", HOW),
    Column("clock", "Clock that measured the time.", HOW, drops=15),
    shared.DEVICE,
    Column("driver", "The compiler whose instructions were counted.", HOW, drops=1),
    Column("compiler", "The compiler from GLSL to SPIR-V.", HOW, drops=1),
    shared.SKIPPED,
)
ALSO = (
    Column("what", "An encoding, or a storage's packing of bit fields into channels.", KEY),
    Column("article", "The article's instruction slots: ps_3_0, up to four numbers each, scale and bias included."),
    Column("spirv", "SPIR-V instructions after spirv-opt."),
    Column("polaris*", "Instructions that Mesa's RADV generates for that GPU family.", better="less"),
    Column("vega*", "Instructions that Mesa's RADV generates for that GPU family.", better="less"),
    Column("navi*", "Instructions that Mesa's RADV generates for that GPU family.", better="less"),
    *(
        Column(name, f"Instructions that Mesa's {driver} generates for that GPU family.", better="less")
        for driver, names in (
            ("hasvk", ("hsw", "bdw")),
            ("anv", ("skl", "tgl", "adl", "dg2")),
        )
        for name in names
    ),
    *(
        Column(
            name,
            "Instructions that NVIDIA's NVRTC generates for that GPU family, in a compute shader.",
            better="less",
        )
        for name in CHOICES["nvidia"]
    ),
    Column("slots", "The article's instruction slots: ps_3_0, up to four numbers each."),
    Column("GeForce*", "The article's cycles on that GPU.", drops=18),
    Column("Radeon*", "The article's cycles on that GPU.", drops=18),
)
PACKED = "rgba8,rg8,rgb10a2,rg16f,rg16,12:12,16:16,11:10:11,depth16,depth24,depth24_sign"

TABLE = Table(
    package=__package__ or "",
    help="Count instructions on GPUs of three vendors, and measure time.\n\nCounts are from Mesa's compilers, and "
    "for NVIDIA from its CUDA compiler, minus an empty kernel that moves the same numbers. The GPUs are not "
    "needed.",
    example="normalbench cost --isa --family navi31 --encoding octahedral,spheremap",
    is_kept=True,
    step_s=8.0,
    options=CostOptions,
    outputs=CostOutputs,
    columns=COLUMNS,
    also=ALSO,
    usual=({"isa": True, "encoding": ",".join(COMMON), "storage": PACKED},),
    single={"isa": True, "encoding": "octahedral", "family": "navi21", "stage": "fragment", "storage": "rgba8"},
    files={"disassembly": "disassembly"},
    by="measure",
    partial=True,
    compilers=("driver", "compiler"),
    section=Section(
        title="Encoding cost",
        short="Cost",
        view=View.CODECS,
        intro="How many instructions does a current compiler generate for each encoder and decoder, and are they "
        "worth it?",
        method="A kernel with the encoding's own GLSL is compiled by Mesa's drivers, minus an empty kernel that "
        "moves the same numbers, so that doing nothing costs exactly 0. The GPUs are not needed. Counts hold "
        "for one version of Mesa.",
        extras=("disassembly",),
    ),
)
