"""The measurements that this machine can make, and what to install for the others."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.util import find_spec
from types import MappingProxyType

from ..ground.compilers import tools
from ..ground.machine.devices import require_device, require_jax
from ..ground.machine.systems import walls
from ..ground.output import cache
from ..ground.output.errors import MissingError
from ..measures.metrics.visibility import require_rays
from ..shaders.code.run import c, wgsl
from ..shaders.languages.language import require_language
from ..subjects.codecs.half.compute import half_device
from .machine import require_intel, require_nvidia, require_radeons


def _require_unpackers() -> None:
    missing = [name for name in ("DracoPy", "meshoptimizer") if find_spec(name) is None]
    if missing:
        raise MissingError(f"no {' and no '.join(missing)}; pip install normalbench[compressed]")


# What there is to do, and what raises MissingError where something is missing for it.
CAPABILITIES: Mapping[str, Callable[[], object]] = MappingProxyType(
    {
        "quality, mix, depth, frames, vectors by JAX": require_jax,
        "quality and mix by GLSL, render, effects, lights, sweep": require_device,
        "instructions on Radeons (cost --isa, pick)": require_radeons,
        "instructions on Intel (cost --isa --family intel)": require_intel,
        "instructions on NVIDIA (cost --isa --family nvidia)": require_nvidia,
        "glTF files compressed with Draco or meshoptimizer": _require_unpackers,
        "quality --arithmetic half by GLSL": half_device,
        "quality by WGSL (wgpu and a Vulkan driver)": wgsl.device,
        "code in C, and fast rows of quality (cc)": c.compiler,
        "code in C from your files (Landlock)": walls.require,
        "code in Slang (slangc)": lambda: tools.path_of(tools.SLANG),
        "rays (method_rms of effects)": require_rays,
        "encoders in HLSL": lambda: require_language("HLSL"),
        "encoders in Slang": lambda: require_language("Slang"),
        "cache of compiled programs and figures": cache.require_folder,
    }
)


def capabilities() -> dict[str, str]:
    """Return "yes" for each of CAPABILITIES, or "no" with what to install."""
    return {name: _yes_or_why(require) for name, require in CAPABILITIES.items()}


def _yes_or_why(require: Callable[[], object]) -> str:
    try:
        require()
    except MissingError as error:
        return f"no: {error}"
    return "yes"
