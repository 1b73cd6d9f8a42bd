"""Answers of commands, kept in the user's cache folder and reused until something that they depend on changes."""

from __future__ import annotations

import platform
import re
import shutil
import sysconfig
import time
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

from ..ground.choose import names_a_file
from ..ground.compilers.tools import states
from ..ground.machine.settings import settings
from ..ground.machine.systems.files import state_of
from ..ground.machine.systems.system_files import loaded, processor_kind
from ..ground.output import cache, errors
from ..ground.output.sources import sources
from ..ground.output.writing import say
from ..tables.table import Table

# What a name of a file has, and names of the catalogue have not.
FILE_LIKE = re.compile(r"/|\\|\.[A-Za-z]")
Value = str | int | float | bool | None


def answered(key: str, command: Callable[[], int]) -> int:
    """Print the cached answer for a key, or run a command and cache its answer; with an empty key, cache nothing.

    Returns:
        the command's exit status.
    """
    if not key:
        return command()
    kept = cache.read_figures(key)
    if kept and all(state_of(Path(path)) == state for path, state in kept["files"].items()):
        for is_error, text in kept["said"]:
            (errors.tell if is_error else say)(text)
        errors.tell(f"answer cached on {kept['date']}; to measure again, use --anew")
        return kept["status"]
    with errors.hearing() as messages:
        status = command()
    cache.write(
        key, {"date": time.strftime("%Y-%m-%d %H:%M"), "status": status, "said": messages, "files": _libraries()}
    )
    return status


def key_of_answer(table: Table, options: Any, *printed: str) -> str:
    """Return the key of an answer: the question, the form of the output, the program, and the machine with its
    packages and compilers; empty if the question names files, because files may change."""
    asked = [(field.name, getattr(options, field.name)) for field in fields(options)]
    values = [value for _, given in asked for value in _flat(given)]
    if not all(isinstance(value, Value) for value in values) or any(map(_may_be_a_file, values)):
        return ""
    width = shutil.get_terminal_size((120, 40)).columns
    machine = [platform.platform(), *processor_kind(), *map(str, settings().items()), *_packages(), *states()]
    return cache.key_of("answer", table.name, repr(asked), *printed, str(width), sources(), *machine)


def _flat(value: Any) -> Iterator[Any]:
    if isinstance(value, tuple):
        for each in value:
            yield from _flat(each)
    else:
        yield value


def _may_be_a_file(value: Value) -> bool:
    return isinstance(value, str) and (bool(FILE_LIKE.search(value)) or names_a_file(value))


def _packages() -> list[str]:
    """Return the installed packages by the names of their folders, such as numpy-2.1.0.dist-info, sorted."""
    folders = {Path(sysconfig.get_path(name)) for name in ("purelib", "platlib")}
    return sorted(path.name for folder in folders for path in folder.glob("*.dist-info"))


def _libraries() -> dict[str, list[int] | None]:
    """Return, by path, the states of the libraries that this process has loaded, including drivers, and of their
    folders, into which newer libraries would be put. Libraries in the cache are left out."""
    paths = {Path(path) for path in loaded() if ".so" in path and not Path(path).is_relative_to(cache.folder())}
    return {str(path): state_of(path) for path in sorted(paths | {path.parent for path in paths})}
