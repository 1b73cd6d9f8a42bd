"""OpenGL tools for codecs of every kind: a check for functions, a pair of passes, and a compute shader."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from ...encodings.storages.storage import Storage
from ..gl.device import Device, bind, read_pixels
from ..gl.handles import Texture
from ..gl.shader import ShaderError, read_shader

Tables = Callable[[], Mapping[str, Any]]
Textures = dict[str, Texture]


def check_functions(glsl: Path, signatures: Iterable[str]) -> None:
    """Raise ShaderError if a GLSL file cannot be read or lacks a signature (result, name and first type)."""
    text = re.sub(r"\s+", " ", read_shader(glsl))
    for signature in signatures:
        head, given = signature.split("(")
        if not re.search(rf"\b{head} ?\( ?(?:(?:const|in) )*{given.split()[0]}\b", text):
            raise ShaderError(f"{glsl}: no function {signature}")


def takes_view(glsl: Path, function: str) -> bool:
    """Whether the function of this name in a GLSL file takes anything besides one vec2 or vec3; also true if the file
    has no such function that returns a vec2 or vec3."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", " ", read_shader(glsl), flags=re.S)
    return not re.search(rf"\bvec[23]\s+{function}\s*\(\s*(?:(?:const|in)\s+)*vec[23]\s+\w+\s*\)", text)


def set_uniforms(program: Any, values: Mapping[str, Any]) -> None:
    """Set a program's uniforms by name; skip names that the compiled program does not have."""
    for name, value in values.items():
        if name in program:
            program[name].value = value


def dithering(noise: np.ndarray | None) -> tuple[dict[str, object], Tables]:
    """Return the macro DITHERED of `dither.glsl` and a function that returns its lookup table by name: noise of shape
    (height, width, 4). Without noise the macro is 0 and there are no tables."""
    return {"DITHERED": int(noise is not None)}, lambda: {} if noise is None else {"dither": noise}


class Passes:
    """A pass that encodes into targets and a pass that decodes from them, in a context manager that releases both.

    Args:
        shaders: the encoding pass and the decoding pass.
        defines, names: macros and included files, as for `Source`.
        formats: formats of the targets between the two passes, by the decoding pass's sampler names.
        tables: function that returns the lookup tables of both passes, by sampler name.

    Raises:
        ShaderError: one of the shaders does not compile.
    """

    def __init__(
        self,
        device: Device,
        shaders: tuple[str, str],
        defines: Mapping[str, object],
        names: Mapping[str, Path | tuple[Path, ...]],
        formats: Mapping[str, Storage],
        tables: Tables = dict,
    ):
        self._device, self._formats = device, formats
        with ExitStack() as stack:
            self._encode, self._decode = (
                device.owned(stack, device.fragment_pass(shader, defines, names)) for shader in shaders
            )
            self._tables = uploaded(device, stack, tables())
            self._stack = stack.pop_all()

    def __enter__(self):
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _through(self, results: Sequence[Storage], **given: np.ndarray) -> list[np.ndarray]:
        """Write arrays of shape (height, width, channels), given by sampler name, to the codec's targets; return the
        decoding pass's outputs as arrays, one for each format in `results`.

        Raises:
            FormatError: the device cannot render to a format.
        """
        device = self._device
        with ExitStack() as stack:
            sources = uploaded(device, stack, given)
            kept = self._written_textures(stack, sources)
            targets = [device.owned(stack, device.target(kept["texels"].size, storage)) for storage in results]
            device.render(self._decode, targets, **kept, **sources, **self._tables)
            return [read_pixels(texture) for texture in targets]

    def _written_textures(self, stack: ExitStack, sources: Textures) -> Textures:
        """Return the targets, by name, after the encoding pass has filled them; they are released with the stack."""
        device, size = self._device, next(iter(sources.values())).size
        kept = {name: device.owned(stack, device.target(size, storage)) for name, storage in self._formats.items()}
        device.render(self._encode, list(kept.values()), **sources, **self._tables)
        return kept


def uploaded(device: Device, stack: ExitStack, arrays: Mapping[str, np.ndarray]) -> Textures:
    """Return arrays as textures with the same names, released with the stack."""
    return {name: device.owned(stack, device.upload(array)) for name, array in arrays.items()}


def exact(
    device: Device,
    shader: str,
    defines: Mapping[str, object],
    names: Mapping[str, Path],
    given: Sequence[np.ndarray],
    outputs: int,
    tables: Tables = dict,
    **uniforms: Any,
) -> list[np.ndarray]:
    """Run a compute shader on float32 arrays of shape (count, 4), without storage, with macros `defines`, included
    files `names` and uniforms; return its `outputs` results, arrays of the same shape."""
    with ExitStack() as stack:
        compute: Any = device.owned(stack, device.compute_pass(shader, defines, names))
        bind(compute, uploaded(device, stack, tables()))
        set_uniforms(compute, uniforms)
        return device.computed(compute, given, outputs)
