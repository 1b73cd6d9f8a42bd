"""The values of `--on`. Imports nothing heavy, because every start of the program imports it."""

from __future__ import annotations

import re
from importlib.util import find_spec

from ...ground.options.counts import whole_number
from ...ground.output.errors import MissingError, UsageError

MOST_LOCAL = 256
HELP = "Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT."
_LOCAL = re.compile(r"local:(?P<count>.+)")
_ADDRESS = re.compile(r"(?:tcp|tls)://(?:[\w.-]+|\[[0-9a-fA-F:]+\]):(?P<port>\d{1,5})")


def place_named(word: str) -> int | str:
    """Return the number of processes on this machine, or the address of a scheduler, that a word of `--on` names.

    Raises:
        UsageError: the word names neither.
    """
    if match := _LOCAL.fullmatch(word.strip()):
        try:
            count = whole_number(match["count"])
        except ValueError:
            count = 0
        if not 1 <= count <= MOST_LOCAL:
            raise UsageError(f"--on {word}: use 1 to {MOST_LOCAL} worker processes, such as local:4")
        return count
    return checked_address("--on", word)


def check_place(on: str | None) -> None:
    """Raise UsageError or MissingError if `--on` cannot have this value; None is allowed."""
    if on is not None and isinstance(place_named(on), str):
        require_dask()


def checked_address(option: str, word: str) -> str:
    """Return the address of a scheduler, stripped. Raises UsageError that names `option` for any other word."""
    match = _ADDRESS.fullmatch(word.strip())
    if not match or not 0 < int(match["port"]) < 2**16:
        local = "local:N, such as local:4, or " if option == "--on" else ""
        raise UsageError(f"{option} {word or repr(word)}: use {local}tcp://HOST:PORT, such as tcp://10.0.0.5:8786")
    return word.strip()


def require_dask() -> None:
    """Raise MissingError if dask.distributed is not installed."""
    if find_spec("distributed") is None:
        raise MissingError("workers of a scheduler need dask.distributed; pip install 'normalbench[workers]'")
