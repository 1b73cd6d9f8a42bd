"""Reading of device files: the files by name, each combination of device and browser once, and their rows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...ground.choose import names_a_folder
from ...ground.options.words import Names
from ...ground.output.errors import UsageError, tell
from ..table import Row, Step
from .device_file import CodecRow, DeviceFile, Read, file_of_rows, read_device_file
from .names import browser_name, told_apart
from .table import CODEC, FACT

MOST_FILES = 2048
SAVED = 'to save one, use "Save this device" in the live section of a page'


@dataclass(frozen=True)
class Device:
    """A device's file, and the name of the device as rows show it."""

    name: str
    file: DeviceFile

    @property
    def browser(self) -> str:
        return browser_name(self.file.browser)

    @property
    def called(self) -> str:
        """The device and its browser in words, for sentences."""
        return called(self.name, self.browser)

    def key(self, row_of: str) -> Row:
        """Return the columns that identify the device's rows of one kind, CODEC or FACT."""
        file = self.file
        known = {"renderer": file.renderer, "browser": self.browser, "made": file.made, "digest": file.digest}
        return {"device": self.name, "row_of": row_of, **known}


def called(device: Any, browser: Any) -> str:
    """Return the names of a device and its browser, with a comma between them."""
    return f"{device}, {browser}"


def files_named(words: Names) -> list[Path]:
    """Return the paths of the device files that words name; a folder stands for its *.json files.

    Raises:
        UsageError: no file is named, a folder contains no *.json file, or there are too many files.
    """
    paths: dict[Path, None] = {}
    for word in map(str, words):
        paths |= dict.fromkeys(_folder_files(Path(word)) if names_a_folder(word) else [Path(word)])
    if not paths:
        raise UsageError(f"--devices: no device file named; name files, or a folder of them; {SAVED}")
    return checked_number(list(paths))


def _folder_files(folder: Path) -> list[Path]:
    try:
        paths = sorted(folder.glob("*.json"))
    except OSError as error:
        raise UsageError(f"{folder}: cannot be read: {error.strerror or error}") from None
    if not paths:
        raise UsageError(f"{folder}: no *.json files here; {SAVED}")
    return paths


def checked_number(paths: list[Path]) -> list[Path]:
    """Return the paths unchanged. Raises UsageError if there are more than MOST_FILES."""
    if len(paths) > MOST_FILES:
        raise UsageError(f"--devices: {len(paths)} device files are too many; name at most {MOST_FILES}")
    return paths


def devices(read_files: Iterable[Read]) -> list[Device]:
    """Return a device for each GPU and browser, from its newest file; older files are named on standard error."""
    newest: dict[tuple[str, str], Read] = {}
    for read in read_files:
        other = newest.setdefault(read.file.identity, read)
        if other is not read:
            kept, dropped = (read, other) if read.file.made > other.file.made else (other, read)
            newest[read.file.identity] = kept
            tell(f"left out: {dropped.path}: {kept.path} is from the same device and browser and at least as recent")
    return named([read.file for read in newest.values()])


def reads_of_rows(rows: Iterable[Row], path: Path) -> list[Read]:
    """Return the device files from which a run's rows came, all with this path. A device whose rows form no valid
    file is left out and named on standard error."""
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault((row.get("device"), row.get("renderer"), row.get("browser")), []).append(row)
    reads = []
    for (device, _, browser), part in groups.items():
        try:
            reads.append(Read(path, _file_of(part)))
        except (KeyError, TypeError, ValueError) as error:
            tell(f"left out: {called(device, browser)} in {path}: {error}")
    return reads


def _file_of(rows: Sequence[Row]) -> DeviceFile:
    facts = [row for row in rows if row.get("row_of") == FACT]
    values = {row["name"]: row["value"] if row["number"] is None else row["number"] for row in facts}
    return file_of_rows([row for row in rows if row.get("row_of") != FACT], values)


def named(files: Sequence[DeviceFile]) -> list[Device]:
    """Return a device for each file, with a short name that no other GPU has."""
    names = told_apart(file.renderer for file in files)
    return [Device(names[file.renderer], file) for file in files]


def steps_of(words: Names, is_of_facts: bool) -> list[Step]:
    """Return a step for each device in the named files, which yields its facts or its codecs. Raises UsageError for a
    file that cannot be read or is not a device file."""
    reads = devices(read_device_file(path) for path in files_named(words))
    row_of = FACT if is_of_facts else CODEC
    return [Step(device.key(row_of), (device, row_of), device.called) for device in reads]


def rows_of(device: Device, row_of: str) -> list[Row]:
    """Return the rows on a device: on its facts if `row_of` is FACT, otherwise on its codecs."""
    return fact_rows(device) if row_of == FACT else codec_rows(device)


def codec_rows(device: Device) -> list[Row]:
    """Return a row of the devices table for each codec in a device's file."""
    return [_device_row(device, CODEC) | _codec_row(row) for row in device.file.codecs]


def _codec_row(row: CodecRow) -> Row:
    columns = row.model_dump(exclude={"equal"})
    # A clock that was not read has no name.
    timer = row.timer if row.encode_ms is not None or row.decode_ms is not None else None
    return columns | {"same_percent": 100 * row.equal / row.normals, "timer": timer or None}


def fact_rows(device: Device) -> list[Row]:
    """Return a row for each fact in a device's file: `value` as text, and `number` unless the value is text."""
    return [
        _device_row(device, FACT)
        | {"name": name, "value": str(value), "number": None if isinstance(value, str) else value}
        for name, value in device.file.facts.items()
    ]


def _device_row(device: Device, row_of: str) -> Row:
    file = device.file
    about = {"device": device.name, "browser": device.browser, "row_of": row_of, "renderer": file.renderer}
    return about | {"vendor": file.vendor, "made": file.made, "program": file.program, "sources": file.sources}


def newest(rows: Sequence[Row], keys: Sequence[str]) -> list[Row]:
    """Return the newest row for each combination of `keys`; a run may also contain rows from an older file."""
    latest: dict[tuple[Any, ...], Row] = {}
    for row in rows:
        key = tuple(row.get(name) for name in keys)
        if key not in latest or str(row.get("made")) >= str(latest[key].get("made")):
            latest[key] = row
    return list(latest.values())
