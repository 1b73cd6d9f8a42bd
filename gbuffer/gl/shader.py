"""Shader loading: includes each file once, and names the user's file and line in an error."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cache, lru_cache, wraps
from pathlib import Path
from typing import TypeVar

from ...encodings.codecs.files import file_text

ROOM = Path(__file__).resolve().parents[1]
SUFFIXES = (".glsl", ".vert", ".frag", ".comp")
# Of the encodings: not the pairs, which may have the name of another kind's.
SHARED = ("*.glsl", "shared/*.glsl", "storages/*.glsl")
_INCLUDE = re.compile(r'\s*#include\s+(?:"(?P<file>[^"]+)"|(?P<name>\w+))\s*$')
# "0:12(5): error" is Mesa's way to say line 12; "0(12) : error" is NVIDIA's; "stdin:12:" or "0:12:" glslang's.
_PLACE = re.compile(r"\b0(?::(\d+)\(\d+\)|\((\d+)\))|\b(?:stdin|0):(\d+)(?=:)")

T = TypeVar("T")
Line = tuple[str, Path, int]
# A line with what it includes: nothing, or the match of _INCLUDE.
Parsed = tuple[Line, re.Match[str] | None]


class ShaderError(Exception):
    """A shader that cannot be read or does not compile; the message names the file and the line."""


@cache
def shaders() -> Mapping[str, Path]:
    """Return this package's shaders and the encodings' shared files by name. Raises ShaderError for duplicates."""
    paths: dict[str, Path] = {}
    shared = (path for pattern in SHARED for path in (ROOM.parent / "encodings").glob(pattern))
    for path in sorted([*ROOM.rglob("*.*"), *shared]):
        if path.suffix in SUFFIXES and path != paths.setdefault(path.name, path):
            raise ShaderError(f"two shaders have the same name: {paths[path.name]} and {path}")
    return paths


class Source:
    """A shader's text with every include expanded once.

    An include is a file next to the including file, or else a shader of `shaders`, by its name only.

    The origin of each line is kept here and not passed to the compiler with `#line`: Mesa omits the source string
    number from some of its messages, and then names the wrong file.

    Args:
        path: the shader: a name in `shaders`, or a path.
        defines: macros to define at the top; unused macros are left out, so that identical programs have identical
            text.
        names: the file or files that replace `#include NAME`, by name.
        may_read: function that takes the path, with links resolved, of a file outside this program and returns
            whether it may be included; other files are not opened. None if the files have been checked before.
    """

    def __init__(
        self,
        path: str | Path,
        defines: Mapping[str, object] | None = None,
        names=None,
        may_read: Callable[[Path], bool] | None = None,
    ):
        self.place = main = _resolved_path(Path(shaders().get(str(path), path)))
        stand_for = tuple(sorted((name, _as_files(target)) for name, target in (names or {}).items()))
        is_own = all(map(_is_own, (main, *(file for _, files in stand_for for file in files))))
        expanded = _expanded_of_own(main, stand_for) if is_own else _expanded(main, stand_for, may_read)
        (version, *rest), body = expanded
        macros = {name: glsl_value(value) for name, value in (defines or {}).items()}
        mentioned = _words(body) | _words(" ".join(macros.values()))
        head = [(f"#define {name} {value}", main, 1) for name, value in macros.items() if name in mentioned]
        self._lines: list[Line] = [version, *head, *rest]
        self.text = _joined_text([version, *head]) + body

    @property
    def files(self) -> list[Path]:
        """The source file of each line of the text."""
        return [path for _, path, _ in self._lines]

    def explain(self, log: str) -> str:
        """Return a compiler's message with its line numbers replaced by file names and their line numbers."""

        def place(match: re.Match[str]) -> str:
            index = int(match[1] or match[2] or match[3]) - 1
            if not 0 <= index < len(self._lines):
                return match[0]
            _, path, number = self._lines[index]
            return f"{path}:{number}"

        return _PLACE.sub(place, log.strip())


def _as_files(target: str | Path | Sequence[Path]) -> tuple[Path, ...]:
    return (Path(target),) if isinstance(target, str | Path) else tuple(map(Path, target))


@lru_cache(maxsize=256)
def _words(text: str) -> frozenset[str]:
    return frozenset(re.findall(r"\w+", text))


@cache
def _is_own(path: Path) -> bool:
    """Whether a path is in the folder `gbuffer` or `encodings` and contains no `..`."""
    return ".." not in path.parts and any(path.is_relative_to(ROOM.parent / room) for room in (ROOM.name, "encodings"))


def _once_of_own(function: Callable[..., T]) -> Callable[..., T]:
    """Return the function with its results cached for the program's own files, which do not change and are requested
    again and again. Its first argument is a path."""
    kept = cache(function)

    @wraps(function)
    def call(path: Path, *more: str) -> T:
        return (kept if _is_own(path) else function)(path, *more)

    return call


@_once_of_own
def _resolved_path(path: Path) -> Path:
    return path.resolve()


def _joined_text(lines: Iterable[Line]) -> str:
    return "".join(f"{line}\n" for line, _, _ in lines)


def _expanded(
    main: Path, names: Sequence[tuple[str, tuple[Path, ...]]], may_read: Callable[[Path], bool] | None = None
) -> tuple[list[Line], str]:
    """Return the lines of a shader and its includes, with the file and the number of each line, and the text of all
    lines but the first. Each file is included once. Raises ShaderError."""
    stand_for, seen = dict(names), set()

    def expand(path: Path) -> list[Line]:
        seen.add(path)
        lines: list[Line] = []
        for line, match in _lines(path):
            lines += include(line, match) if match else [line]
        return lines

    def include(line: Line, match: re.Match[str]) -> list[Line]:
        _, path, number = line
        named = match["name"]
        if named and named not in stand_for:
            raise ShaderError(f"{path}:{number}: unknown include name {named}")
        targets = [*map(_resolved_path, stand_for[named])] if named else [_beside(path, match["file"])]
        for target in targets:
            if may_read and not (_is_own(target) or may_read(target)):
                raise ShaderError(
                    f"{main}: the included file {target} is outside the folder of the shader; move it there"
                )
        return [included_line for target in targets if target not in seen for included_line in expand(target)]

    lines = expand(main)
    return lines, _joined_text(lines[1:])


# Frames ask for the same programs again and again, with other macros; the program's own files stay as they are.
_expanded_of_own = lru_cache(maxsize=256)(_expanded)


@_once_of_own
def _lines(path: Path) -> list[Parsed]:
    """Return each line of a shader file as (text, path, number), with the match of its #include or None. Raises
    ShaderError."""
    lines: list[Parsed] = []
    for number, line in enumerate(read_shader(path).splitlines(), 1):
        match = _INCLUDE.match(line) if "#include" in line else None
        # moderngl expands what is left of them, in comments as well, and knows no files.
        lines.append(((line.replace("#inc", "# inc"), path, number), match))
    return lines


@_once_of_own
def _beside(path: Path, file: str) -> Path:
    """Return the resolved path of the file that a shader at `path` includes: next to the shader, or else the shader
    of that name in `shaders`. If neither exists, return the path next to the shader."""
    near = path.parent / file
    with suppress(OSError):  # of a name that is too long, which whoever reads it says
        if near.is_file():
            return near.resolve()
    return Path(shaders().get(file, near)).resolve()


def read_shader(path: Path) -> str:
    """A shader file's text. Raises ShaderError."""
    try:
        return file_text(path)
    except (OSError, ValueError) as error:
        raise ShaderError(f"{path}: {error}") from error


def glsl_value(value) -> str:
    """Return a value as GLSL: a tuple as `int[n](...)` if all its numbers are ints, else as `float[n](...)`; numbers
    and text unchanged."""
    if isinstance(value, tuple) and all(isinstance(v, int) for v in value):
        return f"int[{len(value)}]({', '.join(map(str, value))})"
    if isinstance(value, tuple):
        return f"float[{len(value)}]({', '.join(repr(float(v)) for v in value)})"
    return repr(value) if isinstance(value, float) else str(value)
