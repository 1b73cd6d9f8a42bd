"""The paths of Mesa's drivers on this machine, and an environment in which they compile with default settings."""

from __future__ import annotations

import json
import os
import platform
import tempfile
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from ...ground.machine import children
from ...ground.machine.systems.people import how_to_install
from ...ground.options.gpu_families import RADV, TITLES

# What would have a driver compile in another way, or the loader load something else; the session's other variables
# stay.
UNWANTED = ("RADV_", "ACO_", "AMD_", "ANV_", "INTEL_", "NIR_", "MESA_", "VK_", "NORMALBENCH_NULL_")


def no_driver(library: str) -> str:
    """Return a message that no manifest of a Vulkan driver was found, with what to install."""
    message = f"no {TITLES[library]}: no Vulkan driver file names {library}"
    return f"{message}; install Mesa's ({how_to_install('mesa-vulkan-drivers', counts=True)})"


@cache
def driver_file(library: str = RADV) -> Path | None:
    """Return the path of a driver's manifest for the Vulkan loader, preferably one for this machine's processor; None
    if no manifest is found."""
    paths = [path for path in _descriptions() if _library(path) == library]
    # A machine may have the driver for several architectures; the file's name says for which, if anything does.
    return next((path for path in paths if platform.machine() in path.name), paths[0] if paths else None)


def _descriptions() -> Iterator[Path]:
    """Yield the paths of the driver manifests that the Vulkan loader would read, with its variables' paths first."""
    for variable in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES"):
        yield from map(Path, filter(None, os.environ.get(variable, "").split(os.pathsep)))
    data = os.environ.get("XDG_DATA_DIRS") or "/usr/local/share:/usr/share"
    for root in ("~/.local/share", "/etc", *data.split(os.pathsep)):
        yield from sorted(Path(root).expanduser().glob("vulkan/icd.d/*.json"))


def _library(path: Path) -> str:
    """Return the name of the library in a driver's manifest, without folder and extension; empty on failure."""
    try:
        return Path(str(json.loads(path.read_text(encoding="utf-8"))["ICD"]["library_path"])).name.split(".")[0]
    except (OSError, ValueError, KeyError, TypeError):
        return ""


def environment(path: Path, variables: Mapping[str, str]) -> dict[str, str]:
    """Return a process environment in which the Vulkan loader finds only the driver with this manifest; `variables`,
    which choose the driver's GPU, are added."""
    usual = {key: value for key, value in children.environment().items() if not key.startswith(UNWANTED)}
    driver = {"VK_ICD_FILENAMES": str(path), "VK_DRIVER_FILES": str(path), "VK_LOADER_LAYERS_DISABLE": "~all~"}
    # Mesa's own cache answers without compiling; the loader asks for a folder of the session's.
    usual = {"XDG_RUNTIME_DIR": tempfile.gettempdir(), **usual, **driver, "MESA_SHADER_CACHE_DISABLE": "true"}
    return usual | dict(variables)
