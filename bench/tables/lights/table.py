"""The lights table: the errors of light buffers."""

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
    sums: Annotated[Names, Option("--sum", "equal: the sum of the lights; random: the smallest sum.")] = ("1", "4")
    counts: Annotated[Names, Option("--counts", "equal, random: numbers of lights.")] = ("8", "64", "256")
    peaks: Annotated[Names, Option("--peak", "banding: the light at a lamp's centre.")] = ("0.1", "1", "2", "3")
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class LightsOutputs:
    """Files that `lights` writes besides its rows."""

    images: Images = None
    plot: Plot = None


COLUMNS = (
    Column("experiment", "The experiment.", KEY),
    Column("light_buffer", "The encoding of the light buffer.", KEY),
    Column("sum", "The sum of the lights.", KEY),
    Column("lights", "Number of lights.", KEY),
    Column("channel", "The channels of the light's colour that the row is for.", KEY),
    Column("order", "The order in which lights are added.", KEY),
    Column("peak", "The light at a lamp's centre.", KEY),
    Column("colour", "The lamp's colour.", KEY),
    Column("model", "The sum in the light buffer, as predicted by the model in JAX."),
    Column("gl", "The sum in the light buffer, on the OpenGL device."),
    Column("error", "Error of the model's sum; negative if it is too small."),
    Column("gl_error", "Error of the device's sum; negative if it is too small."),
    Column("model_rms", "RMS error over the pixels, as predicted by the model.", better="less"),
    Column("gl_rms", "RMS error over the pixels, on the device.", better="less"),
    Column("model_max", "Largest error over the pixels, as predicted by the model.", better="less"),
    Column("gl_max", "Largest error over the pixels, on the device.", better="less"),
    Column("bound", "The bound on the error.", HOW),
    Column("levels", "Distinct levels of a falloff that remain, as predicted by the model.", better="more"),
    Column("gl_levels", "Distinct levels of a falloff that remain, on the device.", better="more"),
    Column("exact_step", "The largest step of the falloff itself.", HOW, drops=5),
    Column("largest_step", "The largest step that remains, as predicted by the model.", better="less"),
    Column("gl_largest_step", "The largest step that remains, on the device.", better="less"),
    Column("shown_step", "The largest step as displayed, as predicted by the model.", unit="1/255", better="less"),
    Column("gl_shown_step", "The largest step as displayed, on the device.", unit="1/255", better="less"),
    Column("stored_error", "Error of the stored values, as predicted by the model.", better="less"),
    Column("gl_stored_error", "Error of the stored values, on the device.", better="less", drops=4),
    Column(
        "amplification",
        "Ratio of the error of a rebuilt highlight to the error of the stored values, as predicted by the model.",
        better="less",
    ),
    Column(
        "gl_amplification",
        "Ratio of the error of a rebuilt highlight to the error of the stored values, on the device.",
        better="less",
    ),
    Column("rounds", "How this device rounds when it blends.", HOW),
    Column("agree_percent", "Pixels that equal the model with this rounding.", HOW, "%", drops=7),
    shared.DEVICE,
    shared.SEED,
    shared.SKIPPED,
)
ALSO = (Column("*_lights", "The sum in the light buffer of this number of lights."),)

TABLE = Table(
    package=__package__ or "",
    help="Measure light buffers: sums, banding and rebuilt colour.\n\nThe model, in JAX, is compared with the OpenGL "
    "device. Without an OpenGL device only the model is measured.",
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
        title="Light buffer accuracy",
        short="Light",
        intro="Lights are added one by one, and every sum is rounded: how accurate is the sum in each light buffer?",
        method="The model, in JAX, is compared with blending on the OpenGL device. equal: N equal lights of a known "
        "sum. random: coloured lights with falloff in three orders. banding: one lamp's falloff. "
        "chromaticity: a highlight's colour rebuilt from one target.",
        parts="experiment",
    ),
)
