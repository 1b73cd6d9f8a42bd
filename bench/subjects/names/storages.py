"""Storages as named on the command line: by name, by an API's format name, or by bits."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping

from ....encodings.storages.rules import BY_RULE, KINDS, storage_of
from ....encodings.storages.storage import DITHERED, FORMATS, ROUNDINGS, STORAGES, Storage
from ...ground.choose import choose, unknown_name
from ...ground.options.words import Given, Names, Word
from ...ground.output.errors import UsageError
from ...ground.spelling import channels_of, spelled

# Storages by rule from some bits to some others, and what begins like one.
BITS = r"\d{1,3}(?::\d{1,3})*"
RANGE = re.compile(rf"(?P<kind>{'|'.join(KINDS)}):(?P<first>{BITS})\.\.(?P<last>{BITS})")
RULE = re.compile(rf"({'|'.join(KINDS)}):", re.I)
# As WebGPU spells the formats of vertices: unorm10-10-10-2, snorm16x2.
VERTEX = re.compile(r"(?P<kind>unorm|snorm|float)(?:(?P<bits>\d+(?:-\d+)+)|(?P<size>\d+)x(?P<count>[2-4]))", re.I)


def storages_named(
    names: Iterable[Word], known: Mapping[str, Storage] = STORAGES, what: str = "storage"
) -> list[Storage]:
    """Return the storages with these names. Bits count as names, and so do ranges of bits, such as unorm:4:4..8:8.

    Args:
        known: the storages that "all" stands for and that messages list.
        what: the word for a storage in messages.

    Raises:
        UsageError: a name is unknown, or bits are invalid; the message is one line.
    """
    own = [word for word in names if isinstance(word, Given)]
    storages = storages_said(word for word in names if isinstance(word, str))
    unknown = [
        word for word, storage in storages.items() if not (storage or word == "all" or spelled(what, word, known))
    ]
    if unknown:
        raise unknown_name(what, unknown, known, f"all, {', '.join(known)}; or bits, such as unorm:9:7")
    chosen = choose(
        what, [*storages, *own], {**known, **{word: storage for word, storage in storages.items() if storage}}
    )
    return list(dict.fromkeys(chosen))


def roundings_named(names: Names, known: Collection[str] = ROUNDINGS) -> list[str]:
    """Return rounding modes by name. Raises UsageError for a name that is not in `known`."""
    if DITHERED not in known and DITHERED in names:
        raise UsageError(f"--rounding {DITHERED}: this command adds no noise; use quality or render")
    return choose("rounding", names, {name: name for name in known})


def storages_said(names: Iterable[str], others: Collection[str] = ()) -> dict[str, Storage | None]:
    """Return by name the storage that its bits or format specify, with ranges expanded; None for any other name.

    Args:
        others: names that have a different meaning.

    Raises:
        UsageError: bits are invalid; the message is one line.
    """
    words = [word for name in names for word in _in_range(name)]
    return {word: None if word in others else _storage_of(word) for word in words}


def _storage_of(word: str) -> Storage | None:
    """Return the storage that a word specifies by bits or by a format; None for any other word. Raises UsageError."""
    try:
        return storage_of(word) or storage_of(_rule_of(word) or spelled("storage", word, FORMATS) or "")
    except ValueError as error:
        raise UsageError(f"--storage: {error}") from error


def _rule_of(word: str) -> str | None:
    """Return the bits, as `unorm:5:6:5`, for bits alone (5:6:5), or for a format that an API names and the catalogue
    lacks, such as B5G6R5_UNORM; None for any other word."""
    if re.fullmatch(r"\d+(:\d+)+", word):
        return f"unorm:{word}"
    if vertex := VERTEX.fullmatch(word):
        bits = vertex["bits"].split("-") if vertex["bits"] else [vertex["size"]] * int(vertex["count"])
        kind = vertex["kind"].lower()
        return ":".join((kind, *bits)) if kind != "float" else _floats_of(vertex["size"], len(bits))
    *channels, kind = (channels_of(word) if "norm" in word.lower() else ()) or ("",)
    kind = kind or "unorm"
    return ":".join((kind, *(channel[1:] for channel in channels))) if channels and kind in KINDS else None


def _floats_of(size: str | None, count: int) -> str | None:
    return f"{'rgba'[: 2 if count == 2 else 4]}{size}f" if size in ("16", "32") else None


def _in_range(word: str) -> list[str]:
    """Return the names in a range such as `unorm:4:4..8:8`, in which each bit count grows by one from name to name;
    for a single name, a list of only this name.

    Raises UsageError for an invalid range.
    """
    word = word.lower() if RULE.match(word) else word
    match = RANGE.fullmatch(word)
    if not match and RULE.match(word) and not BY_RULE.fullmatch(word):
        raise UsageError(
            f"--storage {word}: write bits as unorm:9:7, snorm:12:12, centred:8:8, float:5:10, unorm:4:4..16:16"
        )
    if not match:
        return [word]
    first, last = ([int(bits) for bits in match[end].split(":")] for end in ("first", "last"))
    steps = {high - low for low, high in zip(first, last, strict=False)} - {0}
    if len(first) != len(last) or len(steps) > 1 or min(steps, default=0) < 0:
        raise UsageError(f"--storage {word}: the bit counts must grow equally or not at all, as in unorm:4:4..16:16")
    grows = [high > low for low, high in zip(first, last, strict=True)]
    every = ([b + step * g for b, g in zip(first, grows, strict=True)] for step in range(max(steps, default=0) + 1))
    return [":".join((match["kind"], *map(str, bits))) for bits in every]
