"""GPU families as `--family` names them."""

from __future__ import annotations

from ..ground.choose import choose
from ..ground.options import gpu_families
from ..ground.options.words import Names
from ..ground.output.errors import UsageError
from .roofline.rates import GPUS


def families_named(names: Names) -> list[str]:
    """Return the GPU families with these names, each once; a vendor's name stands for all of its families.

    Raises:
        UsageError: a name is unknown. For a GPU that `roofline` knows, the message names its family.
    """
    if gpu := next((word for word in map(str, names) if word.lower() in GPUS), None):
        raise UsageError(f"{gpu} is a GPU, not a family; use its family, {GPUS[gpu.lower()].family}")
    return list(dict.fromkeys(name for several in choose("family", names, gpu_families.CHOICES) for name in several))
