"""What this machine can measure, and what to install where it cannot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.util import find_spec
from types import MappingProxyType

from ...gbuffer.gl.device import NoDeviceError, device
from ..isa import spirv
from ..machine.devices import require_jax
from ..metrics.images import require_flip
from ..output.errors import MissingError


def _jax() -> str:
    try:
        require_jax()
    except MissingError as error:
        return str(error)
    return ""


def _gl() -> str:
    try:
        device()
    except NoDeviceError as error:
        return str(error)
    return ""


def _compilers() -> str:
    found = (
        (spirv.version(spirv.COMPILER), spirv.NO_COMPILER),
        (spirv.version(spirv.OPTIMISER), spirv.NO_OPTIMISER),
    )
    return "; ".join(missing for version, missing in found if not version)


def _flip() -> str:
    try:
        require_flip()
    except MissingError as error:
        return str(error)
    return ""


def _parquet() -> str:
    return "" if find_spec("pyarrow") else "pip install pyarrow"


# What there is to do, and what is missing for it; nothing where all is there.
CAPABILITIES: Mapping[str, Callable[[], str]] = MappingProxyType(
    {
        "quality, depth, frames by JAX": _jax,
        "quality by GLSL, render, lights, sweep": _gl,
        "instructions (cost --isa, pick)": _compilers,
        "render --flip": _flip,
        "-o FILE.parquet": _parquet,
    }
)


def capabilities() -> dict[str, str]:
    """ "yes" for each of CAPABILITIES, or "no" with what to install."""
    return {name: f"no: {missing}" if (missing := lacks()) else "yes" for name, lacks in CAPABILITIES.items()}
