"""The sentences that describe a budget."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from ....encodings.storages.storage import TARGET_FORMATS
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
    "shading_model": "shading model",
}
# What free bytes may hold: how many it takes, a word of layouts that have it, and what it is.
FREE_FOR = ((4, "emissive", "emissive light"), (2, "coat", "a clear coat"), (2, "anisotropy", "anisotropy"))
# Shares of an error that a sentence names.
NAMED = 3


def told(row: Row) -> Iterator[str]:
    """Yield texts on a row of the budget table: the answer; its sources of error and the gain from more bytes; its
    rules; its cost. If the row was skipped, yield only the reason."""
    if row["skipped"]:
        yield f"{row['skipped'].rstrip('.')}."
        return
    yield " ".join(filter(None, [_answer(row), _free(row)]))
    yield _errors(row)
    yield _rules(row)
    yield _cost(row)


def in_short(row: Row) -> Iterator[str]:
    """Yield two texts on a measured row: the answer; then its cost and the gain from more bytes."""
    yield _answer(row)
    slots = "not counted on this machine"
    if row["pack_slots"] is not None:
        parts = f"{row['pack_slots']:g} issue slots to pack and {row['unpack_slots']:g} to unpack"
        slots = f"{parts} on {row['dearest_family']}: {row['slots']:g} per pixel"
    yield " ".join(
        filter(None, [f"Cost: {slots}. {row['mb_1080p']:.0f} MB written and read per frame at 1080p.", _next(row)])
    )


def targets(row: Row) -> list[Row]:
    """Return a table row for each render target of a budget row's layout: `target` is its number, format and bytes,
    `holds` the attributes that it stores and their encodings, in words. Empty if the layout has no targets."""
    # The other words of a layout of yours are shown as they are.
    codes = dict(text.split(" ", 1) for text in row["codes"].split("; ") if text) if row["codes"] else {}
    if row["kind"] == IMPROVED:
        codes.pop("other", None)
    table = []
    texts = row["targets"].split("; ") if row["targets"] else []
    for number, text in enumerate(texts):
        name, words = text.split(": ", 1)
        size = TARGET_FORMATS[name].texel_bytes
        held = dict.fromkeys(_held(word, codes) for word in words.split())
        table.append({"target": f"{number}: {name}, {size} byte{'s' * (size > 1)}", "holds": ", ".join(held)})
    return table


def _held(word: str, codes: Mapping[str, str]) -> str:
    """Return the attribute that a word of a layout stores, and its encoding, in words; the word itself if it matches
    no attribute in `codes`."""
    attribute = next((name for name in reversed(re.findall(r"[a-z_0-9]+", word)) if name in codes), None)
    return word if attribute is None else _code(f"{attribute} {codes[attribute]}")


def _subject(row: Row) -> str:
    if row["kind"] == IMPROVED:
        return f"The same attributes in the same formats, {row['layout']}"
    return f"{row['limit']} bytes per pixel"


def _answer(row: Row) -> str:
    """Return two sentences: the bytes per pixel with the PSNR of the worst class, there and in scenes that did not
    choose the layout, and of the frame; then whether errors are visible."""
    fewer = f"{row['bytes_per_pixel']:g} bytes are enough, for " if row["bytes_per_pixel"] != row["limit"] else ""
    scene, _, surfaces = row["worst_class"].rpartition(" ")
    worst = f"{row['worst_db']:.1f} dB in the worst class ({surfaces} in {scene})"
    is_held_back = "," in row["scene"] and row["held_back_db"] is not None
    others = f"{row['held_back_db']:.1f} dB in scenes left out of the choice, " if is_held_back else ""
    frame = f"{row['psnr_db']:.1f} dB in the frame"
    return f"{_subject(row)}: {fewer}{worst}, {others}{frame}. {_visible(row['flip_p99'])}"


def _proposals(rows: Sequence[Row]) -> list[Row]:
    return [row for row in rows if row["kind"] == PROPOSAL and not row["skipped"]]


def enough(rows: Sequence[Row]) -> Row | None:
    """Return the smallest recommendation without visible errors; None if there is none."""
    unseen = (row for row in _proposals(rows) if row["flip_p99"] <= INVISIBLE)
    return min(unseen, key=lambda row: row["bytes_per_pixel"], default=None)


def smallest(rows: Sequence[Row]) -> str:
    """Return a sentence on the smallest recommendation without visible errors; empty for fewer than two limits."""
    proposals = _proposals(rows)
    if len({row["limit"] for row in proposals}) < 2:
        return ""
    if not (answer := enough(rows)):
        return f"Errors are visible even with {max(row['bytes_per_pixel'] for row in proposals):g} bytes per pixel."
    fewest = f"{answer['bytes_per_pixel']:g} bytes per pixel are the fewest of these limits"
    return f"{fewest} without visible errors in a still image."


def _free(row: Row) -> str:
    """Return a sentence on the bytes that a recommendation leaves free, and the missing attributes that would fit;
    empty if less than a byte is free, or the row is not a recommendation."""
    free = (row["limit"] or 0) - row["bytes_per_pixel"] if row["kind"] == PROPOSAL else 0
    uses = [use for size, word, use in FREE_FOR if size <= free and word not in row["targets"]]
    which = f" for {' or '.join(uses)}" if uses else ""
    return f"{free:g} {'bytes are' if free > 1 else 'byte is'} free{which}." if free >= 1 else ""


def _visible(flip: float) -> str:
    if flip <= INVISIBLE:
        return "Errors are invisible in a still image."
    return f"Errors are visible{' side by side' if flip <= ACCEPTABLE else ''}."


def _code(text: str) -> str:
    """Return a text such as `base_color square_root 7:7:6` in words: `base colour 7:7:6 as square root`."""
    name, _, code = text.partition(" ")
    code, is_root = code.removeprefix("square_root "), code.startswith("square_root ")
    code, _, most = code.removeprefix("linear ").replace("in halves", "in half floats").partition(" to ")
    words = [WORDS.get(name, name), f"{code} bits" if code.isdigit() else code, "as square root" if is_root else ""]
    return " ".join(filter(None, [*words, f"up to {float(most):.2g}" if most else ""]))


def _names(names: str) -> str:
    return ", ".join(WORDS.get(name, name) for name in names.split(", "))


def _errors(row: Row) -> str:
    sentences = [f"FLIP (99th percentile) is {row['flip_p99']:.3f}; up to {INVISIBLE:g} counts as invisible."]
    if row["error_from"]:
        parts = [_code(part) for part in row["error_from"].split(", ")[:NAMED]]
        sentences.append(f"The error of the worst class comes from {', '.join(parts)}.")
    return " ".join([*sentences, *filter(None, [_next(row)])])


def _next(row: Row) -> str:
    if not row["next_bytes"]:
        return ""
    return f"{row['limit'] + row['next_bytes']} bytes would gain {row['next_db']:.1f} dB."


def _rules(row: Row) -> str:
    into = f"Decals blend into {_names(row['blends'] or '')}; the alpha of these targets is the blend factor."
    sentences = [into if row["blends"] else "Not checked for hardware decal blending; use --blend to require it."]
    if "_uint: " in row["targets"]:
        sentences.append("Integer targets gain at least 3 dB here, but cannot be blended, filtered or resolved.")
    sentences.append(
        f"Memory traffic per frame, uncompressed: {row['mb_1080p']:.0f} MB at 1080p, {row['mb_4k']:.0f} MB at 4K "
        f"(written {times(row['overdraw'])}; read {row['readers']})."
    )
    if row["webgpu_bytes"] is None:
        sentences.append("WebGPU does not render to all of its formats.")
    elif row["webgpu_bytes"] > WEBGPU_BYTES:
        over = row["webgpu_bytes"] - WEBGPU_BYTES
        sentences.append(f"It exceeds WebGPU's limit of {WEBGPU_BYTES} bytes per sample; bytes in excess: {over}.")
    else:
        sentences.append(f"It uses {row['webgpu_bytes']} of WebGPU's {WEBGPU_BYTES} bytes per sample.")
    if row["in_tile"] is not None:
        fits = ", which fit in the tile" if row["in_tile"] else ", which need tiles of half the size"
        sentences.append(f"With the light buffer it takes {row['tile_bytes']} bytes per pixel{fits}.")
    return " ".join(sentences)


def _unmeasured(row: Row) -> tuple[str, ...]:
    """Return a tuple of one sentence on the attributes that no scene shows; empty without such attributes."""
    names = row["by_contract"]
    return (f"Not measured, because no scene shows them: {_names(names)}.",) if names else ()


def conditions(row: Row) -> str:
    """Return one text on the free bytes, the scenes and size of the images and the unmeasured attributes."""
    images = f"Images: {row['scene'].replace(',', ', ')} at {row['size']}."
    return " ".join(filter(None, [_free(row), images, *_unmeasured(row)]))


def _cost(row: Row) -> str:
    if row["pack_slots"] is None:
        return "The cost of packing and unpacking is not known on this machine."
    parts = f"Packing takes {row['pack_slots']:g} issue slots and unpacking {row['unpack_slots']:g}"
    often = f"written {times(row['overdraw'])} and read {row['readers'].partition(', ')[0]}"
    return f"{parts} on {row['dearest_family']}: {row['slots']:g} slots per pixel, {often}."
