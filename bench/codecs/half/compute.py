"""A device that computes in 16 bits: Vulkan through wgpu, and what it makes of a compute shader."""

from __future__ import annotations

import os
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ....gbuffer.gl.device import FormatError
from ....gbuffer.gl.shader import Source
from ...isa.spirv import compiled
from ...output.errors import MissingError

FEATURE = "shader-f16"
GROUP = 64
EXCESS = Path(__file__).with_name("excess.comp")


@cache
def half_device() -> Any:
    """The wgpu device.

    Raises:
        MissingError: wgpu is not installed, or no Vulkan device here has 16-bit floats; what to install.
    """
    try:
        import wgpu
        from wgpu.backends.wgpu_native.extras import set_instance_extras
        from wgpu.utils import device
    except ImportError as error:
        raise MissingError(f"half arithmetic by glsl needs wgpu ({error}); pip install wgpu") from error
    set_instance_extras(backends=["Vulkan"])
    # The driver looks for a display there, and says on standard error that there is no such folder.
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
    found = [adapter for adapter in wgpu.gpu.enumerate_adapters_sync() if FEATURE in adapter.features]
    if not found:
        said = "install one (Debian: apt-get install mesa-vulkan-drivers)"
        raise MissingError(f"half arithmetic by glsl needs a Vulkan driver with 16-bit floats; {said}")
    device.preconfigure_default_device("normalbench", adapter=found[0], required_features={FEATURE})
    return device.get_default_device()


def name() -> str:
    """What a row calls the device, and whether it rounds every step. Raises MissingError as `half_device` does."""
    steps = "some steps keep more digits" if keeps_digits() else "every step rounded"
    return f"{half_device().adapter.info['device']}, Vulkan, {steps}"


@cache
def keeps_digits() -> bool:
    """Whether a step's result may have more digits than a half, until it is stored."""
    one, two = (np.full((GROUP, 4), 1 + 2.0**-power, np.float32) for power in (10, 9))
    return bool(computed(Source(EXCESS), one, two).any())


def computed(source: Source, given: np.ndarray, views: np.ndarray) -> np.ndarray:
    """What a compute shader makes of float32 arrays of shape (count, 4): an array of that shape.

    Raises:
        MissingError: no device or no compiler.
        ShaderError: it does not compile.
        FormatError: the device refuses it.
    """
    from wgpu.utils.compute import compute_with_buffers

    half_device()
    binary = compiled(source, "comp", counted=False).binary
    inputs = {at: np.ascontiguousarray(array, np.float32) for at, array in enumerate((given, views))}
    try:
        made = compute_with_buffers(inputs, {2: (given.size, "f")}, binary, n=-(-len(given) // GROUP))
    except Exception as error:  # whatever the driver raises
        raise FormatError(f"{half_device().adapter.info['device']}: {' '.join(str(error).split())[:300]}") from error
    return np.frombuffer(made[2], np.float32).reshape(given.shape)
