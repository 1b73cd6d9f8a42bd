"""The table of curves: what numbers of a material lose, such as a roughness or a channel of a colour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import NAMED, Backends, Option, RoundingsAndDithered, Seed
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class CurvesOptions(SourceOptions):
    """Options for what `curves` measures. Names and numbers are comma-separated; without a storage, each curve uses
    its usual one."""

    encoding: Annotated[Names, Option("--encoding", f"Curves or files of yours, {NAMED}.", files=True)] = ("all",)
    storage: Annotated[Names | None, Option("--storage", f"Storages, {NAMED}. Default: each curve's usual.")] = None
    rounding: RoundingsAndDithered = ("nearest",)
    backend: Backends = ("jax", "glsl")
    range: Annotated[
        Names | None,
        Option("--range", "Largest quantities that are kept, comma-separated. Default: each curve's usual."),
    ] = None
    count: Annotated[int, Option("--count", "Quantities, one at random in each of as many steps to the range.")] = 2**16
    seed: Seed = 0


DISPLAY = "on the sRGB curve, in steps of 8 bits, of quantities that are evenly spread there"
NO_COLOURS = "Empty for curves on which no colours are stored, such as smoothness."
COLUMNS = (
    Column("encoding", "How a quantity becomes a number.", KEY),
    shared.STORAGE,
    shared.ROUNDING_OR_DITHERED,
    shared.BACKEND,
    Column("range", "The largest quantity that is kept.", KEY),
    Column("bits", "Bits of the code: those of a channel."),
    Column("error_mean", "Mean distance of the decoded quantity from the true one.", better="less"),
    Column("error_max", "Largest distance of the decoded quantity from the true one.", better="less"),
    Column("bias", "Mean of the decoded quantity minus the true one: what dithering and averaging leave."),
    Column(
        "relative_max",
        "Largest distance over the true quantity, of quantities from a hundredth of the range on.",
        unit="%",
        better="less",
    ),
    Column("display_mean", f"Mean distance {DISPLAY}. {NO_COLOURS}", better="less", drops=2),
    Column("display_max", f"Largest distance {DISPLAY}. {NO_COLOURS}", better="less"),
    Column("least", "The smallest quantity that does not decode to what 0 decodes to.", better="less", drops=3),
    Column("zero", "What 0 decodes to.", drops=1),
    Column("one", "What the range decodes to, as a share of the range.", drops=1),
    Column("count", "How many quantities were measured.", HOW, drops=6),
    shared.DEVICE,
    shared.ROUNDED_BY,
    shared.SEED,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure curves of roughness, metallic, AO and colours in few bits.\n\nA curve lies in the first channel "
    "of a storage. `unorm:5` is five bits.",
    example="normalbench curves --encoding linear,square_root,srgb --storage unorm:4..8 --backend jax",
    options=CurvesOptions,
    columns=COLUMNS,
    in_all=False,
    single={"encoding": "linear", "storage": "r8", "backend": "jax"},
    section=Section(
        title="What roughness and colours lose",
        short="Curves",
        intro="A number of a material in few bits: how far is it off, in itself and as a viewer sees a colour of it?",
        method="Quantities that are evenly spread from 0 to the range are put on the curve, stored and read back. The "
        "distances of colours are on the sRGB curve, in 255ths, of quantities that are evenly spread there.",
    ),
)
