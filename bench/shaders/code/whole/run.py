"""Runs a file of a layout's code: rows of surfaces and texels in, rows of texels and surfaces out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from .....gbuffer.gl.device import device
from .....gbuffer.gl.shader import ShaderError
from ....ground.machine import children
from ...isa import spirv
from ..emit import LANGUAGES
from ..run import c, hlsl, opengl, wgsl
from ..run.sources import compile_with, folder, run_apart
from .emit import GBufferCode
from .fields import surface_leaves, target_leaves

HERE = Path(__file__).parent
GROUP = 64
# Rows that are run at once: it bounds a run's memory, and the files that C and Python may write.
BLOCK = 2**15
MAIN = "run_main"


def run(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    """What a file's functions give.

    Args:
        rows: uint32 of shape (count, numbers of a surface and of the targets), floats by their bits: what `pack` is
            given, then what `unpack` is given.

    Returns:
        uint32 of that shape: what `pack` gives, then what `unpack` gives.

    Raises:
        MissingError: a tool is missing; what to install.
        ShaderError: it does not compile or run.
        NoDeviceError: there is no GL device.
    """
    parts = [RUNS[code.language](code, rows[at : at + BLOCK]) for at in range(0, len(rows), BLOCK)]
    return np.concatenate(parts)


def _wrapped(name: str, code: GBufferCode) -> str:
    made = Environment(loader=FileSystemLoader(HERE), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    surface, targets = surface_leaves(code.texts), target_leaves(code.texts)
    return made.get_template(name).render(code=code.body, prefix=code.prefix, surface=surface, targets=targets)


def dispatched(compute: Any, rows: np.ndarray, width: int) -> np.ndarray:
    """What a compute shader of OpenGL makes of rows: uint32 of shape (count, width)."""
    gl, count = device(), len(rows)
    with ExitStack() as stack:
        given = gl.owned(stack, gl.context.buffer(np.ascontiguousarray(rows)))
        made = gl.owned(stack, gl.context.buffer(reserve=count * width * 4))
        for binding, buffer in enumerate((given, made)):
            buffer.bind_to_storage_buffer(binding)
        compute.run(group_x=-(-count // GROUP))
        return np.frombuffer(made.read(), np.uint32).reshape(count, width)


def _run_text(text: str, rows: np.ndarray) -> np.ndarray:
    with ExitStack() as stack:
        compute = device().owned(stack, opengl.compiled(text, str))
        return dispatched(compute, rows, rows.shape[1])


def _glsl(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    return _run_text(_wrapped("run_glsl.j2", code), rows)


def _hlsl(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    spirv.compiler()
    with folder() as place:
        given = place / "code.hlsl"
        given.write_text(_wrapped("run_hlsl.j2", code), encoding="utf-8")
        compile_with([spirv.COMPILER, "-D", *hlsl.OPTIONS, "-o", str(place / "code.spv"), str(given)])
        return _run_text(hlsl.glsl_of(place / "code.spv"), rows)


def _wgsl(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    gpu = wgsl.device()
    import wgpu

    usage = wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC
    try:
        module = gpu.create_shader_module(code=_wrapped("run_wgsl.j2", code))
        program = gpu.create_compute_pipeline(layout="auto", compute={"module": module, "entry_point": MAIN})
    except wgpu.GPUError as error:
        raise ShaderError(f"{code.name}: {' '.join(str(error).split())[:400]}") from error
    data = np.ascontiguousarray(rows)
    buffers = [gpu.create_buffer_with_data(data=data, usage=usage), gpu.create_buffer(size=data.nbytes, usage=usage)]
    bound = [{"binding": at, "resource": {"buffer": buffer}} for at, buffer in enumerate(buffers)]
    commands = gpu.create_command_encoder()
    compute = commands.begin_compute_pass()
    compute.set_pipeline(program)
    compute.set_bind_group(0, gpu.create_bind_group(layout=program.get_bind_group_layout(0), entries=bound))
    compute.dispatch_workgroups(-(-len(rows) // GROUP))
    compute.end()
    gpu.queue.submit([commands.finish()])
    return np.frombuffer(gpu.queue.read_buffer(buffers[1]), np.uint32).reshape(rows.shape)


def _c(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    with folder() as place:
        (place / "code.h").write_text(code.body, encoding="utf-8")
        (place / "rows.c").write_text(_wrapped("run_c.j2", code), encoding="utf-8")
        np.ascontiguousarray(rows).tofile(place / "given.bin")
        sizes = {"RUN_GIVEN": rows.shape[1], "RUN_MADE": rows.shape[1]}
        options = ("-std=c99", "-D_GNU_SOURCE", "-iquote", str(place), *c.EXACT, *c.macros(c.LIMITS | sizes))
        command = [c.compiler(), *options, str(place / "rows.c"), str(c.MAIN), "-lm"]
        program = c.compiled(command, place / "code", {})
        run_apart(place / "code.h", [str(program), str(place), str(len(rows))])
        return np.fromfile(place / "made.bin", np.uint32).reshape(rows.shape)


def _python(code: GBufferCode, rows: np.ndarray) -> np.ndarray:
    with folder() as place:
        (place / "code.py").write_text(code.body, encoding="utf-8")
        np.save(place / "given.npy", rows)
        kinds = (_kinds((field.name, field.kind) for field in code.texts.contents.fields),)
        kinds += (_kinds((target.name, target.kind) for target in code.texts.targets),)
        run_apart(place / "code.py", children.python(f"{__package__}.python_child", str(place), code.prefix, *kinds))
        return np.load(place / "made.npy")


def _kinds(named: Any) -> str:
    return ",".join(kind for _, kind in named)


RUNS: Mapping[str, Callable[[GBufferCode, np.ndarray], np.ndarray]] = MappingProxyType(
    {"glsl": _glsl, "hlsl": _hlsl, "wgsl": _wgsl, "c": _c, "python": _python}
)
NOT_RUN = tuple(name for name in LANGUAGES if name not in RUNS)
