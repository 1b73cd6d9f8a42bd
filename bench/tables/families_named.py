"""GPU families as `--family` names them."""

from __future__ import annotations

from ..ground.choose import choose
from ..ground.options import gpu_families
from ..ground.options.words import Names
from ..ground.output.errors import UsageError
from .roofline.rates import GPUS


def families_named(names: Names) -> list[str]:
    """Return the families of names, each once: families, and vendors for all of theirs.

    Raises:
        UsageError: an unknown name; of a GPU that `roofline` knows, the message says its family.
    """
    if gpu := next((word for word in map(str, names) if word.lower() in GPUS), None):
        raise UsageError(f"{gpu} is a GPU, not a family; use its family, {GPUS[gpu.lower()].family}")
    return list(dict.fromkeys(name for several in choose("family", names, gpu_families.CHOICES) for name in several))
