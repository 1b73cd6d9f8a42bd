"""The table of curves: the error of stored material numbers, such as a roughness or a colour channel."""

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
    """Options for what `curves` measures. Names and numbers are comma-separated; without a storage, each curve is
    measured in its usual storage."""

    encoding: Annotated[Names, Option("--encoding", f"Curves or your own files, {NAMED}.", files=True)] = ("all",)
    storage: Annotated[
        Names | None, Option("--storage", f"Storages, {NAMED}. Default: each curve's usual storage.")
    ] = None
    rounding: RoundingsAndDithered = ("nearest",)
    backend: Backends = ("jax", "glsl")
    range: Annotated[
        Names | None,
        Option("--range", "Largest values to store, comma-separated. Default: each curve's usual range."),
    ] = None
    count: Annotated[
        int, Option("--count", "Number of values: one at random in each of as many equal steps from 0 to the range.")
    ] = 2**16
    seed: Seed = 0


DISPLAY = "on the sRGB curve, in 8-bit steps, over values that are evenly spread there"
NO_COLOURS = "Empty for curves that do not store colours, such as smoothness."
COLUMNS = (
    Column("encoding", "How a value is turned into a stored number.", KEY),
    shared.STORAGE,
    shared.ROUNDING_OR_DITHERED,
    shared.BACKEND,
    Column("range", "The largest value that can be stored.", KEY),
    Column("bits", "Bits of the code, in one channel."),
    Column("error_mean", "Mean difference between decoded and true value.", better="less"),
    Column("error_max", "Largest difference between decoded and true value.", better="less"),
    Column(
        "bias", "Mean of the decoded value minus the true value: the error that remains after dithering and averaging."
    ),
    Column(
        "relative_max",
        "Largest difference divided by the true value, for values from a hundredth of the range upwards.",
        unit="%",
        better="less",
    ),
    Column("display_mean", f"Mean difference {DISPLAY}. {NO_COLOURS}", better="less", drops=2),
    Column("display_max", f"Largest difference {DISPLAY}. {NO_COLOURS}", better="less"),
    Column("least", "The smallest value that does not decode to the same result as 0.", better="less", drops=3),
    Column("zero", "Decoded value of 0.", drops=1),
    Column("one", "Decoded value of the largest value, as a fraction of the range.", drops=1),
    Column("count", "How many values were measured.", HOW, drops=6),
    shared.DEVICE,
    shared.ROUNDED_BY,
    shared.SEED,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure curves of roughness, metallic, AO and colours in few bits.\n\nA curve is stored in the first "
    "channel of a storage. `unorm:5` is five bits.",
    example="normalbench curves --encoding linear,square_root,srgb --storage unorm:4..8 --backend jax",
    options=CurvesOptions,
    columns=COLUMNS,
    in_all=False,
    single={"encoding": "linear", "storage": "r8", "backend": "jax"},
    section=Section(
        title="Accuracy of roughness, AO and colours",
        short="Curves",
        intro="Material values in few bits: how large is the error in the value itself, and in the colour that a "
        "viewer sees?",
        method="Values that are evenly spread from 0 to the range are put on the curve, stored and decoded. Colour "
        "differences are on the sRGB curve, in 255ths, over values that are evenly spread there.",
    ),
)
