"""The table of readers' devices: what they make of each codec, next to the run's own codes, and what else they do."""

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
    """Options for which device files are read, and what is shown of them."""

    devices: Annotated[
        Names,
        Option("--devices", "Device files, or folders of them, comma-separated.", files=True, in_run=True),
    ] = ()
    facts: Annotated[
        bool, Option("--facts", "Show how each device rounds, filters, resolves and computes, in place of its codecs.")
    ] = False


COLUMNS = (
    Column("device", "The GPU, by a short name of what the browser calls it.", KEY),
    Column("browser", "The browser and its major version.", KEY),
    Column("row_of", f"What the row is of: a {CODEC}, or a {FACT}.", Role.RAW, shown=False),
    shared.ENCODING,
    shared.STORAGE,
    Column("rounding", "How the stored numbers are rounded.", KEY),
    Column("target", "The format that the browser rendered to.", KEY),
    Column(
        "same_percent",
        "The share of the codes that equal the run's in every bit of the texel.",
        unit="%",
        better="more",
    ),
    Column("one_step", "Codes with one number that is one step away from the run's.", better="less"),
    Column("further", "Codes that differ from the run's by more than that.", better="less"),
    Column(
        "mean_deg",
        "Mean angle between the normal and what the device encodes, stores, reads and decodes.",
        unit="degrees",
        better="less",
    ),
    Column("max_deg", "The largest of those angles.", unit="degrees", better="less"),
    Column("run_mean_deg", "Mean angle of the run's own codes, on the same normals.", unit="degrees", drops=7),
    Column(
        "encode_ms",
        "Milliseconds per megapixel to encode and store, less an empty pass.",
        TIME,
        "ms",
        "less",
        drops=9,
    ),
    Column(
        "decode_ms", "Milliseconds per megapixel to read and decode, less an empty pass.", TIME, "ms", "less", drops=8
    ),
    Column("timer", "What timed it.", HOW, drops=2),
    Column("normals", "How many normals the device encoded.", HOW, drops=10),
    Column("name", "What the fact is about.", KEY, option="facts"),
    Column("value", "What the device does, as text.", HOW, option="facts"),
    Column("number", "The same where it is a number, for gates and comparisons.", option="facts"),
    Column("made", "When the device was saved, in UTC.", HOW, drops=5),
    Column("program", "The version of normalbench whose page measured it.", HOW, drops=6),
    Column("sources", "The fingerprint of the run that the page showed.", HOW, drops=3),
    Column("renderer", "The GPU as the browser calls it.", HOW, drops=1),
    Column("vendor", "The vendor as the browser calls it.", HOW, drops=4),
)

TABLE = Table(
    package=__package__ or "",
    group=Group.KEEP,
    help="Show what readers' devices make of each codec.\n\nWith --facts it shows how they round, filter, resolve "
    'and compute.\n\nA device file is what the live section of a page saves by "Save this device".',
    example="normalbench devices --devices phone.json",
    options=DevicesOptions,
    columns=COLUMNS,
    usual=({}, {"facts": True}),
    by="device",
    in_all=False,
    asked_by="devices",
    section=Section(
        title="Do readers' devices store the same codes?",
        short="Devices",
        intro="Which GPUs store the same codes as this program, which do not, and what else do they do otherwise?",
        method="The live section of a page encoded the same normals on each device, into the formats that the browser "
        "renders to, and compared every code with the run's own, bit for bit. The angles are of what the device "
        "encodes, stores, reads and decodes itself. Times are per megapixel, less an empty pass; the column timer "
        "names the clock. The section also tried how the device rounds, filters, resolves and computes: a fact is what "
        "came out there, not what a specification promises. A file that a reader saved is all that is known of a "
        "device: nothing is measured here.",
        parts="row_of",
    ),
)
