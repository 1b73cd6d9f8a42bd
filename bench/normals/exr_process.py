"""Reads EXR files in a process of its own.

The library writes warnings of its own to both outputs, and drops a part that is cut off without an error; whatever a
damaged file does to it stays here. Run as a script, not imported:

    python exr_process.py header FILE OUT            # a JSON list of the parts
    python exr_process.py pixels FILE OUT NAME ...   # an NPZ file of the channels, in that order

The status is 1 where it cannot be read.
"""

from __future__ import annotations

import json
import resource
import sys
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR

MAX_MEMORY = 2**33


def parts_of(file: Any) -> list[dict[str, Any]]:
    """What the header says of each part: its name, kind, window and channels."""
    found = []
    for part in file.parts:
        low, high = (list(map(int, corner)) for corner in part.header["dataWindow"])
        sampled = [c.name for c in part.header["channels"] if (c.xSampling, c.ySampling) != (1, 1)]
        names = [c.name for c in part.header["channels"]]
        kind = str(part.header.get("type", ""))
        found.append({"name": part.header.get("name") or "", "kind": kind, "low": low, "high": high})
        found[-1] |= {"channels": names, "subsampled": sampled}
    return found


def full_names(parts: list[dict[str, Any]]) -> list[list[str]]:
    """Each part's channels by names that differ: a part's name comes first where there are several parts."""
    several = len(parts) > 1
    return [
        [
            c if not several or not p["name"] or c.startswith(f"{p['name']}.") else f"{p['name']}.{c}"
            for c in p["channels"]
        ]
        for p in parts
    ]


def read_pixels(path: str, wanted: list[str]) -> list[np.ndarray]:
    """Channels by their full names, each (height, width). Raises ValueError where one cannot be read."""
    with OpenEXR.File(path, header_only=True) as file:
        names = full_names(parts_of(file))
    with OpenEXR.File(path, separate_channels=True) as file:
        # Strict: of a part that is cut off nothing is left.
        planes = {
            name: part.channels[channel].pixels
            for part, full in zip(file.parts, names, strict=True)
            for name, channel in zip(full, (c.name for c in part.header["channels"]), strict=True)
        }
    return [np.array(planes[name]) for name in wanted]


def main() -> int:
    """Do what the arguments say. Exit status: 0 well, 1 the file cannot be read."""
    mode, path, out, *names = sys.argv[1:]
    resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))
    try:
        if mode == "header":
            with OpenEXR.File(path, header_only=True) as file:
                parts = parts_of(file)
            found = [part | {"names": full} for part, full in zip(parts, full_names(parts), strict=True)]
            Path(out).write_text(json.dumps(found), encoding="utf-8")
        else:
            with Path(out).open("wb") as file:
                np.savez(file, *read_pixels(path, names))
    except Exception:  # whatever the library makes of a damaged file
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
