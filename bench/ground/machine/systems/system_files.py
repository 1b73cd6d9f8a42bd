"""Facts about this machine and this process that Linux provides in files; empty if the files are missing."""

from __future__ import annotations

import platform
from pathlib import Path

PROCESSOR = Path("/proc/cpuinfo")
LOADED = Path("/proc/self/maps")


def processor_lines() -> list[str]:
    """Return the lines about each core in /proc/cpuinfo, as `name : value`; empty if the file is missing."""
    return _lines(PROCESSOR)


def processor_kind() -> list[str]:
    """Return facts, as text, that distinguish this kind of processor from kinds that need different compiled
    programs."""
    facts = {line for line in processor_lines() if line.startswith(("model name", "flags", "Features"))}
    return [platform.machine(), platform.processor(), *sorted(facts)]


def loaded() -> set[str]:
    """Return the paths of the files that are mapped into this process, such as libraries; empty except on Linux."""
    return {line[line.index("/") :] for line in _lines(LOADED) if "/" in line}


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return []
