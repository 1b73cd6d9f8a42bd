"""The comment above a layout's functions, with the layout as a table."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import version

from .....encodings.codecs.light_encoding import LightEncoding
from .....gbuffer.layouts.words import OTHER, Word
from ..emit import LANGUAGES
from ..tables import table_lines
from .bits import parts_of
from .emit import GBufferCode
from .surface import Contents

AXES = "xyzw"
TITLES = ("target", "format", "bits", "channel", "field", "encoding")
# What keeps a line as it is: see `files.commented`.
KEPT = "  "
# What functions take besides.
SAID = {
    "view": "view is the view-space position, with the viewer at the origin.",
    "far": "depth is -z in view space, up to the far plane.",
}


def head(code: GBufferCode, command: str, verified: str) -> list[str]:
    """Return the paragraphs above a file's functions.

    Args:
        command: the command that made the file.
        verified: the comparison of the file's results with the renderer's, in words.
    """
    layout, language = code.layout, LANGUAGES[code.language]
    return [
        f"Layout {layout.name} in {language.title}: {code.prefix}_pack and {code.prefix}_unpack. {language.advice}",
        f"{layout.title}. {layout.bytes_per_pixel} bytes per pixel; the normal's axes are the {layout.space}'s.",
        "",
        *table(code.texts.contents),
        "",
        "Bits are counted from 0, the lowest. A field with its own channel is converted by the format.",
        *(SAID[name] for name in code.settings if name in SAID),
        *table_lines(code.tables),
        f"Verified: {verified}.",
        f"Made by normalbench {version('normalbench')}: {command}",
        "MIT License, Copyright (c) 2026 The normalbench authors.",
    ]


def table(contents: Contents) -> list[str]:
    """Return lines with the layout's words in columns, under a line of titles."""
    rows = [TITLES, *(_row(contents, word) for word in contents.words)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(TITLES))]
    lines = ("  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)) for row in rows)
    return [f"{KEPT}{line.rstrip()}" for line in lines]


def _row(contents: Contents, word: Word) -> tuple[str, ...]:
    target = contents.layout.targets[word.target]
    bits = word.bits_in(target.storage)
    return (
        f"target_{word.target}",
        target.format,
        str(bits),
        ", ".join(_places(contents, word)),
        _field(contents, word),
        _code(contents, word),
    )


def _places(contents: Contents, word: Word) -> Iterator[str]:
    """Yield the positions of a word, by channel, such as `x` or `x 20-31`."""
    storage = contents.layout.targets[word.target].storage
    if not word.bits:
        yield AXES[word.first]
        return
    for channel, size in enumerate(storage.bits):
        for part in parts_of([word], channel, storage):
            low, high = max(part.shift, 0), min(size, part.shift + word.bits) - 1
            yield f"{AXES[channel]} {low}-{high}" if high > low else f"{AXES[channel]} {low}"


def _field(contents: Contents, word: Word) -> str:
    """Return the name of a word in the structure, such as `base_color.x`."""
    if word.component.startswith("normal."):
        return word.component
    field = next(field for field in contents.fields if word in field.words or _is_fourth(field.name, word))
    if len(field.components) == 1:
        return field.name
    axis = len(field.words) if word not in field.words else field.words.index(word)
    return f"{field.name}.{AXES[axis]}"


def _is_fourth(name: str, word: Word) -> bool:
    """Whether a word is the fourth number of a light's code."""
    return word.component == f"{name}.a"


def _code(contents: Contents, word: Word) -> str:
    if word.component.startswith("normal."):
        return contents.layout.encoding.name
    sign = f", with the sign of {word.sign}" if word.sign else ""
    if word.component == "depth":
        return contents.layout.depth_encoding.name + sign
    return _kept_text(contents, word) + sign


def _kept_text(contents: Contents, word: Word) -> str:
    storage = contents.layout.targets[word.target].storage
    if word.kept:
        is_light = isinstance(word.kept.encoding, LightEncoding)
        return word.kept.encoding.name + ("" if is_light or word.kept.range == 1.0 else f", up to {word.kept.range:g}")
    if not word.bits and word.first < storage.curved:
        return "sRGB, by the format"
    return "unchanged" if word.component in (OTHER, "shading_model", "instance") else "linear"
