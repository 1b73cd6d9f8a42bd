"""The page on readers' devices, made from their files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .....reports.page.page import PageTable, table
from .....reports.page.site import (
    Answer,
    DeviceSection,
    Index,
    Searched,
    Site,
    index_html,
    plain_names,
    words_table,
)
from ...table import Row, Sheet
from ..agreement import (
    codec_name,
    codec_of,
    device_of,
    difference,
    differs,
    fastest,
    overview,
    sentences,
    time_of,
)
from ..reading import Device, codec_rows, fact_rows
from ..table import TABLE
from .answers import Known, answers

INDEX, FOLDER = "index.html", "devices"
# A site of nothing but devices.
ALONE = Site({INDEX: "All devices"}, INDEX)
# What a device's tables leave to its heading and its facts.
OF_DEVICE = ("device", "browser", "row_of", "made", "program", "sources", "renderer", "vendor")
# The columns of the index that no table has.
INDEXED = {
    "agree": "Codecs with all codes equal to the run's codes.",
    "differ": "Codecs with a code that differs from the run's code.",
    "further": "Codecs with a code more than one step from the run's code.",
    "least_same_percent": "The lowest share of codes that equal the run's codes. Unit: %.",
    "differs_most": "The codec with the lowest share of equal codes.",
    "fastest": "The codec that takes the least time to encode and decode.",
    "fastest_ms": "The lowest time to encode and decode, in milliseconds per megapixel.",
    "devices": "How many devices measured the codec.",
    "differs_on": "The devices that store a different code.",
    "fastest_on": "The device that encodes and decodes the codec in the least time.",
}


@dataclass(frozen=True)
class Entry:
    """A device and the contents of its section."""

    device: Device
    key: str
    rows: Sequence[Row]
    answers: Sequence[Sheet]

    @property
    def words(self) -> str:
        """The search terms for the device, in addition to the cells of its row, separated by spaces."""
        known = (str(row[name]) for row in self.rows for name in ("encoding", "storage", "target"))
        return " ".join(dict.fromkeys([*known, self.device.file.renderer, self.device.file.vendor]))


def pages(devices: Sequence[Device], site: Site = ALONE) -> dict[str, str]:
    """Return a dict from the path of the devices page in the site's folder to its HTML."""
    rows = [codec_rows(device) for device in devices]
    keys = (f"device-{name}" for name in plain_names((device.called for device in devices), "one"))
    known = Known(rows)
    entries = [
        Entry(device, key, own, list(answers(own, known))) for device, key, own in zip(devices, keys, rows, strict=True)
    ]
    return {site.devices: index_html(_index(entries, site), site)}


def _device_section(entry: Entry) -> DeviceSection:
    device, file = entry.device, entry.device.file
    about = {"GPU": file.renderer, "vendor": file.vendor, "browser": file.browser, "saved": file.made}
    about |= {"normalbench": file.program, "fingerprint of the run": file.sources}
    known = {name: text for name, text in about.items() if text}
    codecs = [_row_without(row, OF_DEVICE) for row in entry.rows]
    facts = [{"name": row["name"], "value": row["value"]} for row in fact_rows(device)]
    tables = [_shown_table(f"Every codec on {device.called}", codecs)]
    tables += [_shown_table(f"Facts about {device.called}", facts)] if facts else []
    answered = [Answer((*sheet.said, *sheet.aside), _front_table(sheet, device.called)) for sheet in entry.answers]
    sentence = f"{device.called} {difference(entry.rows)}."
    return DeviceSection(device.called, entry.key, sentence, known, answered, tables)


def _front_table(sheet: Sheet, device: str) -> PageTable:
    """Return the table of the Pareto-optimal encodings in an answer; an empty table if no encoding qualifies."""
    title = f"{device}, {sheet.title}"
    return table(title, sheet.rows, lambda _: "") if sheet.rows else PageTable(title, [], [], "")


def _row_without(row: Row, names: Sequence[str]) -> Row:
    return {name: value for name, value in row.items() if name not in names}


def _shown_table(title: str, rows: Sequence[Row]) -> PageTable:
    """Return rows as a page table, in the column order of the devices table and with its column definitions."""

    def says(name: str) -> str:
        column = TABLE.column(name)
        return column.definition if column else ""

    order = [column.name for column in TABLE.columns if column.name in rows[0]]
    return table(title, [{name: row[name] for name in order} for row in rows], says)


def _index(entries: Sequence[Entry], site: Site) -> Index:
    rows = [row for entry in entries for row in entry.rows]
    return Index(
        path=site.devices,
        title="readers' devices",
        description="Which GPUs and browsers store the same codes of normals as the run, and which encoding to use "
        "on each.",
        question="Which devices store the same codes?",
        said=sentences(rows) if rows else ("There are no devices yet.",),
        label="Search by device, codec or storage",
        searched=[_device_list(entries), _codec_list(rows), _taken_list(entries)] if entries else [],
        devices=[_device_section(entry) for entry in entries],
        measures=bool(site.laboratory),
    )


def _table(title: str, rows: Sequence[Row]) -> PageTable:
    return table(title, rows, lambda name: INDEXED.get(name, ""))


def _device_list(entries: Sequence[Entry]) -> Searched:
    rows = [{"device": e.device.called} | _row_without(overview(e.rows)[0], ("device", "browser")) for e in entries]
    intro = "One row per GPU and browser. Its name links to its codecs and facts below."
    words, links = [entry.words for entry in entries], [f"#{entry.key}" for entry in entries]
    return Searched("devices", "Devices", intro, _table("Agreement by device", rows), words, links)


def _codec_list(rows: Sequence[Row]) -> Searched:
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(codec_of(row), []).append(row)
    words = [" ".join([*map(device_of, group), group[0]["storage"], group[0]["target"]]) for group in groups.values()]
    intro = "One row per codec and target: the devices on which its codes differ from the run's codes."
    return Searched(
        "codecs", "Codecs", intro, _table("Agreement by codec", [_codec_row(g) for g in groups.values()]), words
    )


def _codec_row(rows: Sequence[Row]) -> Row:
    first, off, quick = rows[0], [device_of(row) for row in rows if differs(row)], fastest(rows)
    about = {"codec": codec_name(first), "rounding": first["rounding"], "target": first["target"]}
    about |= {"devices": len(rows), "agree": len(rows) - len(off), "differs_on": "; ".join(off) or None}
    about |= {"least_same_percent": min(row["same_percent"] for row in rows)}
    return about | {"fastest_on": device_of(quick) if quick else None, "fastest_ms": time_of(quick) if quick else None}


def _taken_list(entries: Sequence[Entry]) -> Searched:
    """Return the searchable list of recommended encodings, with a row per device and a column per storage."""
    titles = dict.fromkeys(_column_name(sheet) for entry in entries for sheet in entry.answers)
    rows = [{"device": e.device.called} | {**dict.fromkeys(titles), **_codecs_taken_on(e)} for e in entries]
    intro = "The encoding that pick recommends for each storage, from errors measured on the device."
    words, links = [entry.words for entry in entries], [f"#{entry.key}" for entry in entries]
    shown = words_table("Recommended encoding, by device and storage", rows)
    return Searched("take", "Recommendations", intro, shown, words, links)


def _column_name(sheet: Sheet) -> str:
    """Return the column heading for a sheet's storage, with "in", because a reader's own storage may be called
    "device"."""
    return f"in {sheet.keys['storage']}"


def _codecs_taken_on(entry: Entry) -> Mapping[str, Any]:
    taken: dict[str, Any] = {}
    for sheet in entry.answers:
        taken.setdefault(_column_name(sheet), sheet.keys["take"])
    return taken
