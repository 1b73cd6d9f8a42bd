"""A file of source code and the program around it: texts, compilers and their messages."""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from .....gbuffer.gl.shader import Line, ShaderError, Source
from ....ground.compilers import tools
from ....ground.compilers.text import Text
from ....ground.machine import children
from ....ground.machine.systems.walls import Wall
from .interface import Interface

# Slang's compiler loads 200 MB before it begins.
SECONDS = 60


class EmittedSource(Source):
    """A program with a file in place of the program's line `#include CODE`.

    Args:
        wrapper: the program, whose first line stays first.
        code: the file; its own `#version` is left out.
        made: the language's text for a structure; see `construct` in `Interface.defines_with`.
    """

    def __init__(self, wrapper: Path, code: Path, interface: Interface, construct: str = "{}({})"):
        super().__init__(wrapper, interface.defines_with(", ".join, construct), {"CODE": code})
        self._lines: list[Line] = [self._kept_line(line) for line in self._lines]
        self.text = "".join(f"{line}\n" for line, _, _ in self._lines)

    def _kept_line(self, line: Line) -> Line:
        text, path, number = line
        return ("" if path != self.place and text.lstrip().startswith("#version") else text, path, number)


@contextmanager
def folder() -> Iterator[Path]:
    """Yield the path of an empty folder, which is deleted afterwards."""
    with tempfile.TemporaryDirectory(prefix="normalbench-") as path:
        yield Path(path)


def run_apart(path: Path, command: Sequence[str], wall: Wall | None = None) -> None:
    """Run a program made from a file, in a separate process for a limited time, behind a wall if one is given.

    Raises:
        ShaderError: it does not end, or fails.
        PermissionError: it must not be run.
    """
    try:
        done = children.finished(wall.around(command) if wall else command, SECONDS)
    except subprocess.TimeoutExpired as error:
        raise ShaderError(f"{path}: did not end within {SECONDS} s") from error
    if done.returncode:
        raise ShaderError(f"{path}: {children.how_it_ended(done)}")


def compile_with(
    tool: str,
    words: Sequence[str],
    place: Path,
    files: Mapping[str, Text],
    explain: Callable[[str], str] = str,
    wall: Wall | None = None,
) -> str:
    """Return the standard output of a compiler, which runs in a separate process for a limited time.

    Args:
        words: its options and the names of files in the folder.
        place: the folder.
        files: the texts by their names in the folder; messages call the first text 0.
        explain: rewrites a message for the user's file.
        wall: the compiler's permissions, if the text may be a user's.

    Raises:
        ShaderError: the compiler refuses the file or does not end; its first error, with file and line.
        MissingError: the compiler is not installed.
    """
    try:
        done = tools.run(tool, words, place, files, SECONDS, wall)
    except tools.ToolError as error:
        raise ShaderError(str(error)) from error
    if done.status:
        # Under the name that `Source.explain` knows.
        log = re.sub(rf"\S*\b{re.escape(next(iter(files), '-'))}", "0", f"{done.err}\n{done.out}")
        raise ShaderError(f"{tool}: {explain(first_complaint(log))}")
    return done.out


def first_complaint(log: str) -> str:
    """Return the first line of a compiler's log that names an error, else the first line with words. If the log has
    the place of an error on a separate line, ` --> FILE:LINE:COLUMN`, the place is put in front."""
    lines = [line.strip() for line in log.splitlines() if re.search(r"\w", line)]
    errors = [line for line in lines if re.search(r"\berror\b", line, re.I)]
    complaint = (errors or lines or ["failed without a message"])[0].removeprefix("ERROR: ")
    place = re.search(r"--> (\S+:\d+):\d+", log)
    return f"{place[1]}: {complaint}"[:400] if place and errors else complaint[:400]
