"""The devices that tables are measured on, or why there is none."""

from __future__ import annotations

import jax

from ...gbuffer.gl.device import Device, NoDeviceError, device
from ..output.errors import MissingError


def require_jax() -> None:
    """Raises MissingError where JAX has no device to compute on, as an unknown JAX_PLATFORMS leaves it."""
    try:
        jax.devices()
    except Exception as error:
        reason = str(error).strip().splitlines() or ["the platform does not start"]
        raise MissingError(f"JAX has no device to compute on: {reason[0]}; unset JAX_PLATFORMS") from error


def found_device() -> tuple[Device | None, str]:
    """The GL device; or None, and why there is none."""
    try:
        return device(), ""
    except NoDeviceError as error:
        return None, str(error)


def require_device() -> Device:
    """The GL device. Raises MissingError where there is none."""
    gl, missing = found_device()
    if not gl:
        raise MissingError(missing)
    return gl
