"""Reasons why a codec's row may have no figures."""

from __future__ import annotations

from ...gbuffer.gl.device import FormatError, NoDeviceError
from ...gbuffer.gl.shader import ShaderError
from ..shaders.code.twin import NoTwinError

# What measuring by one back end may raise: there is no device, it cannot, or JAX has no such code.
UNMEASURABLE = (NoDeviceError, ShaderError, FormatError, NoTwinError)
