"""GLSL compute shaders on the OpenGL device, which are the last step of the runners for several languages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from typing import Any

import numpy as np

from .....gbuffer.codecs.harness import uploaded
from .....gbuffer.gl.device import Device, bind, device
from .....gbuffer.gl.shader import ShaderError
from .interface import GIVEN, MADE, Interface, Ran, Run, ran_of, rows_of
from .sources import first_complaint

GROUP = 64  # invocations, as the shaders here have them


def device_name() -> str:
    """Return the name of the OpenGL device and its OpenGL version, as text. Raises NoDeviceError."""
    gl = device()
    return f"{gl.renderer.split(' (')[0]} (OpenGL {gl.version.split()[0]})"


@contextmanager
def prepared(compute: Any, interface: Interface) -> Iterator[Run]:
    """Yield a function that runs a compiled shader with its tables on rows; shader and tables are released
    afterwards.

    A sampler has the name of its table, or a translator's name that contains the table's name.
    """
    gl = device()
    with ExitStack() as stack:
        gl.owned(stack, compute)
        bind_tables(compute, interface.tables, stack)

        def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
            return ran_of(*dispatched(gl, compute, rows_of(n, view, texels)), interface)

        yield run


def bind_tables(compute: Any, tables: Mapping[str, np.ndarray], stack: ExitStack) -> None:
    """Bind tables as textures, which are released with the stack."""
    bind(compute, uploaded(device(), stack, _tables_by_sampler(compute, tables)))


def _tables_by_sampler(compute: Any, tables: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    samplers = {name: max((table for table in tables if table in name), key=len, default="") for name in compute}
    return {sampler: tables[table] for sampler, table in samplers.items() if table}


def dispatched(gl: Device, compute: Any, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Run a shader on rows, GIVEN per normal, and return its two outputs: float32 of shape (MADE count, 4) and uint32
    of shape (count, 4)."""
    count = len(given) // GIVEN
    if not count:
        return np.zeros((0, 4), np.float32), np.zeros((0, 4), np.uint32)
    with ExitStack() as stack:
        sizes = (MADE * count * 16, count * 16)
        outputs = [gl.owned(stack, gl.context.buffer(reserve=size)) for size in sizes]
        source = gl.owned(stack, gl.context.buffer(given))
        for binding, buffer in enumerate([source, *outputs]):
            buffer.bind_to_storage_buffer(binding)
        compute.run(group_x=-(-count // GROUP))
        rows, words = (np.frombuffer(b.read(size), np.uint32) for b, size in zip(outputs, sizes, strict=True))
    return rows.view(np.float32), words


def compiled(text: str, explain: Any) -> Any:
    """Return a compiled GLSL compute shader. `explain` rewrites the driver's message for the user's file.

    Raises:
        ShaderError: it does not compile.
        NoDeviceError: there is no OpenGL device.
    """
    context = device().context
    try:
        return context.compute_shader(text)
    except Exception as error:  # moderngl's own, which only gbuffer/gl imports
        raise ShaderError(first_complaint(explain(_without_head(str(error))))) from error


def _without_head(log: str) -> str:
    """Return a driver's log without the words that moderngl adds at its beginning."""
    return log.replace("GLSL Compiler failed", "").replace("compute_shader", "")
