"""Installation advice, command lines, and the API through which wgpu accesses a GPU, for each system."""

from __future__ import annotations

import shlex
import subprocess
import sys
from collections.abc import Iterable

# By Debian's name of what is missing.
if sys.platform == "win32":
    SDK = "winget install KhronosGroup.VulkanSDK"
    ELSEWHERE = "only on Linux, including WSL2"
    _WAYS = {
        "glslang-tools": SDK,
        "spirv-tools": SDK,
        "spirv-cross": SDK,
        "mesa-vulkan-drivers": "the driver of the GPU's vendor",
        "gcc": "MSYS2: pacman -S mingw-w64-ucrt-x86_64-gcc",
    }
elif sys.platform == "darwin":
    ELSEWHERE = "only on Linux"
    _WAYS = {
        "glslang-tools": "brew install glslang",
        "spirv-tools": "brew install spirv-tools",
        "spirv-cross": "brew install spirv-cross",
        "gcc": "xcode-select --install",
        "mesa-vulkan-drivers": "part of macOS, if there is a GPU",
    }
else:
    ELSEWHERE, _WAYS = "", {}


def how_to_install(packages: str, counts: bool = False) -> str:
    """Return text on how to install packages here, such as "Debian: apt-get install mesa".

    Args:
        packages: names of Debian packages, separated by spaces; the first is missing and needs the others.
        counts: whether the package is needed to count instructions, which only Linux can do.
    """
    way = ELSEWHERE if counts else _WAYS.get(packages.split()[0], ELSEWHERE)
    return way or f"Debian: apt-get install {packages}"


def command_line(words: Iterable[str]) -> str:
    """Return the words of a command as one line that this system's shell splits into the same words."""
    return subprocess.list2cmdline(words) if sys.platform == "win32" else shlex.join(words)


# The last OpenGL of a system whose OpenGL ends before compute shaders.
LAST_OPENGL = "4.1" if sys.platform == "darwin" else ""


def webgpu_api() -> str:
    """Return the name of the GPU API that wgpu uses here."""
    return "Metal" if sys.platform == "darwin" else "Vulkan"
