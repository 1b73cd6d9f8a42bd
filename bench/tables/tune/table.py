"""The tune table: parameters fitted to normals, and their gain on a half that was held out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from ....reports.sheets import View
from ...ground.options.option import Option, Reading, Seed
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Group, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class TuneOptions(Reading):
    """Options for `tune`: what to fit, and to which normals."""

    encoding: Annotated[str, Option("ENCODING", "An encoding; `normalbench list encodings` lists all.")] = ""
    normals: Annotated[Names, Option("--normals", "A normal set or a file of normals.", files=True)] = ("playground",)
    storage: Annotated[Names, Option("--storage", "A storage.")] = ("rgba8",)
    parameter: Annotated[
        Names, Option("--parameter", "The encoding's own parameters, or table; comma-separated. Default: all.")
    ] = ("all",)
    error: Annotated[str, Option("--error", "Error to minimise: psnr, rms, mean or max (the largest angle).")] = "psnr"
    count: Annotated[int, Option("--count", "Number of normals in a uniform set.")] = 2**20
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class TuneOutputs:
    """Outputs of `tune` other than its rows."""

    table: Annotated[Path | None, Option("--table", "Write the tuned lookup table to this file as a NumPy array.")] = (
        None
    )


COLUMNS = (
    Column("encoding", "The encoding as published.", KEY),
    Column("storage", "The texel format that the encoding was tuned in.", KEY),
    Column("normals", "The set of normals that the encoding was tuned to.", KEY),
    Column("error", "The error that tuning minimised (or, for psnr, maximised).", KEY),
    Column("fitted_to", "Number of normals used for fitting.", HOW),
    Column("held_out", "Number of normals held out and measured.", HOW),
    shared.CODE_SPACE,
    Column("seed", "The random seed of uniform sets and of the hold-out.", HOW, drops=1),
    Column("tuned_encoding", "The tuned encoding, by a name that --encoding accepts.", HOW),
    Column("quantity", "A parameter, or a figure of the hold-out.", KEY),
    Column("published", "The published value of the quantity."),
    Column("tuned", "The value of the quantity after tuning."),
    Column("gain", "Gain of tuning on the hold-out.", better="more"),
    Column("unit", "Unit of the gain: dB, or percent of an angle.", HOW),
    Column("glsl", "The macro that sets the parameter in GLSL.", HOW, drops=2),
)

TABLE = Table(
    package=__package__ or "",
    group=Group.OWN,
    help="Fit an encoding's parameters to normals.\n\nThe gain is measured on a half of the normals that was held "
    "out.\n\nThe tuned encoding has a name that --encoding accepts in every command, such as "
    "stereographic:scale=1.31.",
    example="normalbench tune stereographic --normals playground --storage rg8",
    options=TuneOptions,
    outputs=TuneOutputs,
    columns=COLUMNS,
    usual=({"encoding": "stereographic"}, {"encoding": "spherical"}, {"encoding": "best_fit"}),
    single={"encoding": "stereographic"},
    in_all=False,
    section=Section(
        title="Gain from tuning",
        short="Tuning",
        view=View.CODECS,
        intro="Parameters are fitted to one half of a set: how much do they gain on the other half?",
        method="Tuning is a search on the measured error, from the published values and from random values. Images "
        "are split into two halves at random, by pixel; for lookup tables, by tiles of 16 x 16. Figures are "
        "for the half that was held out.",
    ),
)
