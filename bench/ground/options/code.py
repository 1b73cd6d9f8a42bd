"""The options of `code`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from .option import NAMED, Option, Sources
from .words import Names


@dataclass(frozen=True, kw_only=True)
class CodeOptions(Sources):
    """The codecs to write, and the languages to write them in."""

    codec: Annotated[Names, Option("CODEC", f"Encodings or files, {NAMED}; layouts with --of layout.", files=True)] = (
        "octahedral",
    )
    of: Annotated[
        str,
        Option(
            "--of",
            "Quantity that is encoded: normal, frame (tangent frames and quaternions), motion, curve (roughness and "
            "similar), light or depth; or layout: packing and unpacking a whole G-buffer. Default: given by the names.",
        ),
    ] = ""
    storage: Annotated[
        Names | None, Option("--storage", f"Storages, {NAMED}. Default: rgba8; with --check, those in common use.")
    ] = None
    rounding: Annotated[Names, Option("--rounding", "nearest, truncate, truncate_half; comma-separated, or all.")] = (
        "nearest",
    )
    to: Annotated[Names, Option("--to", "glsl, essl, hlsl, slang, wgsl, msl, c; comma-separated, or all.")] = ("hlsl",)
    prefix: Annotated[
        str,
        Option(
            "--prefix",
            "Prefix of every name. Default: the encoded quantity, such as normal; with several codecs of a "
            "kind, the codecs' names.",
        ),
    ] = ""
    check: Annotated[
        bool, Option("--check", "Run the code and print how it compares with the catalogue; write no code.")
    ] = False
