"""The table of readers' devices: each codec's results compared with the run's codes, and facts about the devices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import Option, Options
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Group, Role, Section, Table

KEY, HOW, TIME = Role.KEY, Role.HOW, Role.TIME
# What a row is of.
CODEC, FACT = "codec", "fact"


@dataclass(frozen=True, kw_only=True)
class DevicesOptions(Options):
    """Options for `devices`: the device files to read, and whether to show codecs or facts."""

    devices: Annotated[
        Names,
        Option("--devices", "Device files, or folders of them, comma-separated.", files=True, in_run=True),
    ] = ()
    facts: Annotated[
        bool, Option("--facts", "Show how each device rounds, filters, resolves and computes, instead of its codecs.")
    ] = False


COLUMNS = (
    Column("device", "A short name of the GPU, from the browser's name for it.", KEY),
    Column("browser", "The browser and its major version.", KEY),
    Column("row_of", f"Subject of the row: a {CODEC} or a {FACT}.", Role.RAW, shown=False),
    shared.ENCODING,
    shared.STORAGE,
    Column("rounding", "How the stored numbers are rounded.", KEY),
    Column("target", "The format that the browser rendered to.", KEY),
    Column(
        "same_percent",
        "The share of the codes that equal the run's codes in every bit of the texel.",
        unit="%",
        better="more",
    ),
    Column("one_step", "Codes that differ from the run's by one step in one component.", better="less"),
    Column("further", "Codes that differ from the run's codes by more than one step.", better="less"),
    Column(
        "mean_deg",
        "Mean angle between the normal and the device's decode, encoded and stored on the device.",
        unit="degrees",
        better="less",
    ),
    Column("max_deg", "Largest angle between the normal and the device's decode.", unit="degrees", better="less"),
    Column("run_mean_deg", "Mean angle of the run's own codes, on the same normals.", unit="degrees", drops=7),
    Column(
        "encode_ms",
        "Milliseconds per megapixel to encode and store, minus an empty pass.",
        TIME,
        "ms",
        "less",
        drops=9,
    ),
    Column(
        "decode_ms", "Milliseconds per megapixel to read and decode, minus an empty pass.", TIME, "ms", "less", drops=8
    ),
    Column("timer", "Clock that measured the time.", HOW, drops=2),
    Column("normals", "How many normals the device encoded.", HOW, drops=10),
    Column("name", "The subject of the fact.", KEY, option="facts"),
    Column("value", "Result on the device, as text.", HOW, option="facts"),
    Column("number", "`value` as a number, for gates and comparisons; empty if it is text.", option="facts"),
    Column("made", "When the device was saved, in UTC.", HOW, drops=5),
    Column("program", "The version of normalbench that generated the page.", HOW, drops=6),
    Column("sources", "The fingerprint of the run on the page.", HOW, drops=3),
    Column("renderer", "The name of the GPU, as the browser reports it.", HOW, drops=1),
    Column("vendor", "The vendor of the GPU, as the browser reports it.", HOW, drops=4),
)

TABLE = Table(
    package=__package__ or "",
    group=Group.KEEP,
    help="Show how readers' devices encode and decode normals with each codec.\n\n"
    "With --facts it shows how devices round, "
    'filter, resolve and compute.\n\nA device file is saved by "Save this device" in the live section of a page.',
    example="normalbench devices --devices phone.json",
    options=DevicesOptions,
    columns=COLUMNS,
    usual=({}, {"facts": True}),
    by="device",
    in_all=False,
    asked_by="devices",
    section=Section(
        title="Agreement of devices",
        short="Devices",
        intro="Which GPUs store the same codes as this program, which do not, and how else do they differ?",
        method="The live section of a page encoded the same normals on each device, into the formats that the "
        "browser renders to, and compared every code with the run's code, bit for bit. The device itself "
        "encoded, stored, read and decoded the normals for the angles. Times are per megapixel, minus an "
        "empty pass; the column timer names the clock. The section also tested how the device rounds, "
        "filters, resolves and computes: a fact is the result of such a test, not what a specification "
        "promises. All figures are from the files that readers saved; nothing is measured here.",
        parts="row_of",
    ),
)
