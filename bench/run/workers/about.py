"""Marks of everything that rows depend on besides their keys: processes with the same marks give the same rows."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from types import MappingProxyType

from ...ground.machine.devices import found_device
from ...ground.machine.settings import settings
from ...ground.machine.webgpu import adapters
from ...ground.native import library
from ...ground.output.sources import sources
from ...keep.machine import compilers, processor
from ...tables.table import C_COMPILER, COMPILERS, GL, VULKAN

# What every step needs, whatever else it does.
BASE = "version, sources, settings and processor"
# What figures depend on: workers have the versions of the process that asks.
PACKAGES = ("normalbench", "numpy", "jax", "jaxlib", "moderngl", "scipy", "wgpu", "embreex")


@cache
def marks() -> Mapping[str, str]:
    """Return the marks of this process and of each device or tool with which it can measure, by name. A mark is the
    name and a short hash of everything that figures depend on."""
    texts = {BASE: _base()} | {name: ask() for name, ask in CAN.items()}
    return {name: f"{name} {hashlib.sha256(text.encode()).hexdigest()[:12]}" for name, text in texts.items()}


def marks_of(needs: Iterable[str]) -> frozenset[str]:
    """Return the marks that a process needs to measure in place of this one: the base mark and those for `needs`."""
    return frozenset(marks()[name] for name in (BASE, *needs))


def named(chosen: Iterable[str]) -> str:
    """Return the sorted names in some marks, separated by commas: the devices and tools that the marks describe."""
    return ", ".join(sorted(mark.rpartition(" ")[0] for mark in chosen))


def _base() -> str:
    return "\n".join((*map(_version, PACKAGES), sources(), str(settings()), processor()))


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "none"


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
