"""Where a user's own build of Mesa is, and what has its drivers find a GPU that is not there."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from ....ground.machine.systems.preload import preloaded
from ....ground.output import cache as kept
from .. import null_device

SOURCE = Path(__file__).with_name("null_mobile.c")
SAID = "NORMALBENCH_NULL_MOBILE"
# A folder that `python -m tests.build_mesa` was given, where it is not the last one.
VARIABLE = "NORMALBENCH_MESA"
BUILD = "build"
# The file of the cache that names the last build.
RECORD = "mesa"
INSTALL = "build it once, in a checkout of normalbench (python -m tests.build_mesa DIR)"


def folder() -> Path | None:
    """The folder with the user's build; None where there is none."""
    named = os.environ.get(VARIABLE) or _recorded_text()
    return Path(named).expanduser() if named else None


def record(where: Path) -> None:
    """Remembers a build for later commands."""
    kept.make_folder(kept.folder())
    (kept.folder() / RECORD).write_text(f"{where.resolve()}\n", encoding="utf-8", newline="\n")


def _recorded_text() -> str:
    record = kept.folder() / RECORD
    return record.read_text(encoding="utf-8").strip() if kept.is_private(record) else ""


def descriptions() -> Iterator[Path]:
    """The descriptions for the Vulkan loader that the build has of its drivers, where they are built."""
    found = folder()
    yield from descriptions_in(found) if found else ()


def descriptions_in(where: Path) -> list[Path]:
    """The descriptions of a build's drivers."""
    return sorted((where / BUILD / "src").glob("*/vulkan/*_devenv_icd.*.json"))


def variables(words: str) -> dict[str, str]:
    """What has a driver compile for the GPU that the words describe. Raises NullDeviceError."""
    return preloaded(null_device.library(SOURCE)) | {SAID: words}
