"""The devices that tables are measured on, or why they are missing."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import jax

from ....gbuffer.environment.prefilter import keep_levels_by
from ....gbuffer.gl.device import Device, NoDeviceError, device
from ..output import cache
from ..output.errors import MissingError
from ..output.kept_arrays import kept_arrays
from .memory import require_memory
from .systems.system_files import processor_kind


def require_jax() -> None:
    """Raise MissingError if JAX has too little memory, or no device, for example because JAX_PLATFORMS is unknown."""
    require_memory()
    keep_programs()
    try:
        jax.devices()
    except Exception as error:
        reason = str(error).strip().splitlines() or ["the platform does not start"]
        raise MissingError(f"JAX has no device to compute on: {reason[0]}; unset JAX_PLATFORMS") from error


def keep_programs() -> None:
    """Make JAX keep its compiled programs in the user's cache folder, for later processes.

    A folder that the user has chosen for JAX is kept, and so is a disabled cache (JAX_ENABLE_COMPILATION_CACHE=0).
    """
    chosen: Any = jax.config
    if chosen.jax_compilation_cache_dir is None and chosen.jax_enable_compilation_cache and not cache.is_off():
        try:
            cache.make_folder(programs_folder())
            cache.keep_only_files(programs_folder())
        except OSError:
            return
        jax.config.update("jax_compilation_cache_dir", str(programs_folder()))
        # An entry that was damaged, or cannot be written, is no more than one that is not there.
        warnings.filterwarnings("ignore", message="Error (reading|writing) persistent compilation cache entry")
        # What takes less than a second is kept too, however small: there are hundreds of these.
        jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
        jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)


def programs_folder() -> Path:
    """Return the folder for compiled programs, which differs for each version of JAX and each kind of processor."""
    return cache.folder() / "programs" / cache.key_of(jax.__version__, *processor_kind())[:16]


def found_device() -> tuple[Device | None, str]:
    """Return the OpenGL device and an empty text; if it is missing, None and the reason."""
    # What it draws under an environment is kept: to filter one takes seconds.
    keep_levels_by(kept_arrays)
    try:
        return device(), ""
    except NoDeviceError as error:
        return None, str(error)


def require_device() -> Device:
    """Return the OpenGL device. Raises MissingError if this machine has none."""
    gl, missing = found_device()
    if not gl:
        raise MissingError(missing)
    return gl
