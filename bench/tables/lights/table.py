"""The lights table: what light buffers lose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import (
    Images,
    LightBuffers,
    Option,
    Plot,
    Seed,
)
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class LightsOptions(SourceOptions):
    """Options for what `lights` measures. Names and numbers are comma-separated."""

    experiment: Annotated[Names, Option("--experiment", "equal, random, banding, chromaticity; or all.")] = ("all",)
    light_buffer: LightBuffers = ("all",)
    sums: Annotated[Names, Option("--sum", "equal: what the lights sum to; random: the least.")] = ("1", "4")
    counts: Annotated[Names, Option("--counts", "equal, random: numbers of lights.")] = ("8", "64", "256")
    peaks: Annotated[Names, Option("--peak", "banding: the light at a lamp's centre.")] = ("0.1", "1", "2", "3")
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class LightsOutputs:
    """Files that `lights` writes besides its rows."""

    images: Images = None
    plot: Plot = None


COLUMNS = (
    Column("experiment", "What was added up.", KEY),
    Column("light_buffer", "The code that light is added up in.", KEY),
    Column("sum", "What the lights add up to.", KEY),
    Column("lights", "How many lights.", KEY),
    Column("channel", "The channels of the light's colour that the row is of.", KEY),
    Column("order", "In which order lights are added.", KEY),
    Column("peak", "The light at a lamp's centre.", KEY),
    Column("colour", "The lamp's colour.", KEY),
    Column("model", "What is left of the sum by the model in JAX."),
    Column("gl", "What is left of the sum on the GL device."),
    Column("error", "What the model has too much or too little."),
    Column("gl_error", "What the device has too much or too little."),
    Column("model_rms", "Error over the pixels by the model, root mean square.", better="less"),
    Column("gl_rms", "Error over the pixels on the device, root mean square.", better="less"),
    Column("model_max", "Largest error over the pixels by the model.", better="less"),
    Column("gl_max", "Largest error over the pixels on the device.", better="less"),
    Column("bound", "What the error can be at most.", HOW),
    Column("levels", "Different levels of a falloff that are left, by the model.", better="more"),
    Column("gl_levels", "Different levels of a falloff that are left on the device.", better="more"),
    Column("exact_step", "The largest step of the falloff itself.", HOW, drops=5),
    Column("largest_step", "The largest step that is left, by the model.", better="less"),
    Column("gl_largest_step", "The largest step that is left on the device.", better="less"),
    Column("shown_step", "The largest step as displayed, by the model.", unit="1/255", better="less"),
    Column("gl_shown_step", "The largest step as displayed, on the device.", unit="1/255", better="less"),
    Column("stored_error", "Error of what was stored, by the model.", better="less"),
    Column("gl_stored_error", "Error of what was stored, on the device.", better="less", drops=4),
    Column(
        "amplification",
        "How far the error of a rebuilt highlight exceeds that of what was stored, by the model.",
        better="less",
    ),
    Column("gl_amplification", "The same on the device.", better="less"),
    Column("rounds", "How this device rounds when it blends.", HOW),
    Column("agree_percent", "Pixels that equal the model that rounds so.", HOW, "%", drops=7),
    shared.DEVICE,
    shared.SEED,
    shared.SKIPPED,
)
ALSO = (Column("*_lights", "What is left of the sum of that many lights."),)

TABLE = Table(
    package=__package__ or "",
    help="Measure light buffers: sums, banding and rebuilt colour.\n\nThe model, in JAX, stands next to what the "
    "GL device does. Without a GL device the model is measured alone.",
    example="normalbench lights --experiment equal,banding --light-buffer rgbm,r11g11b10f",
    step_s=0.4,
    options=LightsOptions,
    outputs=LightsOutputs,
    columns=COLUMNS,
    also=ALSO,
    usual=({"peaks": "0.1,1"},),
    single={"experiment": "equal", "light_buffer": "linear", "sums": "1", "counts": "64"},
    by="experiment",
    partial=True,
    section=Section(
        title="What a light buffer loses",
        short="Light",
        intro="Lights are added up one by one, and every sum is rounded: what is left of them in each light buffer?",
        method="The model, in JAX, stands next to what the GL device does when it blends. equal: N equal lights of a "
        "known "
        "sum. random: coloured lights with falloff in three orders. banding: one lamp's falloff. chromaticity: a "
        "highlight's colour rebuilt from one target.",
        parts="experiment",
    ),
)
