"""A comparison of a layout's code with the renderer's own GLSL: both run on the same surfaces."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np

from .....encodings.storages.rounding import store_texel, to_srgb
from .....encodings.storages.storage import Storage
from .....gbuffer.codecs.codec_passes import encoding_defines
from .....gbuffer.codecs.depth.depth_passes import depth_defines
from .....gbuffer.codecs.harness import uploaded
from .....gbuffer.defines.layouts import curve_defines, curve_files, layout_defines
from .....gbuffer.defines.materials import CONSTANTS
from .....gbuffer.gl.device import bind, device
from .....gbuffer.gl.shader import Source
from .....gbuffer.layouts.layout import Layout
from .....gbuffer.layouts.words import COMPONENTS, OTHER, Word
from ..run import opengl
from ..verify import DECODED, MOST_SHARE
from .bits import parts_of
from .emit import GBufferCode
from .fields import target_leaves
from .numbers import ways_of
from .run import BLOCK, dispatched, run
from .surface import Contents
from .surfaces import settings, surfaces

REFERENCE = Path(__file__).with_name("reference.comp")
COUNT = 2**16
CHANNELS, NORMAL = 4, 3


@dataclass(frozen=True)
class Agreement:
    """The differences between a file's results and the renderer's.

    Attributes:
        count: the number of surfaces.
        differing: the number of surfaces with a different bit in any target.
        steps: the largest difference between stored numbers, in steps.
        unpacked: the number of unpacked numbers that differ: whole numbers by any amount, other numbers by more than
            DECODED, relative to the larger of their magnitude and 1.
        decoded: the largest difference between unpacked floats, relative to the larger of their magnitude and 1.
    """

    count: int
    differing: int
    steps: int
    unpacked: int
    decoded: float

    @property
    def holds(self) -> bool:
        """Whether the file agrees with the renderer, except for ties in rounding."""
        return self.differing <= MOST_SHARE * self.count and self.steps <= 1 and not self.unpacked

    @property
    def says(self) -> str:
        """The agreement in words."""
        packed = f"the targets of all {self.count} surfaces match the renderer's, bit for bit"
        if self.differing:
            steps = f"{self.steps} step{'s' * (self.steps != 1)}"
            packed = f"the targets of {self.differing} of {self.count} surfaces differ, by at most {steps}"
        near = f" within {self.decoded:.1g}" if self.decoded else ""
        back = f"{self.unpacked} numbers differ when unpacked" if self.unpacked else f"surfaces come back equal{near}"
        return f"{packed}; {back}"


def agreement(code: GBufferCode, count: int = COUNT, seed: int = 0) -> Agreement:
    """Run a file's functions on random surfaces, and return the differences between its results and the renderer's.

    Raises:
        MissingError: the tool that runs the language is not installed.
        ShaderError: the code does not compile or run.
        NoDeviceError: there is no OpenGL device.
    """
    contents = code.texts.contents
    given, besides = surfaces(contents, count, seed), settings(count, seed)
    expected = Expected(contents, given, besides)
    ran = run(code, np.concatenate([given, expected.read(code)], axis=1), besides)
    width = len(target_leaves(code.texts))
    return _compared(expected, stored_texels(contents.layout, written_texels(code, ran[:, :width])), ran[:, width:])


class Expected:
    """The results of the renderer's GLSL for surfaces.

    Attributes:
        stored: uint32 of shape (count, targets, 4): the contents of the targets, as integer texels or as the bits of
            floats.
        surfaces: uint32 of shape (count, numbers), the surfaces that are decoded from `stored`.
    """

    def __init__(self, contents: Contents, given: np.ndarray, besides: np.ndarray):
        self.contents, self._given, self._besides = contents, given, besides
        layout = contents.layout
        self._program = opengl.compiled(_reference_text(layout), str)
        rows = np.zeros((len(given), NORMAL + len(COMPONENTS) + CHANNELS * len(layout.targets)), np.uint32)
        rows[:, : NORMAL + len(COMPONENTS)] = self._numbers()
        texels = self._made(rows)[:, : CHANNELS * len(layout.targets)]
        self.stored = stored_texels(layout, texels.reshape(len(given), -1, CHANNELS))
        self._add_others()
        rows[:, NORMAL + len(COMPONENTS) :] = self.stored.reshape(len(given), -1)
        self.surfaces = self._surfaces(self._made(rows)[:, CHANNELS * len(layout.targets) :])
        self._program.release()

    def _made(self, rows: np.ndarray) -> np.ndarray:
        given = np.concatenate([rows, self._besides], axis=1)
        parts = [given[start : start + BLOCK] for start in range(0, len(rows), BLOCK)]
        with ExitStack() as stack:
            bind(self._program, uploaded(device(), stack, self.contents.layout.encoding.tables()))
            return np.concatenate([dispatched(self._program, part, rows.shape[1]) for part in parts])

    def _columns(self) -> dict[str, int]:
        """Return the column of each component in the rows of surfaces, by the component's name."""
        columns, column = {}, NORMAL
        for field in self.contents.fields[1:]:
            for component in field.components:
                columns[component] = column
                column += 1
        return columns

    def _numbers(self) -> np.ndarray:
        """Return the renderer's inputs, the normal and the numbers, as uint32 of shape (count, numbers): floats as
        their bits, whole numbers as floats, and 0 for components that the layout lacks."""
        numbers = np.zeros((len(self._given), NORMAL + len(COMPONENTS)), np.float32)
        numbers[:, :NORMAL] = self._given[:, :NORMAL].view(np.float32)
        kinds = {name: field.kind for field in self.contents.fields for name in field.components}
        for component, index in self._columns().items():
            if component in COMPONENTS:
                column = np.ascontiguousarray(self._given[:, index])
                number = column.astype(np.float32) if kinds[component] == "uint" else column.view(np.float32)
                numbers[:, NORMAL + COMPONENTS.index(component)] = number
        return numbers.view(np.uint32)

    def _add_others(self) -> None:
        """Put the values of `other` fields, which the renderer does not store, at their places in the targets."""
        columns = self._columns()
        for field in self.contents.fields:
            if field.words and field.words[0].component == OTHER:
                value = np.ascontiguousarray(self._given[:, columns[field.name]])
                _put(self.contents.layout, field.words[0], value, field.kind == "float", self.stored)

    def _surfaces(self, decoded: np.ndarray) -> np.ndarray:
        """Return the surfaces expected after unpacking: the renderer's decoded normals and numbers, and the other
        fields as given, with floats as their format stores them."""
        expected = self._given.copy()
        for field in self.contents.fields:
            if field.kind == "float" and field.words[0].component == OTHER:
                word = field.words[0]
                expected[:, self._columns()[field.name]] = self.stored[:, word.target, word.first]
        expected[:, :NORMAL] = decoded[:, :NORMAL]
        kinds = {name: field.kind for field in self.contents.fields for name in field.components}
        for component, column in self._columns().items():
            if component in COMPONENTS:
                number = np.ascontiguousarray(decoded[:, NORMAL + COMPONENTS.index(component)])
                is_whole = kinds[component] == "uint"
                expected[:, column] = (number.view(np.float32) + 0.5).astype(np.uint32) if is_whole else number
        return expected

    def read(self, code: GBufferCode) -> np.ndarray:
        """Return the values to read from the targets, in the structure's order: uint32 of shape (count, numbers)."""
        places = (leaf.path.removeprefix("target_").partition(".") for leaf in target_leaves(code.texts))
        return np.stack([self.stored[:, int(target), "xyzw".index(axis or "x")] for target, _, axis in places], axis=1)


def _reference_text(layout: Layout) -> str:
    encoding, depth = layout.codec.encoding, layout.depth_encoding
    defines: dict[str, object] = {**CONSTANTS, **depth_defines(depth), **encoding_defines(encoding)}
    defines |= {**layout_defines(layout, ways_of(layout), True), **curve_defines(layout)}
    files: dict[str, Any] = {"ENCODING": encoding.glsl, "DEPTH_ENCODING": depth.glsl, "CURVES": curve_files(layout)}
    return Source(REFERENCE, defines, files).text


def written_texels(code: GBufferCode, packed: np.ndarray) -> np.ndarray:
    """Return a file's packed targets in the renderer's arrangement: uint32 of shape (count, targets, 4)."""
    texels = np.zeros((len(packed), len(code.texts.targets), CHANNELS), np.uint32)
    for column, leaf in enumerate(target_leaves(code.texts)):
        target, _, axis = leaf.path.removeprefix("target_").partition(".")
        texels[:, int(target), "xyzw".index(axis or "x")] = packed[:, column]
    return texels


def stored_texels(layout: Layout, texels: np.ndarray) -> np.ndarray:
    """Return texels as they are read back from the targets, after each format's conversion."""
    stored = np.zeros_like(texels)
    for index, target in enumerate(layout.targets):
        for channel in range(target.storage.channels):
            word = np.ascontiguousarray(texels[:, index, channel])
            if not target.storage.is_integer:
                number = store_texel(jnp.asarray(word.view(np.float32)), target.storage, channel)
                word = np.asarray(number, np.float32).view(np.uint32)
            stored[:, index, channel] = word
    return stored


def _put(layout: Layout, word: Word, value: np.ndarray, is_float: bool, stored: np.ndarray) -> None:
    """Write a field's values, whole numbers or the bits of floats, to the place of their word in `stored`."""
    storage = layout.targets[word.target].storage
    if not word.bits:
        texel = value.view(np.float32) if is_float else _unit(value, storage, word.first)
        number = np.asarray(store_texel(jnp.asarray(texel), storage, word.first), np.float32)
        stored[:, word.target, word.first] = number.view(np.uint32)
        return
    for channel, size in enumerate(storage.bits):
        scale = storage.scale(channel)
        for part in parts_of([word], channel, storage):
            moved = value << np.uint32(part.shift) if part.shift >= 0 else value >> np.uint32(-part.shift)
            moved &= np.uint32(2**size - 1)
            if storage.is_integer:
                stored[:, word.target, channel] |= moved
            else:
                held = np.rint(np.ascontiguousarray(stored[:, word.target, channel]).view(np.float32) * scale)
                texel = ((held.astype(np.uint32) | moved) * np.float32(1 / scale)).astype(np.float32)
                stored[:, word.target, channel] = texel.view(np.uint32)


def _unit(value: np.ndarray, storage: Storage, channel: int) -> np.ndarray:
    return (value / storage.scale(channel)).astype(np.float32)


def _compared(expected: Expected, stored: np.ndarray, back: np.ndarray) -> Agreement:
    layout = expected.contents.layout
    steps = max(
        (
            int(np.abs(_steps(layout, word, stored) - _steps(layout, word, expected.stored)).max(initial=0))
            for word in expected.contents.words
        ),
        default=0,
    )
    is_float = np.array([f.kind != "uint" for f in expected.contents.fields for _ in f.components or "xyz"])
    mine, theirs = (np.ascontiguousarray(rows[:, is_float]).view(np.float32) for rows in (back, expected.surfaces))
    off = np.abs(mine - theirs) / np.maximum(np.abs(theirs), 1.0)
    wrong = int((back[:, ~is_float] != expected.surfaces[:, ~is_float]).sum()) + int((~(off <= DECODED)).sum())
    differing = int((stored != expected.stored).any(axis=(1, 2)).sum())
    return Agreement(len(stored), differing, steps, wrong, float(off.max(initial=0.0)))


def _float_steps(number: np.ndarray, bits: int) -> np.ndarray:
    """Return floats of `bits` bits as integers in the same order, whose differences are in steps. Unsigned floats are
    half floats whose last bits are 0."""
    held = number.astype(np.float16).view(np.int16) if bits < 32 else number.view(np.int32)
    magnitude = held.astype(np.int64) & np.iinfo(held.dtype).max
    return np.where(held < 0, -magnitude, magnitude) >> max(0, 15 - bits)


def _steps(layout: Layout, word: Word, stored: np.ndarray) -> np.ndarray:
    """Return the integers that store a word's number, int64 of shape (count,); their differences are in steps."""
    storage, texels = layout.targets[word.target].storage, stored[:, word.target]
    if not word.bits:
        number = np.ascontiguousarray(texels[:, word.first]).view(np.float32)
        if storage.kind == "float":
            return _float_steps(number, storage.bits[word.first])
        curved = np.asarray(to_srgb(jnp.asarray(number))) if word.first < storage.curved else number
        return np.rint(curved.astype(np.float64) * storage.scale(word.first)).astype(np.int64)
    integers = np.zeros(len(texels), np.uint32)
    for channel in range(storage.channels):
        held = np.ascontiguousarray(texels[:, channel])
        held = held if storage.is_integer else np.rint(held.view(np.float32) * storage.scale(channel)).astype(np.uint32)
        for part in parts_of([word], channel, storage):
            moved = held >> np.uint32(part.shift) if part.shift >= 0 else held << np.uint32(-part.shift)
            integers |= moved & np.uint32(2**word.bits - 1)
    return integers.astype(np.int64)
