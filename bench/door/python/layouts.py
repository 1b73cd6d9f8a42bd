"""Whole G-buffer layouts on arrays: what their targets hold of surfaces, and the surfaces that come back.

What runs is the code that `normalbench code --of layout --to python` writes.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

import jax.numpy as jnp
import numpy as np

from ....encodings.storages.rounding import store_texel
from ....encodings.storages.storage import Storage
from ....gbuffer.layouts.layout import Layout
from ...ground.output.errors import UsageError
from ...shaders.code.whole.emit import PREFIX, GBufferCode, gbuffer_code
from ...shaders.translator.tree import scalar_of, size_of
from ...subjects.codecs.layout_names import layouts_named

CHANNELS = 4


def pack(layout: Layout | str, surface: Mapping[str, Any], **settings: Any) -> tuple[np.ndarray, ...]:
    """What the targets of a layout hold of surfaces: numbers as a shader reads them, or whole numbers.

    Args:
        layout: one of `normalbench list`, a TOML file, or a value.
        surface: arrays by the names of the structure that `normalbench code` writes: "normal" of shape (..., 3),
            "roughness" of shape (...), and so on, all that the layout holds.
        settings: `near` and `far`, numbers, and `view` of shape (..., 3), where the layout's codes need them.

    Returns:
        Of each target an array of shape (..., 4), or (..., channels) where it is of integers.

    Raises:
        UsageError: an unknown layout, a layout that is not written, or a field or a setting too many or too few.
    """
    code, module = _code_of(layout)
    kinds = {field.name: field.kind for field in code.texts.contents.fields}
    _check_names("surface", surface, kinds)
    fields = (_array(surface[name], kind) for name, kind in kinds.items())
    made = module[f"{PREFIX}_pack"](module[f"{PREFIX}_surface"](*fields), *_given(code, settings))
    shape = np.broadcast_shapes(*(_shape(surface[name], kind) for name, kind in kinds.items()))
    storages = [target.storage for target in code.layout.targets]
    return tuple(_stored(one, shape, storage) for one, storage in zip(made, storages, strict=True))


def unpack(layout: Layout | str, targets: Sequence[Any], **settings: Any) -> dict[str, np.ndarray]:
    """The surfaces that come back from what targets hold; `pack` says what is given.

    Raises:
        UsageError: as `pack`, or another number of targets.
    """
    code, module = _code_of(layout)
    if len(targets) != len(code.texts.targets):
        raise UsageError(f"layout {code.layout.name} has {len(code.texts.targets)} targets, not {len(targets)}")
    kinds = [target.kind for target in code.texts.targets]
    # A target of one integer is one number of each pixel.
    held = (np.asarray(one)[..., 0] if kind == "uint" else one for one, kind in zip(targets, kinds, strict=True))
    texels = (_array(one, kind) for one, kind in zip(held, kinds, strict=True))
    made = module[f"{PREFIX}_unpack"](module[f"{PREFIX}_targets"](*texels), *_given(code, settings))
    shape = np.broadcast_shapes(*(np.shape(one)[:-1] for one in targets))
    fields = code.texts.contents.fields
    return {field.name: _broad(one, field.kind, shape) for field, one in zip(fields, made, strict=True)}


def _code_of(layout: Layout | str) -> tuple[GBufferCode, Mapping[str, Any]]:
    if isinstance(layout, str):
        found = layouts_named(layout)
        if len(found) != 1:
            raise UsageError(f"{layout}: {len(found)} layouts; name one")
        layout = found[0]
    return _loaded(layout)


@cache
def _loaded(layout: Layout) -> tuple[GBufferCode, Mapping[str, Any]]:
    """A layout's Python, and what it defines."""
    code = gbuffer_code(layout, "python")
    with tempfile.TemporaryDirectory(prefix="normalbench-") as folder:
        for name, data in code.files([]).items():
            (Path(folder) / name).write_bytes(data)
        path = Path(folder) / code.name
        module: dict[str, Any] = {"__name__": f"normalbench_layout_{layout.name}", "__file__": str(path)}
        exec(compile(code.body, str(path), "exec"), module)
    return code, MappingProxyType(module)


def _check_names(what: str, given: Mapping[str, Any], wanted: Mapping[str, Any] | Sequence[str]) -> None:
    """Raises UsageError for names that are not the wanted ones."""
    if set(given) != set(wanted):
        lacking, odd = sorted(set(wanted) - set(given)), sorted(set(given) - set(wanted))
        wrong = [f"lacks {', '.join(lacking)}"] * bool(lacking) + [f"has no {', '.join(odd)}"] * bool(odd)
        raise UsageError(f"{what} {' and '.join(wrong)}; it has {', '.join(wanted) or 'none'}")


def _given(code: GBufferCode, settings: Mapping[str, Any]) -> list[np.ndarray]:
    _check_names("settings", settings, code.settings)
    return [_array(settings[name], "vec3" if name == "view" else "float") for name in code.settings]


def _array(value: Any, kind: str) -> np.ndarray:
    return np.asarray(value, np.uint32 if scalar_of(kind) == "uint" else np.float32)


def _shape(value: Any, kind: str) -> tuple[int, ...]:
    """A value's shape without the axis of its type."""
    return np.shape(value)[: np.ndim(value) - (size_of(kind) > 1)]


def _broad(made: Any, kind: str, shape: tuple[int, ...]) -> np.ndarray:
    """What does not depend on the pixel is there once."""
    return np.broadcast_to(_array(made, kind), (*shape, size_of(kind)) if size_of(kind) > 1 else shape)


def _stored(made: Any, shape: tuple[int, ...], storage: Storage) -> np.ndarray:
    """What a target holds of what is written to it; 0 in channels that its format lacks."""
    if storage.is_integer:
        whole = _array(made, "uint")
        whole = whole[..., None] if storage.channels == 1 else whole
        return np.broadcast_to(whole, (*shape, storage.channels))
    numbers = np.broadcast_to(_array(made, "vec4"), (*shape, CHANNELS))
    found = np.zeros(numbers.shape, np.float32)
    for channel in range(storage.channels):
        found[..., channel] = np.asarray(store_texel(jnp.asarray(numbers[..., channel]), storage, channel))
    return found
