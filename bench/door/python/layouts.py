"""Whole G-buffer layouts for arrays: packing surfaces into targets, and unpacking surfaces from targets.

The code that `normalbench code --of layout --to glsl` writes is run on the OpenGL device.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from ....gbuffer.layouts.layout import Layout
from ...ground.output.errors import UsageError
from ...shaders.code.whole.emit import GBufferCode, gbuffer_code
from ...shaders.code.whole.fields import surface_leaves, target_leaves
from ...shaders.code.whole.run import run
from ...shaders.code.whole.surfaces import PLACES
from ...shaders.code.whole.verify import stored_texels, written_texels
from ...shaders.translator.tree import scalar_of, size_of
from ...subjects.codecs.layout_names import layouts_named

CHANNELS = 4


def pack(layout: Layout | str, surface: Mapping[str, Any], **settings: Any) -> tuple[np.ndarray, ...]:
    """Return the contents of a layout's targets for surfaces: numbers as a shader reads them, or integers.

    Args:
        layout: a name from `normalbench list`, a TOML file, or a `Layout`.
        surface: arrays by the field names of the structure that `normalbench code` writes: "normal" of shape
            (..., 3), "roughness" of shape (...), and so on, for everything that the layout holds.
        settings: `near` and `far`, numbers, and `view` of shape (..., 3), if the layout's encodings need them.

    Returns:
        For each target an array of shape (..., 4), or (..., channels) if it holds integers.

    Raises:
        UsageError: the layout is unknown or cannot be written, or a field or setting is missing or unexpected.
        NoDeviceError: this machine has no OpenGL device.
    """
    code = _code_of(layout)
    kinds = {field.name: field.kind for field in code.texts.contents.fields}
    _check_names("surface", surface, kinds)
    shape = np.broadcast_shapes(*(_shape(surface[name], kind) for name, kind in kinds.items()))
    rows = np.concatenate([_rows(surface[name], kind, shape) for name, kind in kinds.items()], axis=1)
    width = len(target_leaves(code.texts))
    leaves = _ran(code, np.pad(rows, ((0, 0), (0, width))), settings, shape)[:, :width]
    held = stored_texels(code.layout, written_texels(code, leaves))
    return tuple(
        _target(held[:, number], target.storage.is_integer, target.storage.channels, shape)
        for number, target in enumerate(code.layout.targets)
    )


def unpack(layout: Layout | str, targets: Sequence[Any], **settings: Any) -> dict[str, np.ndarray]:
    """Return the surfaces that the contents of targets decode to; see `pack` for the arguments.

    Raises:
        UsageError: as for `pack`, or the number of targets is wrong.
        NoDeviceError: this machine has no OpenGL device.
    """
    code = _code_of(layout)
    if len(targets) != len(code.texts.targets):
        raise UsageError(f"layout {code.layout.name} has {len(code.texts.targets)} targets, not {len(targets)}")
    kinds = [target.kind for target in code.texts.targets]
    # A target of one integer is one number of each pixel.
    held = [
        np.asarray(target)[..., 0] if kind == "uint" else target for target, kind in zip(targets, kinds, strict=True)
    ]
    shape = np.broadcast_shapes(*(_shape(target, kind) for target, kind in zip(held, kinds, strict=True)))
    rows = np.concatenate([_rows(target, kind, shape) for target, kind in zip(held, kinds, strict=True)], axis=1)
    width = len(surface_leaves(code.texts))
    leaves = _ran(code, np.pad(rows, ((0, 0), (width, 0))), settings, shape)[:, -width:]
    fields = code.texts.contents.fields
    ends = np.cumsum([size_of(field.kind) for field in fields])[:-1]
    parts = np.split(leaves, ends, axis=1)
    return {field.name: _field(part, field.kind, shape) for field, part in zip(fields, parts, strict=True)}


def _code_of(layout: Layout | str) -> GBufferCode:
    if isinstance(layout, str):
        named = layouts_named((layout,))
        if len(named) != 1:
            raise UsageError(f"{layout} names {len(named)} layouts; name exactly one")
        layout = named[0]
    return _written(layout)


@cache
def _written(layout: Layout) -> GBufferCode:
    return gbuffer_code(layout, "glsl")


def _check_names(what: str, given: Mapping[str, Any], wanted: Mapping[str, Any] | Sequence[str]) -> None:
    """Raise UsageError if names are missing or unexpected."""
    if set(given) != set(wanted):
        lacking, odd = sorted(set(wanted) - set(given)), sorted(set(given) - set(wanted))
        wrong = [f"missing {', '.join(lacking)}"] * bool(lacking) + [f"unexpected {', '.join(odd)}"] * bool(odd)
        raise UsageError(f"{what}: {' and '.join(wrong)}; expected: {', '.join(wanted) or 'none'}")


def _ran(code: GBufferCode, rows: np.ndarray, settings: Mapping[str, Any], shape: tuple[int, ...]) -> np.ndarray:
    """Return the results of packing and unpacking rows: uint32 of shape (count, numbers), the targets' numbers
    first."""
    _check_names("settings", settings, code.settings)
    besides = np.zeros((len(rows), max(place.stop for place in PLACES.values())), np.uint32)
    for name, value in settings.items():
        besides[:, PLACES[name]] = _rows(value, "vec3" if name == "view" else "float", shape)
    # A device runs no empty group.
    return run(code, rows, besides) if len(rows) else rows


def _rows(value: Any, kind: str, shape: tuple[int, ...]) -> np.ndarray:
    """Return the bits of a value given per pixel: uint32 of shape (count, numbers), one row per pixel."""
    size, array = size_of(kind), np.asarray(value, np.uint32 if scalar_of(kind) == "uint" else np.float32)
    whole = np.broadcast_to(array, (*shape, size) if size > 1 else shape)
    return np.ascontiguousarray(whole).view(np.uint32).reshape(-1, size)


def _shape(value: Any, kind: str) -> tuple[int, ...]:
    """Return a value's shape without the axis of its components; a scalar kind has no such axis."""
    return np.shape(value)[: np.ndim(value) - (size_of(kind) > 1)]


def _target(texels: np.ndarray, is_integer: bool, channels: int, shape: tuple[int, ...]) -> np.ndarray:
    texels = np.ascontiguousarray(texels)
    return (texels[:, :channels] if is_integer else texels.view(np.float32)).reshape(
        *shape, channels if is_integer else CHANNELS
    )


def _field(rows: np.ndarray, kind: str, shape: tuple[int, ...]) -> np.ndarray:
    rows = np.ascontiguousarray(rows).view(np.uint32 if scalar_of(kind) == "uint" else np.float32)
    return rows.reshape(*shape, size_of(kind)) if size_of(kind) > 1 else rows.reshape(shape)
