"""A file of source code and the program around it: texts, compilers' messages, and compilers."""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from .....gbuffer.gl.shader import Line, ShaderError, Source
from ....ground.machine import children
from ....ground.output.errors import MissingError
from .interface import Interface

# Slang's compiler loads 200 MB before it begins.
SECONDS = 60


class EmittedSource(Source):
    """A program around a file: the file stands where the program says `#include CODE`.

    Args:
        wrapper: the program, whose first line stays the first one.
        code: the file; its own `#version` is left out.
        made: how the language makes a structure: see `Interface.defines_with`.
    """

    def __init__(self, wrapper: Path, code: Path, interface: Interface, made: str = "{}({})"):
        super().__init__(wrapper, interface.defines_with(", ".join, made), {"CODE": code})
        self._lines: list[Line] = [self._kept_line(line) for line in self._lines]
        self.text = "".join(f"{line}\n" for line, _, _ in self._lines)

    def _kept_line(self, line: Line) -> Line:
        text, path, number = line
        return ("" if path != self.place and text.lstrip().startswith("#version") else text, path, number)


@contextmanager
def folder() -> Iterator[Path]:
    """An empty folder, gone afterwards."""
    with tempfile.TemporaryDirectory(prefix="normalbench-") as made:
        yield Path(made)


def run_apart(path: Path, command: Sequence[str]) -> None:
    """Run what was made of a file, in a process of its own for a limited time.

    Raises:
        ShaderError: it does not end, or ends badly.
        PermissionError: it may not be run.
    """
    try:
        done = children.finished(command, SECONDS)
    except subprocess.TimeoutExpired as error:
        raise ShaderError(f"{path}: it did not end within {SECONDS} s") from error
    if done.returncode:
        raise ShaderError(f"{path}: it {children.how_it_ended(done)}")


def required(tool: str | None, install: str) -> str:
    """A tool that is there. Raises MissingError, which says what to install."""
    if not tool:
        raise MissingError(install)
    return tool


def compile_with(command: Sequence[str], source: Source | None = None, given: Path | None = None) -> str:
    """What a compiler prints, which runs in a process of its own for a limited time.

    Args:
        source: what it is given, whose lines come from several files.
        given: where that was written.

    Raises:
        ShaderError: it refuses the file or does not end; its first complaint, with file and line.
    """
    tool = Path(command[0]).name
    try:
        done = children.finished(command, SECONDS)
    except subprocess.TimeoutExpired as error:
        raise ShaderError(f"{tool} took longer than {SECONDS} s") from error
    if done.returncode:
        # Under the name that `Source.explain` knows.
        log = f"{done.stderr}\n{done.stdout}".replace(str(given), "0")
        said = first_complaint(log)
        raise ShaderError(f"{tool}: {source.explain(said) if source else said}")
    return done.stdout


def first_complaint(log: str) -> str:
    """The first line of a compiler's log that names an error, or the first one with words; with its place, where that
    is a line of its own: ` --> FILE:LINE:COLUMN`."""
    lines = [line.strip() for line in log.splitlines() if re.search(r"\w", line)]
    errors = [line for line in lines if re.search(r"\berror\b", line, re.I)]
    said = (errors or lines or ["it failed without a word"])[0].removeprefix("ERROR: ")
    place = re.search(r"--> (\S+:\d+):\d+", log)
    return f"{place[1]}: {said}"[:400] if place and errors else said[:400]


def first_line(tool: str, *words: str) -> str:
    """The first line that a tool prints of its version."""
    done = children.finished([tool, *words], SECONDS)
    return (f"{done.stdout}\n{done.stderr}".strip().splitlines() or ["no version"])[0].strip()
