"""What `site` does: a folder of device files becomes a static site."""

from __future__ import annotations

import os
from pathlib import Path

from ....ground.output.errors import UsageError, tell
from ....ground.output.writing import say
from ..agreement import many
from ..device_file import Read, read_device_file
from ..reading import SAVED, checked_number, devices
from .files import write_site
from .pages import INDEX, pages


def site_command(folder: Path, output: Path) -> int:
    """Write the site of the device files in a folder and its folders.

    Returns:
        the exit status: 1 where a file was left out because something is wrong with it.

    Raises:
        UsageError: there is no device file, or the site cannot be written.
    """
    paths = checked_number(_files_in(folder))
    found, wrong = _device_files(paths)
    if not found:
        raise UsageError(f"{folder}: there is no device file in it; {SAVED}")
    shown = devices(found)
    write_site(output, pages(shown))
    say(f"{output / INDEX}: {many(len(shown), 'device')}\n")
    return int(wrong > 0)


def _files_in(folder: Path) -> list[Path]:
    """Every *.json in a folder and its folders. Raises UsageError."""
    if not folder.is_dir():
        raise UsageError(f"{folder}: there is no such folder" if not folder.exists() else f"{folder} is not a folder")
    found = [Path(root) / name for root, _, names in os.walk(folder) for name in names if name.endswith(".json")]
    # A site may lie among them, with its marker.
    return sorted(path for path in found if not path.name.startswith("."))


def _device_files(paths: list[Path]) -> tuple[list[Read], int]:
    """The files that are devices', and how many are not, each of which is told."""
    found, wrong = [], 0
    for path in paths:
        try:
            found.append(read_device_file(path))
        except UsageError as error:
            wrong += 1
            tell(f"{error}; it is left out")
    return found, wrong
