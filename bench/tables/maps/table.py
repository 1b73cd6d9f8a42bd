"""The maps table: the error of block-compressed normal maps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated

from ...ground.options.option import Encodings, Images, Option, Plot, Reading
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW
# By format, what it is.
BLOCKS: Mapping[str, str] = MappingProxyType(
    {
        "none": "8 bits per channel, uncompressed: RG8 or RGBA8",
        "bc5": "two channels of BC4, also called RGTC2, ATI2 and 3Dc",
        "bc3": "RGB in 5:6:5 bits and alpha in 8 bits, also called DXT5, for `dxt5nm`",
        "bc7": "RGBA in one of eight modes, also called BPTC",
        "eac_rg11": "two channels of EAC, 11 bits each",
        "astc_4x4": "RGBA in one of many modes, LDR",
    }
)
# By swizzle, which channels hold the numbers of a code.
SWIZZLES: Mapping[str, str] = MappingProxyType(
    {
        "rg": "red and green",
        "rrrg": "one number in red, green and blue, the other in alpha, as astcenc stores normal maps",
        "dxt5nm": "alpha and green, with the other channels 1, as Unity stores normal maps",
        "rgb": "three numbers in red, green and blue",
    }
)
DECODERS: Mapping[str, str] = MappingProxyType(
    {
        "model": "as the specification defines; ASTC by astcenc",
        "device": "the OpenGL driver, from a texture of the blocks",
    }
)


def _listed_text(known: Mapping[str, str]) -> str:
    return "; ".join(f"{name}: {text}" for name, text in known.items())


@dataclass(frozen=True, kw_only=True)
class MapsOptions(Reading, SourceOptions):
    """Options for what `maps` measures. Names are comma-separated."""

    encoding: Encodings = ("xy", "hemi_octahedral", "octahedral", "xyz")
    block: Annotated[Names, Option("--block", f"{', '.join(BLOCKS)}; comma-separated, or all.")] = ("all",)
    swizzle: Annotated[
        Names,
        Option("--swizzle", f"{', '.join(SWIZZLES)}; comma-separated, or all. Default: each format's usual swizzles."),
    ] = ()
    normals: Annotated[
        Names,
        Option(
            "--normals",
            "Image files of normals, or bumps (smooth), grain (noise), playground; comma-separated.",
            files=True,
        ),
    ] = ("bumps", "grain")
    decoder: Annotated[Names, Option("--decoder", "model, device; comma-separated, or all.")] = ("model",)


@dataclass(frozen=True, kw_only=True)
class MapsOutputs:
    """Files that `maps` writes besides its rows."""

    images: Images = None
    plot: Plot = None


def _angle_column(name: str, says: str, drops: int = 0) -> Column:
    return Column(name, says, unit="degrees", better="less", drops=drops)


COLUMNS = (
    shared.ENCODING,
    Column("block", f"The texture format. {_listed_text(BLOCKS)}.", KEY),
    Column("swizzle", f"The channels that hold the code. {_listed_text(SWIZZLES)}.", KEY),
    Column("normals", "The image of normals that was measured.", KEY),
    Column("decoder", f"Decoder of the blocks. {_listed_text(DECODERS)}.", KEY, drops=5),
    Column("bits_per_texel", "Bits per texel in memory.", unit="bits", better="less"),
    _angle_column("angle_mean_deg", "Mean angle between normal and decode."),
    _angle_column("angle_rms_deg", "Root mean square of the angle."),
    _angle_column("angle_p99_deg", "99th percentile of the angles."),
    _angle_column("angle_max_deg", "The largest angle."),
    Column(
        "psnr_db",
        "Peak signal-to-noise ratio of the normals, peak 1. Decodes are not renormalised before the comparison.",
        unit="dB",
        better="more",
    ),
    Column(
        "code_psnr_db",
        "Peak signal-to-noise ratio of the channels that hold the code, peak 1, against the 8-bit values given to "
        "the encoder; over every texel of the image. This is what texture tools report.",
        unit="dB",
        better="more",
        drops=3,
    ),
    Column(
        "invalid", "Decodes that are NaN or infinite; each counts as the opposite direction.", better="less", drops=2
    ),
    Column(
        "encode_ms_per_megatexel",
        "Milliseconds that the encoder takes for 2^20 texels, with the threads that its package uses.",
        Role.TIME,
        "ms",
        "less",
        drops=4,
    ),
    Column("count", "How many normals were measured.", HOW, drops=6),
    shared.CODE_SPACE,
    Column("background", "Texels without a surface. They hold (0, 0, 1) and are not counted.", HOW, drops=7),
    Column("encoder", "The package that encoded the blocks, and its effort.", HOW, drops=1),
    Column("device", "Decoder of the blocks on this machine.", HOW, drops=1),
    shared.EXACT,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure block-compressed normal maps: BC5, BC7, EAC RG11, ASTC 4x4.\n\nA normal map is an image file "
    "(PNG, EXR, TIFF, DDS, HDR, WebP, NPY). The encoders are packages: pip install normalbench[maps].",
    example="normalbench maps --normals frame.png --encoding xy,octahedral --block bc5,bc7",
    step_s=0.08,
    options=MapsOptions,
    outputs=MapsOutputs,
    columns=COLUMNS,
    usual=(
        {"encoding": "xy,octahedral,xyz", "normals": "bumps"},
        {"encoding": "octahedral,xyz", "normals": "playground"},
    ),
    single={"encoding": "xy", "block": "bc5", "swizzle": "rg", "normals": "bumps"},
    section=Section(
        title="Normal map compression",
        short="Normal maps",
        intro="BC5, BC7, EAC or ASTC: which format is the most accurate for a normal map, with which encoding in "
        "which channels?",
        method="Each normal is encoded in 8 bits per channel, the image is compressed by an encoder package and "
        "decoded as the specification of the format defines, and each decoded normal is compared with the "
        "original. Images whose sides are not multiples of 4 are padded with their edge; only real texels "
        "count. Blocks are 4 x 4 texels, and a block that crosses the fold of an octahedral encoding holds "
        "both sides of the fold.",
    ),
)
