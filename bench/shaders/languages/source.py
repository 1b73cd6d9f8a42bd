"""A user's file with its includes, and the origin of each line."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from copy import copy
from pathlib import Path
from typing import NamedTuple

from ....encodings.codecs.files import MOST_TEXT, file_text
from ...ground.compilers.lines import bare
from ...ground.output.errors import UsageError
from ...ground.user_files import ENDINGS, TRANSLATED, UserFile, is_file
from .embedded import shader_text
from .items import defined_in, items, without

# Some engines have no marks around the name; in place of one, a macro is a name of no file.
_INCLUDE = re.compile(r'[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>|(?<=[ \t])([\w./\\-]+))[ \t]*')
# Modules of Slang: the lines of one stand in place of what names it.
_IMPORT = re.compile(r'[ \t]*(?:__exported[ \t]+)?(?:import|__include)[ \t]+(?:([\w.]+)|"([^"]+)")[ \t]*;[ \t]*')
_MODULE = re.compile(r"[ \t]*(?:module|implementing)[ \t]+[\w.]+[ \t]*;[ \t]*")
SLANG = ".slang"
_CONDITION = re.compile(r"[ \t]*#[ \t]*(if|elif|else|endif)(?:n?def)?\b")
# What keeps a file from being compiled twice: #pragma once, or all of it in #ifndef NAME and #define NAME.
_ONCE = re.compile(r"[ \t]*#[ \t]*pragma[ \t]+once[ \t]*")
_UNLESS = re.compile(r"[ \t]*#[ \t]*(?:ifndef[ \t]+|if[ \t]*![ \t]*defined[ \t]*\(?[ \t]*)(\w+)[ \t]*\)?[ \t]*")
_MACRO = re.compile(r"[ \t]*#[ \t]*define[ \t]+(\w+)")
# How often files are included at most, and how many lines they have together: more is a bomb.
MOST_INCLUDES, MOST_LINES = 2000, 1 << 19
# How many folders above a file's are searched for what it includes.
MOST_ABOVE = 8
_ANY_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include\b", re.M)


class Line(NamedTuple):
    """A line of a program: its text, its file, its line number there, and its error, if known."""

    text: str
    path: Path
    number: int
    wrong: str = ""


# Of declarations: the number of one of so many equal parts, counted from 0.
Part = tuple[int, int]


def _homes() -> Iterator[Path]:
    """Yield the path of the home folder, as given and with its links resolved; nothing if the folder is unknown."""
    with suppress(RuntimeError, OSError):
        yield from (Path.home(), Path.home().resolve())


def _resolved(path: Path) -> Path:
    """Return a path with its links resolved; the absolute path if they cannot be resolved or the name is invalid."""
    try:
        return path.absolute().resolve()
    except (RuntimeError, OSError, ValueError):
        return path.absolute()


def _searched(folder: Path) -> list[Path]:
    """Return the folders to search for includes: a folder and at most eight above it, up to a repository's root. Of
    these, only the first may be the home folder, a folder above it, or the file system's root."""
    paths, homes = [folder], list(_homes())
    for above in folder.parents[:MOST_ABOVE]:
        if (paths[-1] / ".git").exists() or any(home.is_relative_to(above) for home in homes) or above == above.parent:
            break
        paths.append(above)
    return paths


def _option_for(name: str) -> str:
    """Return the text of the option that names the folder of a missing file, such as `--include Packages=FOLDER`."""
    first, _, rest = name.lstrip("/").partition("/")
    is_virtual = rest and (name.startswith("/") or first == "Packages")
    return f"--include {f'{first}=' * bool(is_virtual)}FOLDER"


# The guard of a file with #pragma once, and of one in a language without a preprocessor.
_PRAGMA, _NATURE = (-1,), (-2,)


def _read(own: Path, path: Path, language: str) -> _Text:
    """Return the text of the file `own` without comments, with its includes and its include guard; messages name the
    file `path`. Raises UsageError."""
    is_wgsl = (language or TRANSLATED.get(path.suffix.lower())) == "WGSL"
    try:
        text = bare(shader_text(file_text(own), path.suffix.lower()), is_wgsl)
    except (OSError, ValueError) as error:
        raise UsageError(f"{path}: {error}") from error
    if "/*" in text:
        line = text.count("\n", 0, text.index("/*")) + 1
        raise UsageError(f"{path}:{line}: a comment that begins with /* is not closed")
    lines = text.split("\n")
    includes = {i: match[match.lastindex or 0] for i, line in enumerate(lines) if (match := _INCLUDE.fullmatch(line))}
    if len(_ANY_INCLUDE.findall(text)) != len(includes):
        raise UsageError(f'{path}: an #include must be written as #include "FILE" on one line')
    if is_wgsl:
        return _Text(lines, includes, _NATURE)
    imports: dict[int, str] = {}
    if (language or TRANSLATED.get(path.suffix.lower())) == "Slang":
        matches = {i: match for i, line in enumerate(lines) if (match := _IMPORT.fullmatch(line))}
        # A name's points part folders; what is quoted is a path.
        imports = {i: (match[1] or "").replace(".", "/") or match[2] for i, match in matches.items()}
        includes |= {i: path.removesuffix(SLANG) + SLANG for i, path in imports.items()}
        lines = ["" if _MODULE.fullmatch(line) else line for line in lines]
    guard = _PRAGMA if any(map(_ONCE.fullmatch, lines)) else _guard(lines)
    return _Text(lines, includes, guard, frozenset(imports))


class _Text(NamedTuple):
    """The text of a file that was read.

    Attributes:
        lines: its lines, without comments.
        includes: the included file, by line index.
        guard: the line indices of its include guard, or a marker for a guard of another form; empty without a guard.
        imports: the indices of the lines that import a module, which is read once.
    """

    lines: list[str]
    includes: dict[int, str]
    guard: tuple[int, ...]
    imports: frozenset[int] = frozenset()


def _guard(lines: list[str]) -> tuple[int, ...]:
    """Return the line indices of a guard, #ifndef NAME and #endif, around a whole text; else an empty tuple."""
    written = [i for i, line in enumerate(lines) if line.strip()]
    first = _UNLESS.fullmatch(lines[written[0]]) if len(written) > 2 else None
    if not first or not re.match(rf"[ \t]*#[ \t]*define[ \t]+{first[1]}\b", lines[written[1]]):
        return ()
    depth = 0
    for index in written:
        match = _CONDITION.match(lines[index])
        depth += {"if": 1, "endif": -1}.get(match[1], 0) if match else 0
        if (not depth and index != written[-1]) or (match and match[1] in ("else", "elif") and depth == 1):
            return ()
    return () if depth else (written[0], written[-1])


def _defined(lines: list[Line]) -> set[str]:
    """Return the names that lines define at the top level."""
    return set(defined_in("".join(f"{line.text}\n" for line in lines)))


def _renamed(lines: list[Line], names: set[str], mark: str) -> Iterator[Line]:
    """Yield lines, preceded by a #define that renames each of the names to NAME_MARK, and followed by each #undef."""
    where = lines[0].path
    yield from (Line(f"#define {name} {name}_{mark}", where, 1) for name in sorted(names))
    yield from lines
    yield from (Line(f"#undef {name}", where, 1) for name in sorted(names))


class _Branches:
    """The #if and #else branches that contain a line, each with its own number."""

    def __init__(self) -> None:
        self.now: tuple[int, ...] = ()
        self._numbers = itertools.count()

    def follow(self, line: str) -> None:
        """Update the branches for the text after a line."""
        match = _CONDITION.match(line) if "#" in line else None
        if not match:
            return
        around = self.now if match[1] == "if" else self.now[:-1]
        self.now = around if match[1] == "endif" else (*around, next(self._numbers))


class Source:
    """A file together with its includes, which may be in the file's folder, in folders below it or above it up to the
    repository's root, or in the folders named by --include.

    A file is included wherever an #include names it, in every branch. A file with an include guard is included only
    where it may not have been read yet. A file never includes itself again.

    An #include of a file that is missing or elsewhere becomes an #error, which is harmless in an inactive branch.

    Raises:
        UsageError: a file cannot be read, the files are too large or too many together, or they are nested too
            deeply.
    """

    def __init__(self, file: UserFile):
        self.file = file
        self.mains = file.paths
        self.path = path = self.mains[0]
        self.settings = file.settings
        # What is left out of its declarations, and their places.
        self.part: Part = (0, 0)
        self.left_out: list[str] = []
        self.files: dict[Path, Path] = {}
        # The one that is read, and where its includes are searched.
        self._main = self.path
        self._folders, self._left = _searched(_resolved(path.parent)), MOST_TEXT
        self._texts: dict[Path, _Text] = {}
        self._open: list[Path] = []
        # By a file that guards itself, the branches in which it has been read.
        self._read_in: dict[Path, list[tuple[int, ...]]] = {}
        self._branches, self._count, self._lines_left = _Branches(), 0, MOST_LINES
        if missing := next((root for _, root in self.settings.roots if not Path(root).is_dir()), ""):
            raise UsageError(f"--include {missing}: no such folder; name the folder that holds the included files")
        # Only files below one of these may be read.
        self._tops = [self._folders[-1], *(_resolved(Path(root)) for _, root in self.settings.roots)]
        try:
            self.lines = list(self._all_lines())
        except RecursionError:
            raise UsageError(f"{path}: its #includes are nested too deeply") from None
        self.text = "".join(f"{line.text}\n" for line in self.lines)

    def _all_lines(self) -> Iterator[Line]:
        """Yield the lines of the macros, the preludes and the file or files."""
        for macro in self.settings.defines:
            name, _, value = macro.partition("=")
            yield Line(f"#define {name} {value if '=' in macro else 1}", Path("--define"), 1)
        for prelude in self.settings.preludes:
            if _resolved(Path(prelude)).suffix.lower() not in ENDINGS:
                raise UsageError(f"--prelude {prelude}: its name must end in a shader's extension, such as .hlsl")
            yield from self._expanded(Path(prelude))
        if len(self.mains) == 1:
            yield from self._expanded(self.path)
        else:
            yield from self._of_two()

    def _of_two(self) -> Iterator[Line]:
        """Yield the lines of the encoder's and the decoder's file, each read as if alone, with clashes renamed."""
        encode, decode = (name.partition("::")[0] for name in self.file.functions or ("", ""))
        if encode == decode:
            raise UsageError(f"{self.file}: both functions are called {encode}; rename one")
        before = {own: list(branches) for own, branches in self._read_in.items()}
        first, second = (self._alone(path, before) for path in self.mains)
        clash = _defined(first) & _defined(second)
        yield from _renamed(first, clash - {encode}, "of_encoder")
        # Its macros, guards among them, are none of the decoder's.
        macros = dict.fromkeys(match[1] for line in first if (match := _MACRO.match(line.text)))
        yield from (Line(f"#undef {name}", self.path, 1) for name in macros)
        yield from _renamed(second, clash & {encode}, "of_decoder")

    def _alone(self, path: Path, before: Mapping[Path, list[tuple[int, ...]]]) -> list[Line]:
        """Return the lines of one of two files, read as if the other did not exist.

        Args:
            before: the files that were read before both, each with the branches in which it was read."""
        self._main, self._folders = path, _searched(_resolved(path.parent))
        self._tops.append(self._folders[-1])
        self._branches.now, self._read_in = (), {own: list(branches) for own, branches in before.items()}
        return list(self._expanded(path))

    def _expanded(self, path: Path) -> Iterator[Line]:
        own = _resolved(path)
        text = self._text_of(own, path)
        self._take(text)
        is_once = text.guard == _PRAGMA and bool(self._open)
        mark = f"normalbench_once_{list(self.files).index(own)}"
        if is_once:
            yield from (Line(f"#{word} {mark}", path, 1) for word in ("ifndef", "define"))
        self._open.append(own)
        for index, line in enumerate(text.lines):
            if index in text.includes:
                yield from self._included(path, index + 1, text.includes[index], index in text.imports)
                continue
            if index not in text.guard:
                self._branches.follow(line)
            yield Line("" if is_once and _ONCE.fullmatch(line) else line.rstrip(), path, index + 1)
        self._open.pop()
        if is_once:
            yield Line("#endif", path, len(text.lines))

    def _take(self, text: _Text) -> None:
        """Count a text toward the limits. Raises UsageError if one is exceeded."""
        self._left -= sum(map(len, text.lines)) + len(text.lines)
        self._lines_left -= len(text.lines)
        self._count += 1
        if self._left < 0:
            raise UsageError(f"{self.path}: with its includes it is larger than {MOST_TEXT >> 20} MiB")
        if self._lines_left < 0:
            raise UsageError(f"{self.path}: with its includes it has more than {MOST_LINES} lines")
        if self._count > MOST_INCLUDES:
            raise UsageError(f"{self.path}: its files are included more than {MOST_INCLUDES} times")

    def _text_of(self, own: Path, path: Path) -> _Text:
        if own not in self._texts:
            self.files[own] = path
            self._texts[own] = _read(own, path, self.settings.language)
        return self._texts[own]

    def _included(self, path: Path, number: int, name: str, is_module: bool) -> Iterator[Line]:
        there = [target for target in self._targets(path, name) if is_file(Path(), str(target))]
        target = next((candidate for candidate in there if self.may_read(_resolved(candidate))), None)
        if target is None:
            where = f"is outside the folder of {self._main.name}" if there else f"is not next to {path.name}"
            yield Line("#error not read", path, number, f"{name} {where}; name its folder with {_option_for(name)}")
        elif not self._is_read(_resolved(target), target, is_module):
            yield from self._expanded(target)

    def _targets(self, path: Path, name: str) -> list[Path]:
        """Return the possible paths of a file that `path` includes by this name, in order of preference."""
        if name.endswith(SLANG) and "_" in name:
            # A module's file may have hyphens for underscores.
            return [*self._targets(path, name.replace("_", "-")), *self._targets_as_written(path, name)]
        return self._targets_as_written(path, name)

    def _targets_as_written(self, path: Path, name: str) -> list[Path]:
        own = [folder / name for folder in dict.fromkeys((path.parent, self._main.parent))]
        bare = name.lstrip("/")
        roots = self.settings.roots
        rooted = ((virtual, root) for virtual, root in roots if not virtual or bare.startswith(f"{virtual}/"))
        given = [Path(root) / bare[len(virtual) :].lstrip("/") for virtual, root in rooted]
        return [*own, *given, *(folder / name for folder in self._folders)]

    def _is_read(self, own: Path, target: Path, is_module: bool) -> bool:
        """Whether a file need not be read again: it is being read, or it is a module or has an include guard and was
        read in a branch around this line. If not, record that a module or guarded file is read here."""
        if own in self._open:
            return True
        if not (is_module or self._text_of(own, target).guard):
            return False
        now, before = self._branches.now, self._read_in.setdefault(own, [])
        if any(now[: len(earlier)] == earlier for earlier in before):
            return True
        before.append(now)
        return False

    def with_text(self, text: str) -> Source:
        """Return a copy with a different text of the same number of lines, which keep their places."""
        clone = copy(self)
        clone.text = text
        return clone

    @property
    def own_text(self) -> str:
        """The remaining text of the file itself, or of both files, without includes."""
        texts = zip(self.text.split("\n"), self.lines, strict=False)
        return "".join(f"{text}\n" for text, line in texts if line.path in self.mains)

    def without_missing(self) -> Source:
        """Return a copy in which the lines that include missing files are empty."""
        texts = zip(self.text.split("\n"), self.lines, strict=False)
        return self.with_text("".join(f"{'' if line.wrong else text}\n" for text, line in texts))

    @property
    def missing(self) -> list[str]:
        """The errors of lines that include missing files, each as PATH:LINE: MESSAGE."""
        return [f"{line.path}:{line.number}: {line.wrong}" for line in self.lines if line.wrong]

    def without_part(self) -> Source:
        """Return a copy with the declarations that `part` selects blanked, and add them to `left_out`; return the
        source itself if `part` selects nothing."""
        number, count = self.part
        if not count:
            return self
        every = [item for item in items(self.text) if self.text[item.start : item.end].strip()]
        some = every[number * len(every) // count : (number + 1) * len(every) // count]
        for item in some:
            start = item.start + len(self.text[item.start : item.end]) - len(self.text[item.start : item.end].lstrip())
            path, line = self.place(self.text.count("\n", 0, start) + 1)
            self.left_out.append(f"{path}:{line}: {' '.join(self.text[start : item.end].split())[:60]}")
        return self.with_text(without(self.text, some))

    def may_read(self, target: Path) -> bool:
        """Whether a file, given as a path without links, is in a searched folder and has a shader's extension."""
        return any(map(target.is_relative_to, self._tops)) and target.suffix.lower() in ENDINGS

    def place(self, number: int) -> tuple[Path, int]:
        """Return the original file and line number of a line of `text`, counted from 1; beyond the end of `text`,
        those of its last line."""
        line = self._line(number)
        return line.path, line.number

    def _line(self, number: int) -> Line:
        """Return the line of this number, counted from 1; the nearest line if no line has it."""
        return self.lines[min(max(number, 1), len(self.lines)) - 1]

    def explained(self, number: int, message: str, token: str = "", column: int = 0) -> str:
        """Return a compiler's message about a line of `text`, with the user's file, line and column.

        Args:
            token: the text that the compiler quotes; its column is added if it occurs once in that line.
            column: the compiler's column; 0 if it gives none.
        """
        path, line = self.place(number)
        if wrong := self._line(number).wrong:
            return f"{path}:{line}: {wrong}"
        if number > len(self.lines):
            return f"{path}:{line}: at the end of the file: {message}"
        column = column or self._column(number, token)
        return f"{path}:{line}{f':{column}' if column else ''}: {message}"

    def _column(self, number: int, token: str) -> int:
        """Return the column of a word in a line, counted from 1; 0 unless the word occurs exactly once."""
        matches = list(re.finditer(rf"(?<!\w){re.escape(token)}(?!\w)", self._line(number).text)) if token else []
        return matches[0].start() + 1 if len(matches) == 1 else 0
