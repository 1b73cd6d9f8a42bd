"""Loads shaders: includes once, with line numbers kept, and names the user's file and line in an error."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

SHADERS = Path(__file__).parent / "shaders"
_INCLUDE = re.compile(r'\s*#include\s+(?:"(?P<file>[^"]+)"|(?P<name>\w+))\s*$')
# "2:12(5): error" is Mesa's way to say source string 2, line 12; "2(12) : error" is NVIDIA's.
_PLACE = re.compile(r"\b(\d+)(?::(\d+)\(\d+\)|\((\d+)\))")


class ShaderError(Exception):
    """A shader that cannot be read or does not compile; the message names the file and the line."""


class Source:
    """A shader's text with every include expanded once.

    Args:
        path: the shader, in the project's shader folder if relative.
        defines: macros set at its head.
        names: files that stand behind `#include NAME`.
    """

    def __init__(self, path: str | Path, defines: Mapping[str, object] | None = None, names=None):
        self._names: Mapping[str, Path] = names or {}
        self._files: list[Path] = []
        version, *lines = self._expand((SHADERS / path).resolve())[1:]
        head = [f"#define {name} {glsl_value(value)}" for name, value in (defines or {}).items()]
        self.text = "\n".join([version, *head, "#line 2 0", *lines, ""])

    def _expand(self, path: Path) -> list[str]:
        index = len(self._files)
        self._files.append(path)
        lines = [f"#line 1 {index}"]
        for number, line in enumerate(read_shader(path).splitlines(), 1):
            lines += self._include(path, number, line) if _INCLUDE.match(line) else [line]
            if _INCLUDE.match(line):
                lines.append(f"#line {number + 1} {index}")
        return lines

    def _include(self, path: Path, number: int, line: str) -> list[str]:
        match = _INCLUDE.match(line)
        assert match
        if match["name"] and match["name"] not in self._names:
            raise ShaderError(f"{path}:{number}: nothing is named {match['name']}")
        target = self._names[match["name"]] if match["name"] else path.parent / match["file"]
        target = Path(target).resolve()
        return [] if target in self._files else self._expand(target)

    def explain(self, log: str) -> str:
        """A compiler's message with file names in place of source string numbers."""

        def place(match: re.Match[str]) -> str:
            index, line = int(match[1]), match[2] or match[3]
            return f"{self._files[index]}:{line}" if index < len(self._files) else match[0]

        return _PLACE.sub(place, log.strip())


def read_shader(path: Path) -> str:
    """A shader file's text. Raises ShaderError."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ShaderError(f"{path}: cannot be read as a shader: {error}") from error


def glsl_value(value) -> str:
    """A Python number, tuple of numbers, or text as GLSL writes it."""
    if isinstance(value, tuple):
        return f"float[{len(value)}]({', '.join(repr(float(v)) for v in value)})"
    return repr(value) if isinstance(value, float) else str(value)
