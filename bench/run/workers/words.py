"""What `--on` may say. Imports nothing heavy: every start of the program does."""

from __future__ import annotations

import re
from dataclasses import dataclass
from importlib.util import find_spec

from ...ground.options.counts import whole_number
from ...ground.output.errors import MissingError, UsageError

MOST_LOCAL = 256
HELP = "Measure in other processes: local:4 for four on this machine, or a dask scheduler, tcp://HOST:PORT."
_LOCAL = re.compile(r"local:(?P<count>.+)")
_ADDRESS = re.compile(r"(?:tcp|tls)://(?:[\w.-]+|\[[0-9a-fA-F:]+\]):(?P<port>\d{1,5})")


@dataclass(frozen=True)
class Local:
    """So many worker processes on this machine."""

    count: int


@dataclass(frozen=True)
class Address:
    """A scheduler of dask that runs already."""

    text: str


def place_named(word: str) -> Local | Address:
    """What a word of `--on` stands for.

    Raises:
        UsageError: it stands for nothing.
    """
    if match := _LOCAL.fullmatch(word.strip()):
        try:
            count = whole_number(match["count"])
        except ValueError:
            count = 0
        if not 1 <= count <= MOST_LOCAL:
            raise UsageError(f"--on {word}: from 1 to {MOST_LOCAL} worker processes, such as local:4")
        return Local(count)
    return Address(checked_address("--on", word))


def check_place(on: str | None) -> None:
    """Raises UsageError or MissingError for what `--on` cannot say; None will do."""
    if on is not None:
        named = place_named(on)
        if isinstance(named, Address):
            require_dask()


def checked_address(option: str, word: str) -> str:
    """The address of a scheduler. Raises UsageError for anything else."""
    match = _ADDRESS.fullmatch(word.strip())
    if not match or not 0 < int(match["port"]) < 2**16:
        local = "local:N, such as local:4, or " if option == "--on" else ""
        raise UsageError(f"{option} {word or repr(word)}: say {local}tcp://HOST:PORT, such as tcp://10.0.0.5:8786")
    return word.strip()


def require_dask() -> None:
    """Raises MissingError where dask.distributed is not installed."""
    if find_spec("distributed") is None:
        raise MissingError("workers of a scheduler need dask.distributed; pip install 'normalbench[workers]'")
