"""What runs a codec's source code: a module for each language, imported when it is asked for."""

from __future__ import annotations

from importlib import import_module

from .interface import Runner


def runner(language: str) -> Runner:
    """What runs files of a language, a key of `emit.LANGUAGES`."""
    return import_module(f"{__name__}.{language}").RUNNER
