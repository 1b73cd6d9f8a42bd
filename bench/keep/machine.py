"""Facts about this machine, which every results folder records."""

from __future__ import annotations

import os
import platform
from importlib.metadata import version

import jax

from ...encodings.storages.storage import STORAGES
from ...gbuffer.codecs.loops import MANY, loop_limit
from ...gbuffer.gl.device import NoDeviceError, device
from ..ground.compilers import tools
from ..ground.machine.settings import ROWS_BY, settings
from ..ground.machine.systems.system_files import processor_lines
from ..ground.native import library
from ..ground.options.gpu_families import ANV, HASVK, NVRTC, RADV
from ..ground.output.errors import MissingError
from ..shaders.isa import isa, spirv

ROUNDS = {
    "nearest": "nearest",
    "truncate": "truncate (nearest is rounded in the shader)",
    "other": "neither nearest nor truncate (both are rounded in the shader)",
}
PACKAGES = ("normalbench", "numpy", "jax", "jaxlib", "moderngl", "pandas", "matplotlib", "vulkan", "openimageio")


def processor() -> str:
    """Return the processor's name as text."""
    names = [line.split(":", 1)[1].strip() for line in processor_lines() if line.startswith("model name")]
    return next(iter(names), platform.processor() or platform.machine())


def machine() -> dict[str, str]:
    """Return the facts that a result depends on, by name: versions, processor, JAX's devices and the OpenGL device."""
    facts = {
        "python": platform.python_version(),
        "system": platform.platform(),
        "processor": f"{processor()}, {os.cpu_count()} cores",
        **{package: version(package) for package in PACKAGES},
        ROWS_BY: "compiled C" if library.compiler() else "XLA",
        "jax devices": ", ".join(f"{d.platform} {d.device_kind}" for d in jax.devices()),
    }
    return facts | {f"setting {name}": value for name, value in settings().items()} | _gl_facts() | compilers()


def _gl_facts() -> dict[str, str]:
    try:
        gl = device()
    except NoDeviceError as error:
        return {"GL": str(error)}
    return {
        "GL": gl.renderer,
        "GL version": gl.version,
        "GL is software": "yes" if gl.is_software else "no",
        "GL largest texture": str(gl.max_size),
        "GL targets at once": str(gl.max_targets),
        "GL samples a pixel": str(gl.max_samples),
        "GL loops": f"stop after {most} iterations" if (most := loop_limit(gl)) else f"run {MANY} iterations or more",
        **{f"GL rounds {s.name}": ROUNDS[gl.native_rounding(s)] for s in STORAGES.values()},
    }


def compilers() -> dict[str, str]:
    """Return the versions of the GPU drivers' compilers and of the shader compilers, by kind; for a missing compiler,
    what to install."""
    return isa.driver_versions() | _compiler_facts()


def _compiler_facts() -> dict[str, str]:
    """Return the versions of the shader compilers, by kind; for a missing compiler, what to install."""
    glslang, optimiser = spirv.version(spirv.COMPILER), spirv.version(spirv.OPTIMISER)
    return {
        "GLSL compiler": spirv.title(glslang) if glslang else spirv.NO_COMPILER,
        "SPIR-V optimiser": optimiser.splitlines()[0] if optimiser else spirv.NO_OPTIMISER,
        "HLSL translator": tools.version(tools.SPIRV_CROSS),
        "Slang compiler": tools.version(tools.SLANG),
    }


def require_compilers() -> None:
    """Raise MissingError if a shader compiler is missing."""
    missing = [fact for fact in _compiler_facts().values() if fact in (spirv.NO_COMPILER, spirv.NO_OPTIMISER)]
    if missing:
        raise MissingError("; ".join(missing))


def require_radeons() -> None:
    """Raise MissingError if RADV cannot compile."""
    _require(RADV)


def require_intel() -> None:
    """Raise MissingError if one of Intel's drivers cannot compile, or the null device for it is missing."""
    _require(ANV, HASVK)


def require_nvidia() -> None:
    """Raise MissingError if NVIDIA's CUDA compiler or its disassembler is missing."""
    _require(NVRTC)


def _require(*libraries: str) -> None:
    require_compilers()
    missing = dict.fromkeys(reason for library in libraries if (reason := isa.missing(library)))
    if missing:
        raise MissingError("; ".join(missing))


def examine() -> list[dict[str, str]]:
    """Return rows of name and value about this machine, ending with the measurements that it can make. "GL rounds
    ..." is the OpenGL device's own conversion; if a codec needs a different conversion, the shader rounds before the
    write."""
    from .capabilities import capabilities

    return [{"name": name, "value": value} for name, value in (machine() | capabilities()).items()]
