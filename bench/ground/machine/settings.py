"""External settings that figures may depend on."""

from __future__ import annotations

import os

# Variables that change what JAX and Mesa compute, but for where they keep what they have compiled.
SETTINGS = ("XLA_FLAGS", "JAX_", "MESA_", "GALLIUM_", "GALLIVM_", "LP_", "LIBGL_", "NIR_")
KEEPS = "CACHE"
# The fact of a run that says whose arithmetic its normals have.
ROWS_BY = "normals by"


def settings() -> dict[str, str]:
    """Return, by name, the environment variables that are set and may change what JAX and Mesa compute."""
    return {name: os.environ[name] for name in sorted(os.environ) if name.startswith(SETTINGS) and KEEPS not in name}
