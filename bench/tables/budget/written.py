"""Conversion of a solution to a layout for the renderer and to a layout file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ....encodings.catalogue import ENCODINGS
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.words import FREE, Target
from .attributes import NORMAL, SRGB, UNORM, Code
from .bins import SHARED, Bin
from .solve import Placed, Solution


def layout_of(name: str, solution: Solution) -> Layout:
    """Return a solution as a `Layout` with this name. Raises ValueError if the solution has no normal."""
    normal = next((placement.code for placement in solution.placed if placement.code.attribute == NORMAL), None)
    if normal is None:
        raise ValueError("a layout holds a normal")
    targets = tuple(target_of(target_bin, placed) for target_bin, placed in _by_target(solution))
    encoding = ENCODINGS[normal.name.partition(" ")[0]]
    return Layout(name, "proposed by budget", targets, encoding, "this project", space="world")


def _by_target(solution: Solution) -> Iterator[tuple[Bin, list[Placed]]]:
    """Yield each target with its placed encodings, wide targets first, so that WebGPU loses no bytes to alignment;
    among equally wide targets, the target with the normal comes first."""
    groups: dict[tuple[str, int], list[Placed]] = {}
    for placement in solution.placed:
        groups.setdefault((placement.bin.name, placement.copy), []).append(placement)

    def place(placed: list[Placed]) -> tuple[int, bool]:
        return -placed[0].bin.bytes, all(p.code.attribute != NORMAL for p in placed)

    order = sorted(groups.values(), key=place)
    for placed in order:
        yield placed[0].bin, placed


def target_of(target_bin: Bin, placed: Sequence[Placed]) -> Target:
    """Return the target for the encodings that are placed in a bin."""
    if target_bin.fields:
        # The widest first, so that the numbers of a code begin at the top.
        order = sorted(placed, key=lambda p: (p.code.is_exact, -p.code.total_bits))
        return Target(target_bin.format, " ".join(_in_fields(target_bin, order)))
    return Target(target_bin.format, " ".join(_in_channels(target_bin, placed)))


def _in_fields(target_bin: Bin, placed: Sequence[Placed]) -> list[str]:
    """Return the words of a target with integer fields, each with its bits. Each encoding is kept within one channel
    if all of them fit in this way; otherwise they follow each other without gaps."""
    channels: list[list[Code]] = []
    for p in placed:
        home = next((c for c in channels if sum(code.total_bits for code in (*c, p.code)) <= target_bin.part), None)
        if home is None:
            channels.append(home := [])
        home.append(p.code)
    used = [sum(code.total_bits for code in codes) for codes in channels]
    is_apart = len(channels) * target_bin.part <= target_bin.fields and max(used) <= target_bin.part
    words = []
    for index, codes in enumerate(channels):
        words += [f"{word}:{bits}" for code in codes for word, bits in zip(code.words, code.bits, strict=True)]
        if is_apart and used[index] < target_bin.part and index + 1 < len(channels):
            words.append(f"{FREE}:{target_bin.part - used[index]}")
    return words


def _in_channels(target_bin: Bin, placed: Sequence[Placed]) -> Iterator[str]:
    """Yield the words of a target with channels, in the order of the channels; words in shared channels come last."""
    if any(kind == SRGB for kind, _ in target_bin.channels) and not any(p.code.kind == SRGB for p in placed):
        # What lies beside an unused colour lies in the fourth channel.
        yield from [FREE] * 3
    waiting: dict[tuple[str, int], list[str]] = {}
    shared: list[str] = []
    for p in placed:
        if SHARED in (target_bin.need(p.code) or {}):
            shared += [f"{word}:{bits}" for word, bits in zip(p.code.words, p.code.bits, strict=True)]
            continue
        if p.code.kind == SRGB or len(p.code.words) != len(p.code.bits):
            yield p.code.words[0].partition(".")[0]
            continue
        channels = target_bin.channels_of(p.code)
        for word, channel in zip(p.code.words, channels, strict=True):
            waiting.setdefault(channel, []).append(word)
    order = list(target_bin.channels)
    for index, channel in enumerate(order):
        words = waiting.pop(channel, [])
        yield from words
        is_shared = channel == (UNORM, target_bin.part)
        bits = sum(int(word.rpartition(":")[2]) for word in shared) if is_shared else 0
        yield from shared if is_shared else ()
        if channel[0] != SRGB and waiting and index + 1 < len(order):
            if bits % target_bin.part:
                yield f"{FREE}:{target_bin.part - bits % target_bin.part}"
            yield from [FREE] * (target_bin.channels[channel] - len(words) - -(-bits // target_bin.part))


def file_of(row: Mapping[str, Any]) -> str:
    """Return the text of a layout file for `--layout`, in TOML, with the scores of a budget row in comments."""
    normal = next(code for code in row["codes"].split("; ") if code.startswith(f"{NORMAL} "))
    lines = [
        f"# {row['bytes_per_pixel']} bytes per pixel; {row['scene']} at {row['size']}: {row['worst_class']} "
        f"{row['worst_db']:.1f} dB, frame {row['psnr_db']:.1f} dB",
        f"# {row['codes']}",
        f'title = "normalbench budget, {row["bytes_per_pixel"]} bytes"',
        f'encoding = "{normal.split()[1]}"',
        'space = "world"',
    ]
    for target in row["targets"].split("; "):
        name, holds = target.split(": ", 1)
        lines += ["", "[[targets]]", f'format = "{name}"', f'holds = "{holds}"']
    return "\n".join(lines) + "\n"
