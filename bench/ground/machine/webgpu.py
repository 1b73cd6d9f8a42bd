"""The devices that wgpu finds through Vulkan or, on macOS, Metal. Imports wgpu only when needed."""

from __future__ import annotations

import os
import tempfile
from functools import cache
from typing import Any

from .systems.people import how_to_install, webgpu_api

API = webgpu_api()
NO_DRIVER = f"WGSL needs a {API} driver; install one ({how_to_install('mesa-vulkan-drivers')})"


@cache
def adapters() -> tuple[Any, ...]:
    """Return wgpu's adapters in the driver's order. Raises ImportError if wgpu is not installed."""
    import wgpu
    from wgpu.backends.wgpu_native.extras import set_instance_extras

    set_instance_extras(backends=[API])
    # The driver looks for a display there, and says on standard error that there is no such folder.
    os.environ.setdefault("XDG_RUNTIME_DIR", tempfile.gettempdir())
    return tuple(wgpu.gpu.enumerate_adapters_sync())
