"""A program that reads image files with OpenImageIO in a separate process.

A crafted file may crash the library, fill the memory or never finish, and the library writes warnings of its own.
The separate process contains all of this. As a program:

    python -m normalbench.bench.subjects.normals.pixel_process header KIND FILE OUT   # a JSON list of the parts
    python -m normalbench.bench.subjects.normals.pixel_process pixels KIND FILE OUT NAME ...   # the channels as NPY

KIND is the library's name for the format. The exit status is 0, or one of FAILURES.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import OpenImageIO as oiio  # noqa: N813 # as its own documentation has it

from ...ground.machine.systems.processes import limit_addresses

MAX_MEMORY = 2**33
DAMAGED = 1
# Words of the library's errors that say more than that a file is damaged, and the status for them.
FAILURES: Mapping[str, int] = MappingProxyType(
    {"Subsampled": 2, " may not exceed ": 3, "exceeds the": 3, " claims a ": 3}
)
# Numbers as they are stored: colour is not multiplied by alpha, and not converted.
AS_STORED = ("oiio:UnassociatedAlpha", "oiio:RawColor")


class UnreadableError(ValueError):
    """The library's own words."""


def opened(kind: str, path: str) -> oiio.ImageInput:
    """Open an image file in a format, without conversion of its values. Raises UnreadableError."""
    wishes = oiio.ImageSpec()
    for wish in AS_STORED:
        wishes.attribute(wish, 1)
    file = oiio.ImageInput.open(path, wishes)
    # Where the format of the name fails, the library tries all others.
    if file is None or file.format_name() != kind:
        raise UnreadableError(oiio.geterror())
    return file


def parts_of(file: oiio.ImageInput) -> list[dict[str, Any]]:
    """Return the header's data on each part, layer or page: its name, size, position, channels and channel types."""
    parts: list[dict[str, Any]] = []
    while file.seek_subimage(len(parts), 0):
        spec = file.spec()
        kinds = [str(kind) for kind in spec.channelformats] or [str(spec.format)] * spec.nchannels
        channels = [(name, channel) for channel, name in enumerate(spec.channelnames)]
        if file.format_name() == "openexr":
            channels.sort()  # as the file has them; the library brings R, G, B and A to the front
        parts.append({"name": spec.get_string_attribute("oiio:subimagename"), "deep": spec.deep, "types": kinds})
        parts[-1] |= {
            "place": [spec.x, spec.y],
            "sides": [spec.width, spec.height, spec.depth],
            "channels": dict(channels),
        }
    return parts


def full_names(parts: list[dict[str, Any]]) -> list[list[str]]:
    """Return unique names for each part's channels. If there are several parts, each name begins with the part's name
    or, from the second unnamed part on, with its number."""
    stems = [part["name"] or (str(number) if number > 1 else "") for number, part in enumerate(parts, 1)]
    if len(parts) == 1:
        stems = [""]
    return [
        [c if not stem or c.startswith(f"{stem}.") else f"{stem}.{c}" for c in part["channels"]]
        for stem, part in zip(stems, parts, strict=True)
    ]


def read_pixels(kind: str, path: str, wanted: list[str]) -> np.ndarray:
    """Return channels by full name, of shape (channels, height, width). Raises UnreadableError if any fails."""
    file = opened(kind, path)
    parts = parts_of(file)
    places = {
        name: (number, part["types"][channel], channel)
        for number, (part, names) in enumerate(zip(parts, full_names(parts), strict=True))
        for name, channel in zip(names, part["channels"].values(), strict=True)
    }
    planes = {}
    # Channels of one part and type are read at once: the library unpacks all of them each time.
    for number, stored in dict.fromkeys(places[name][:2] for name in wanted):
        channels = {name: places[name][2] for name in wanted if places[name][:2] == (number, stored)}
        first = min(channels.values())
        block = file.read_image(number, 0, first, max(channels.values()) + 1, stored)
        if block is None:
            raise UnreadableError(file.geterror())
        planes |= {name: block[..., channel - first] for name, channel in channels.items()}
    return np.stack([planes[name] for name in wanted])


def answer(mode: str, kind: str, path: str, out: Path, names: list[str]) -> None:
    """Write to `out` the parts of a file as JSON if the mode is "header"; otherwise the named channels as NPY."""
    if mode == "header":
        parts = parts_of(opened(kind, path))
        named_parts = [part | {"names": full} for part, full in zip(parts, full_names(parts), strict=True)]
        out.write_text(json.dumps(named_parts), encoding="utf-8", newline="\n")
    else:
        with out.open("wb") as file:
            np.save(file, read_pixels(kind, path, names))


def main() -> int:
    """Write the file that the arguments request and return the exit status."""
    mode, kind, path, out, *names = sys.argv[1:]
    limit_addresses(MAX_MEMORY)
    # Each thread takes address space, and processes beside this one take the cores.
    oiio.attribute("threads", 1)
    try:
        answer(mode, kind, path, Path(out), names)
    except Exception as error:
        return next((status for words, status in FAILURES.items() if words in str(error)), DAMAGED)
    return 0


if __name__ == "__main__":
    sys.exit(main())
