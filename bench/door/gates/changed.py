"""Selection of the gates that read certain files, so that a pre-commit hook checks only these gates."""

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
    """Return the gates that read any of `files`. A gate reads its gates file, its baseline, the files that its
    options name, their Python twins and the files that shaders include.

    Args:
        path: the gates file.

    Raises:
        UsageError: a gate names a file that is in the working directory instead of the folder of the gates file.
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
    """Yield a shader's files, including the files that it includes, each followed by its path with the extension .py,
    whether or not that file exists. Yield nothing if the shader cannot be read: measuring it reports the error."""
    with suppress(UsageError):
        for file in Source(UserFile(word)).files:
            yield from (file, file.with_suffix(".py"))
