"""A device that computes in 16 bits, through wgpu and Vulkan, and the running of compute shaders on it."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .....gbuffer.gl.device import FormatError
from .....gbuffer.gl.shader import Source
from ....ground.machine.systems.people import how_to_install
from ....ground.machine.webgpu import API, adapters
from ....ground.output.errors import MissingError
from ....shaders.isa.spirv import compiled

FEATURE = "shader-f16"
GROUP = 64
EXCESS = Path(__file__).with_name("excess.comp")


@cache
def half_device() -> Any:
    """Return the wgpu device with 16-bit floats.

    Raises:
        MissingError: wgpu is not installed, or no Vulkan device here has 16-bit floats; the message says what to
            install.
    """
    try:
        from wgpu.utils import device

        half_adapters = [adapter for adapter in adapters() if FEATURE in adapter.features]
    except ImportError as error:
        raise MissingError(f"half arithmetic with --backend glsl needs wgpu ({error}); pip install wgpu") from error
    if not half_adapters:
        advice = f"install one ({how_to_install('mesa-vulkan-drivers')})"
        raise MissingError(f"half arithmetic with --backend glsl needs a {API} driver with 16-bit floats; {advice}")
    device.preconfigure_default_device("normalbench", adapter=half_adapters[0], required_features={FEATURE})
    return device.get_default_device()


def name() -> str:
    """Return the device's description for rows: its name, its API, and whether it rounds every step. Raises
    MissingError like `half_device`."""
    steps = "some steps keep more digits" if keeps_digits() else "every step rounded"
    return f"{half_device().adapter.info['device']}, {API}, {steps}"


@cache
def keeps_digits() -> bool:
    """Whether intermediate results may have more digits than a half."""
    first, two = (np.full((GROUP, 4), 1 + 2.0**-power, np.float32) for power in (10, 9))
    return bool(computed(Source(EXCESS), first, two).any())


def computed(source: Source, given: np.ndarray, views: np.ndarray) -> np.ndarray:
    """Run a compute shader on two float32 arrays of shape (count, 4); return an array of the same shape.

    Raises:
        MissingError: no device or no compiler is installed.
        ShaderError: the shader does not compile.
        FormatError: the device rejects the shader.
    """
    from wgpu.utils.compute import compute_with_buffers

    half_device()
    binary = compiled(source, "comp", counted=False).binary
    inputs = {binding: np.ascontiguousarray(array, np.float32) for binding, array in enumerate((given, views))}
    try:
        outputs = compute_with_buffers(inputs, {2: (given.size, "f")}, binary, n=-(-len(given) // GROUP))
    except Exception as error:  # whatever the driver raises
        raise FormatError(f"{half_device().adapter.info['device']}: {' '.join(str(error).split())[:300]}") from error
    return np.frombuffer(outputs[2], np.float32).reshape(given.shape)
