"""Where Mesa's r600 is on this machine, and what has a process load it for a GPU that is not there."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from ....ground.machine.systems.people import how_to_install
from ....ground.machine.systems.preload import preloaded
from .. import null_device

SOURCE = Path(__file__).with_name("null_radeon.c")
SAID = "NORMALBENCH_NULL_RADEON"
DRIVER = "r600_dri.so"
NO_DRIVER = f"no r600: {DRIVER} is not installed; install Mesa's ({how_to_install('libgl1-mesa-dri libegl1')})"
# Where distributions put Mesa's GL drivers.
FOLDERS = ("/usr/lib/{machine}-linux-gnu/dri", "/usr/lib64/dri", "/usr/lib/dri")


@cache
def driver_file() -> Path | None:
    """The driver, or None where there is none."""
    return next((folder / DRIVER for folder in _driver_folders() if (folder / DRIVER).exists()), None)


def _driver_folders() -> Iterator[Path]:
    yield from map(Path, filter(None, os.environ.get("LIBGL_DRIVERS_PATH", "").split(os.pathsep)))
    yield from (Path(folder.format(machine=platform.machine())) for folder in FOLDERS)


def variables(words: str) -> dict[str, str]:
    """What has r600 compile for the GPU of a PCI device, and print what it makes. Raises NullDeviceError.

    The kernels are GLSL 4.30, which r600 has for the newer chips alone. Those before differ in what they lack: storage
    buffers and images, which a fragment kernel does without.
    """
    told = preloaded(null_device.library(SOURCE)) | {SAID: words, "R600_DEBUG": "ps"}
    return told | {"MESA_GL_VERSION_OVERRIDE": "4.3", "MESA_GLSL_VERSION_OVERRIDE": "430"}
