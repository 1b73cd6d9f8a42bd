"""The `import` command: adds device files to a run, all of them or none."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..ground.output.errors import UsageError, tell
from ..ground.output.writing import say
from ..keep.plain import plain
from ..keep.runs import amended, read_run
from ..keep.table_files import write_tables
from ..tables.devices.agreement import many
from ..tables.devices.device_file import DeviceFile, Read, read_device_file
from ..tables.devices.names import told_apart
from ..tables.devices.reading import Device, checked_number, devices, rows_of
from ..tables.devices.table import CODEC, FACT, TABLE
from ..tables.table import Row

# A GPU as a browser names it, and that browser.
Identity = tuple[Any, Any]


def import_command(files: Sequence[Path], folder: Path | None) -> int:
    """Add device files to a run, print a line on each, and return exit status 0. For each GPU and browser, only the
    newest file is kept.

    Raises:
        UsageError: a file is not a device file, the folder is not a run's, or it cannot be written. Nothing is added
            then.
    """
    if folder is None:
        raise UsageError("name the run's folder with -o RUN")
    candidates = devices(read_all(checked_number(list(files))))
    with amended(folder) as run:
        there = {_identity(line): line["key"] for line in run.lines if _is_ours(line)}
        new = [candidate for candidate in candidates if _is_newer(candidate.file, there.get(candidate.file.identity))]
        if new:
            run.replace(_with(run.lines, new))
        # Also where nothing is new: an earlier import may have been ended before it wrote them.
        done = read_run(folder)
        write_tables(folder, done, [TABLE.name] if TABLE.name in done.tables else [])
    names = told_apart(
        [*(str(renderer) for renderer, _ in there), *(candidate.file.renderer for candidate in candidates)]
    )
    for device in candidates:
        called = replace(device, name=names[device.file.renderer]).called
        if device in new and run.sources not in ("", device.file.sources):
            tell(f"{called}: measured on a page of a different version, so its codes may differ from this run's")
        say(f"{called}: {_said(device.file, there.get(device.file.identity))}\n")
    say(f"To write the page with these devices: normalbench report {folder}\n")
    return 0


def read_all(paths: Sequence[Path]) -> list[Read]:
    """Return the contents of device files. If any files are faulty, report all but the last of these on standard
    error, and raise UsageError for the last."""
    reads, wrong = list[Read](), list[UsageError]()
    for path in paths:
        try:
            reads.append(read_device_file(path))
        except UsageError as error:
            wrong.append(error)
    for error in wrong[:-1]:
        tell(str(error))
    if wrong:
        raise wrong[-1]
    return reads


def _is_ours(line: Row) -> bool:
    return line["table"] == TABLE.name and "renderer" in line["key"]


def _identity(line: Row) -> Identity:
    return line["key"]["renderer"], line["key"].get("browser")


def _is_newer(file: DeviceFile, there: Mapping[str, Any] | None) -> bool:
    """Whether a file is newer than the run's file for the same device and browser, or the run has no such file."""
    return there is None or file.made > str(there.get("made"))


def _said(file: DeviceFile, there: Mapping[str, Any] | None) -> str:
    """Return a message on what was done with a file, given the run's file for the same device and browser."""
    what = f"{many(len(file.codecs), 'codec')}, {many(len(file.facts), 'fact')}"
    if there is None:
        return f"added {what}"
    if _is_newer(file, there):
        return f"added {what}, replacing those from {there.get('made')}"
    if file.made < str(there.get("made")):
        return f"nothing added; the run has a newer file, from {there.get('made')}"
    other = "" if file.digest == there.get("digest") else ", with different figures; the run keeps its own"
    return f"nothing added; the run already has the file from {file.made}{other}"


def _with(lines: Sequence[Row], new: Sequence[Device]) -> list[Row]:
    """Return a run's steps with new devices added; they replace older steps for the same device and browser."""
    replaced = {device.file.identity for device in new}
    kept = [line for line in lines if not (_is_ours(line) and _identity(line) in replaced)]
    return list(_renamed([*kept, *(line for device in new for line in _lines(device))]))


def _lines(device: Device) -> Iterator[Row]:
    for row_of in (CODEC, FACT):
        rows = plain([TABLE.empty() | row for row in rows_of(device, row_of)])
        if rows:
            yield {"table": TABLE.name, "key": device.key(row_of), "rows": rows}


def _renamed(lines: Sequence[Row]) -> Iterator[Row]:
    """Yield a run's steps with names that distinguish its devices, because two GPUs may share a short name."""
    names = told_apart(str(line["key"]["renderer"]) for line in lines if _is_ours(line))
    for line in lines:
        if not _is_ours(line):
            yield line
            continue
        device = {"device": names[str(line["key"]["renderer"])]}
        yield line | {"key": line["key"] | device, "rows": [row | device for row in line["rows"]]}
