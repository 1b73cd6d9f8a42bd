"""The table of facts of readers' devices: how they round, filter and resolve each format, and what else they do."""

from __future__ import annotations

from dataclasses import dataclass

from ..devices.table import BROWSER, DEVICE, MADE, PROGRAM, RENDERER, Devices
from ..table import Column, Group, Role, Section, Table


@dataclass(frozen=True, kw_only=True)
class DeviceFactsOptions:
    """Which device files are read."""

    devices: Devices = ""


COLUMNS = (
    DEVICE,
    BROWSER,
    Column("name", "What the fact is about.", Role.KEY),
    Column("value", "What the device does, as text.", Role.HOW),
    Column("number", "The same where it is a number, for gates and comparisons."),
    MADE,
    PROGRAM,
    RENDERER,
)

TABLE = Table(
    name="device_facts",
    package=__package__ or "",
    group=Group.KEEP,
    help="How readers' devices round, filter and resolve each format, and how exactly they compute.\n\n"
    'A device file is what the live section of a page saves by "Save this device".',
    example="normalbench device_facts --devices phone.json",
    options=DeviceFactsOptions,
    columns=COLUMNS,
    in_all=False,
    asked_by="devices",
    section=Section(
        title="What readers' devices do",
        short="Device facts",
        intro="How does each GPU round, filter and resolve, and how exactly does it compute?",
        method="The live section of a page tried each format on the device. A fact is what came out there, not "
        "what a specification promises.",
    ),
)
