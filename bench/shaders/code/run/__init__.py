"""What runs a codec's source code: a module for each language, imported when it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from types import MappingProxyType

from .interface import Runner

# The module of each language, by the name that `--to` knows it by.
LANGUAGES: Mapping[str, str] = MappingProxyType(
    {name: f"{__name__}.{name}" for name in ("glsl", "essl", "hlsl", "slang", "wgsl", "msl", "c", "python")}
)


def runner(language: str) -> Runner:
    """What runs files of a language, a key of LANGUAGES."""
    return import_module(LANGUAGES[language]).RUNNER
