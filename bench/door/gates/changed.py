"""Gates that read a file: a pre-commit hook checks only those."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

from ...ground.options.source_options import in_names
from ...ground.output.errors import UsageError
from ...ground.user_files import ENDINGS, UserFile, files_in
from ...shaders.languages.source import Source
from .gates import Gate


def gates_that_read(files: Sequence[Path], gates: Iterable[Gate], path: Path) -> list[Gate]:
    """Return the gates that read one of some files: the file of the gates, their baseline, a file that an option
    names, its Python twin, or a file that it includes.

    Args:
        path: the file of the gates.

    Raises:
        UsageError: a gate names a file that is in the working directory instead of the folder of the gates.
    """
    changed = {file.resolve() for file in files}
    return [gate for gate in gates if changed & {file.resolve() for file in _read_by(gate, path)}]


def _read_by(gate: Gate, path: Path) -> Iterator[Path]:
    yield path
    if gate.baseline:
        yield gate.baseline
    options = in_names(gate.located())
    for word in (word for name in gate.files() for word in map(str, options[name])):
        yield from map(Path, files_in(word))
        if any(Path(file).suffix.lower() in ENDINGS for file in files_in(word)):
            yield from _with_includes(word)


def _with_includes(word: str) -> Iterator[Path]:
    """Yield the files of a shader, includes too, each followed by its path with the ending .py, whether or not
    that exists. Stop without an error if the shader cannot be read: errors are reported when it is measured."""
    with suppress(UsageError):
        for file in Source(UserFile(word)).files:
            yield from (file, file.with_suffix(".py"))
