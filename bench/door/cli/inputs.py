"""The files that a command reads, by the words that were typed: it replaces none of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from ...ground.output.errors import UsageError
from ...ground.output.replacing import reads
from ...ground.user_files import file_names, file_of, files_in, is_file
from .typed import read_values


def keep_inputs(words: Sequence[str], options: Sequence[Any]) -> None:
    """Have nothing replace what a command reads; arguments as for `added_up`."""
    values = list(read_values(words, options))
    # Looked up once a file is to be replaced: what a scene or a layout refers to takes a second to import.
    reads[:] = [cache(lambda: tuple(_files_of(values)))]


def _files_of(values: Iterable[str]) -> Iterator[Path]:
    """The files that values name, alone or in lists, and those that are read with them."""
    from ...run.measuring import companions

    for word in (word for value in values for word in (value, *file_names(value))):
        # What is wrong with a word is said by what reads it.
        with suppress(UsageError):
            for name in (word, *files_in(word)):
                if is_file(Path(), str(file_of(name))):
                    yield from (file_of(name), *companions(name))
