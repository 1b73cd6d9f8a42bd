"""Runners of a codec's functions: a module for each language, imported when it is needed."""

from __future__ import annotations

from importlib import import_module

from ....ground.output.errors import MissingError
from .interface import Runner

# Languages that are written and never run here.
NEVER_RUN = ("msl",)


def runner(language: str) -> Runner:
    """Return the runner of a language, a key of `emit.LANGUAGES`. Raises MissingError if the language has none."""
    if language in NEVER_RUN:
        raise MissingError("MSL code runs only on Apple's Metal")
    return import_module(f"{__name__}.{language}").RUNNER
