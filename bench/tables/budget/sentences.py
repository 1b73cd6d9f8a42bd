"""What a budget says, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

from ..table import Row
from .bins import WEBGPU_BYTES
from .readers import times
from .table import IMPROVED, PROPOSAL

# FLIP's 99th percentile that we call invisible, and acceptable: both are conventions (see `roughness`).
INVISIBLE, ACCEPTABLE = 0.05, 0.1
# Codes as a sentence says them.
WORDS = {
    "base_color": "base colour",
    "f0": "F0",
    "ao": "AO",
    "square_root": "by its root",
    "linear": "",
    "shading_model": "shading model",
}
# What free bytes may hold: how many it takes, a word of layouts that have it, and what it is.
FREE_FOR = ((4, "emissive", "emissive light"), (2, "coat", "a clear coat"), (2, "anisotropy", "anisotropy"))
# Shares of an error that a sentence names.
NAMED = 3


def told(row: Row) -> Iterator[str]:
    """What to take for a limit, what is seen of it, where its error comes from, and what the next bytes bring."""
    if row["skipped"]:
        yield f"{row['skipped'].rstrip('.')}."
        return
    yield f"{_subject(row)}: {_answer(row)}{_free(row)}"
    yield _codes(row)
    yield _errors(row)
    yield _rules(row)
    yield _price(row)


def _subject(row: Row) -> str:
    if row["kind"] == IMPROVED:
        return f"The same attributes in the same formats, {row['layout']}"
    return f"{row['limit']} bytes a pixel"


def _answer(row: Row) -> str:
    """What to take, and what is seen of it."""
    formats = " + ".join(target.partition(":")[0] for target in row["targets"].split("; "))
    fewer = f" ({row['bytes_per_pixel']} bytes)" if row["bytes_per_pixel"] != row["limit"] else ""
    return f"take {formats}{fewer}. {_seen(row['flip_p99'])}the worst surfaces have {row['worst_db']:.1f} dB."


def _free(row: Row) -> str:
    """What the bytes that a limit leaves may hold, of what the layout does not."""
    free = (row["limit"] or 0) - row["bytes_per_pixel"] if row["kind"] == PROPOSAL else 0
    uses = [use for size, word, use in FREE_FOR if size <= free and word not in row["targets"]]
    which = f": for {' or '.join(uses)}" if uses else ""
    return f" More bring nothing that shows; {free:g} stay free{which}." if free >= 1 else ""


def _seen(flip: float) -> str:
    if flip <= INVISIBLE:
        return "Its errors are not seen in a still picture; "
    return f"Its errors are seen{' side by side' if flip <= ACCEPTABLE else ''}; "


def _codes(row: Row) -> str:
    codes = [_code(one) for one in row["codes"].split("; ") if not one.startswith("other ")]
    rest = ", and the other bits as they are" if "; other " in row["codes"] and row["kind"] == IMPROVED else ""
    return f"The codes are {', '.join(codes)}{rest}."


def _code(text: str) -> str:
    """A code in words: base colour by its root 7:7:6."""
    return " ".join(filter(None, (WORDS.get(word, word) for word in text.split())))


def _errors(row: Row) -> str:
    scene, _, name = row["worst_class"].rpartition(" ")
    said = [f"Worst are {name} surfaces of {scene}, {row['worst_db']:.1f} dB; the frame has {row['psnr_db']:.1f} dB."]
    if "," in row["scene"] and row["held_back_db"] is not None:
        said.append(f"Scenes that did not choose it have {row['held_back_db']:.1f} dB in their worst class.")
    said.append(f"FLIP's 99th percentile is {row['flip_p99']:.3f}; up to {INVISIBLE:g} we call invisible.")
    if row["error_from"]:
        parts = [_code(one) for one in row["error_from"].split(", ")[:NAMED]]
        said.append(f"The error of the worst is of {', '.join(parts)}.")
    if row["next_bytes"]:
        more = "One byte more brings" if row["next_bytes"] == 1 else f"{row['next_bytes']} bytes more bring"
        said.append(f"{more} {row['next_db']:.1f} dB there.")
    return " ".join(said)


def _rules(row: Row) -> str:
    blended = [_code(name) for name in (row["blends"] or "").split(", ") if name]
    into = f"Decals blend into {', '.join(blended)}; the fourth channel of a target there is the blend factor."
    said = [into if blended else "No decals are blended by hardware."]
    if "_uint: " in row["targets"]:
        said.append("Whole numbers gain 3 dB or more here, and are not blended, filtered or resolved.")
    said.append(
        f"The G-buffer moves {row['mb_1080p']:.0f} MB at 1080p and {row['mb_4k']:.0f} MB at 4K, without compression, "
        f"written {times(row['overdraw'])}, read {row['readers']}."
    )
    if row["webgpu_bytes"] is None:
        said.append("WebGPU does not render to all of its formats.")
    elif row["webgpu_bytes"] > WEBGPU_BYTES:
        over = row["webgpu_bytes"] - WEBGPU_BYTES
        said.append(f"It exceeds WebGPU's limit of {WEBGPU_BYTES} bytes a sample by {over}.")
    else:
        said.append(f"It uses {row['webgpu_bytes']} of WebGPU's {WEBGPU_BYTES} bytes a sample.")
    if row["in_tile"] is not None:
        fits = ", which fit the tile" if row["in_tile"] else ": it takes tiles of half the size"
        said.append(f"With the light buffer it takes {row['tile_bytes']} bytes in a tile{fits}.")
    if row["by_contract"]:
        said.append(f"By contract, not measured: {', '.join(_code(name) for name in row['by_contract'].split(', '))}.")
    return " ".join(said)


def _price(row: Row) -> str:
    if row["pack_slots"] is None:
        return "What it costs to pack and unpack is not known on this machine."
    parts = f"Packing takes {row['pack_slots']:g} issue slots and unpacking {row['unpack_slots']:g}"
    often = f"written {times(row['overdraw'])} and read {row['readers'].partition(', ')[0]}"
    return f"{parts} on {row['dearest_family']}: {row['slots']:g} a pixel that is {often}."
