"""Runners for files of a layout's code: rows of surfaces and texels in, rows of texels and surfaces out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from .....gbuffer.gl.device import device
from ....ground.compilers import tools
from ....ground.compilers.text import own
from ...judged import judged_text
from ..emit import LANGUAGES
from ..kinds.normal import is_catalogues
from ..run import c, hlsl, opengl, wgsl
from ..run.sources import folder, run_apart
from .emit import GBufferCode
from .fields import surface_leaves, target_leaves
from .surfaces import PLACES

HERE = Path(__file__).parent
GROUP = 64
# Rows that are run at once: it bounds a run's memory, and the files that C may write.
BLOCK = 2**15
MAIN = "run_main"
# A number of a row and a vector of three, by language.
ARGUMENTS = {
    "glsl": ("uintBitsToFloat(run_given[from + {}u])", "vec3({numbers})"),
    "hlsl": ("asfloat(run_given[from + {}u])", "float3({numbers})"),
    "wgsl": ("bitcast<f32>(run_given[start + {}u])", "vec3f({numbers})"),
    "c": ("given[{}]", "({prefix}_vec3){{{numbers}}}"),
}


def run(code: GBufferCode, rows: np.ndarray, settings: np.ndarray) -> np.ndarray:
    """Run a file's functions and return their results.

    Args:
        rows: uint32 of shape (count, numbers of a surface and of the targets), floats by their bits: the input of
            `pack`, then the input of `unpack`.
        settings: the other inputs of both functions, as from `surfaces.settings`.

    Returns:
        uint32 of the shape of `rows`: the results of `pack`, then the results of `unpack`.

    Raises:
        MissingError: a tool is missing; what to install.
        ShaderError: the file does not compile or run.
        NoDeviceError: there is no OpenGL device.
    """
    given = np.concatenate([rows, *(settings[:, PLACES[name]] for name in code.settings)], axis=1)
    parts = [RUNS[code.language](code, given[start : start + BLOCK]) for start in range(0, len(rows), BLOCK)]
    return np.concatenate(parts)


def _made(code: GBufferCode) -> int:
    """Return the number of values that both functions return."""
    return len(surface_leaves(code.texts)) + len(target_leaves(code.texts))


def _wrapped(name: str, code: GBufferCode) -> str:
    environment = Environment(
        loader=FileSystemLoader(HERE), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    surface, targets = surface_leaves(code.texts), target_leaves(code.texts)
    count, (settings, given) = _made(code), _settings_text(code)
    about = {"code": code.body, "prefix": code.prefix, "settings": settings, "given": given, "made": count}
    return environment.get_template(name).render(about, surface=surface, targets=targets)


def _settings_text(code: GBufferCode) -> tuple[str, int]:
    """Return the text of both functions' arguments after the first, each preceded by a comma, and the number of
    values in a row that includes them; empty text without settings."""
    number, vector = ARGUMENTS.get(code.language, ("", ""))
    text, offset = "", _made(code)
    for name in code.settings:
        size = PLACES[name].stop - PLACES[name].start
        numbers = ", ".join(number.format(offset + i) for i in range(size))
        text += f", {vector.format(prefix=code.prefix, numbers=numbers) if size > 1 else numbers}"
        offset += size
    return text, offset


def dispatched(compute: Any, rows: np.ndarray, width: int) -> np.ndarray:
    """Run an OpenGL compute shader on rows and return its output: uint32 of shape (count, width)."""
    gl, count = device(), len(rows)
    with ExitStack() as stack:
        given = gl.owned(stack, gl.context.buffer(np.ascontiguousarray(rows)))
        output = gl.owned(stack, gl.context.buffer(reserve=count * width * 4))
        for binding, buffer in enumerate((given, output)):
            buffer.bind_to_storage_buffer(binding)
        compute.run(group_x=-(-count // GROUP))
        return np.frombuffer(output.read(), np.uint32).reshape(count, width)


def _run_text(text: str, code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    with ExitStack() as stack:
        compute = device().owned(stack, opengl.compiled(text, str))
        opengl.bind_tables(compute, code.tables, stack)
        return dispatched(compute, rows, _made(code))


def _glsl(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    return _run_text(_wrapped("run_glsl.j2", code), code, rows)


def _hlsl(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    with folder() as place:
        return _run_text(hlsl.glsl_of(place, judged_text(_wrapped("run_hlsl.j2", code), "hlsl")), code, rows)


def _wgsl(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    text = judged_text(_wrapped("run_wgsl.j2", code), "wgsl")
    program = wgsl.Program(wgsl.device(), code.name, text, code.tables, 1)
    data = np.ascontiguousarray(rows)
    (output,) = program(data, len(rows), [len(rows) * _made(code) * data.itemsize])
    return output.reshape(len(rows), -1)


def _c(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    with folder() as place:
        texts = {"code.h": code.body, "rows.c": _wrapped("run_c.j2", code)}
        texts |= {name: data.decode() for name, data in code.files([]).items() if name.endswith("_tables.h")}
        files = {name: judged_text(text, "c") for name, text in texts.items()} | {"main.c": own(c.MAIN)}
        np.ascontiguousarray(rows).tofile(place / "given.bin")
        sizes = {"RUN_GIVEN": rows.shape[1], "RUN_MADE": _made(code)}
        words = [*c.LANGUAGE, *c.EXACT, *c.macros(c.LIMITS | sizes), "rows.c", "main.c", "-lm"]
        is_ours = is_catalogues(code.layout.encoding)
        wall = None if is_ours else c.compilers_wall(tools.C, place)
        program = c.compiled(tools.C, words, place, files, place / "code.h", wall)
        wall = None if is_ours else c.programs_wall(program)
        run_apart(place / "code.h", [str(program), str(place), str(len(rows))], wall)
        return np.fromfile(place / "made.bin", np.uint32).reshape(len(rows), -1)


RUNS: Mapping[str, Callable[[GBufferCode, np.ndarray], np.ndarray]] = MappingProxyType(
    {"glsl": _glsl, "hlsl": _hlsl, "wgsl": _wgsl, "c": _c}
)
NOT_RUN = tuple(name for name in LANGUAGES if name not in RUNS)
