"""What a process says of itself: versions and sources, and what it can measure with."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from types import MappingProxyType
from typing import Any

from ...ground.machine.devices import found_device
from ...ground.machine.systems.system_files import boot
from ...ground.machine.webgpu import adapters
from ...ground.native import library
from ...ground.output.sources import sources
from ...keep.machine import compilers, processor
from ...tables.table import C_COMPILER, COMPILERS, GL, VULKAN

# What figures depend on: workers have the versions of the process that asks.
PACKAGES = ("normalbench", "numpy", "jax", "jaxlib", "moderngl", "scipy", "wgpu", "embreex", "flip-evaluator")

About = dict[str, Any]


@cache
def about() -> About:
    """This process: `versions`, `sources`, `processor`, `host`, and in `can` what each device or tool is.

    Two processes whose values are the same give the same rows.
    """
    return {
        "versions": {package: _version(package) for package in PACKAGES},
        "sources": sources(),
        "processor": processor(),
        "host": _host(),
        "name": f"{socket.gethostname()}:{os.getpid()}",
        "can": {name: ask() for name, ask in CAN.items()},
    }


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "none"


def _host() -> str:
    # Containers of one machine share its cores, whatever they are called.
    return boot() or socket.gethostname()


def _gl() -> str:
    device, missing = found_device()
    return f"{device.renderer}, {device.version}" if device else missing


def _vulkan() -> str:
    try:
        return ", ".join(str(adapter.info["device"]) for adapter in adapters()) or "none"
    except ImportError:
        return "none"


def _compilers() -> str:
    return "; ".join(f"{name}: {what}" for name, what in compilers().items())


def _c_compiler() -> str:
    return library.compiler() or "none"


CAN: Mapping[str, Callable[[], str]] = MappingProxyType(
    {GL: _gl, VULKAN: _vulkan, COMPILERS: _compilers, C_COMPILER: _c_compiler}
)
