"""Names of users' encoders: a file, the two functions to use if it has several pairs, and the settings for reading
it: mine.hlsl:EncodeNormal:DecodeNormal:define=QUALITY=2:include=Packages=../library.

Imports nothing heavy: gates read these names before anything is measured.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from .choose import PART, names_a_file, whole_file_of
from .options.words import Names, Word, names
from .output.errors import UsageError
from .spelling import spelled

GLSL = ".glsl"
# The languages that are translated, by what their files end in; empty where the text has to say. A new one is a line
# here and one in `language.py`.
TRANSLATED: Mapping[str, str] = MappingProxyType(
    {
        **dict.fromkeys((".hlsl", ".hlsli", ".fx", ".fxh", ".ush", ".usf", ".cginc", ".azsli", ".shader"), "HLSL"),
        **dict.fromkeys((".slang", ".slangh", ".sdsl"), "Slang"),
        **dict.fromkeys((".wgsl", ".wesl"), "WGSL"),
        **dict.fromkeys((".vert", ".frag", ".comp", ".vsh", ".fsh", ".glsllib", ".gdshaderinc"), "GLSL"),
        **dict.fromkeys((".js", ".mjs", ".ts"), "GLSL"),
        **dict.fromkeys((".h", ".inc", ".sh", ".chunk", ".fsl"), ""),
    }
)
ENDINGS = (GLSL, *TRANSLATED)
# Endings of languages that are not read: what they are called, and how a shader becomes GLSL.
OTHER_LANGUAGES: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        ".metal": ("Metal", "write it as GLSL"),
    }
)
# Between a codec and the encoding of what comes back from it.
CHAIN = "+"
# FILE, FILE:ENCODE:DECODE, and settings behind either.
_FILE = rf".*?(?:{'|'.join(map(re.escape, ENDINGS))})"
# A function may have what it is given and gives behind it: see `wiring.py`.
_FUNCTION = r"(?:\w+::)*\w+(?:\([^()]*\))?(?:->(?:[\w.]+|\([^()]*\)))?"
DEFINE, PRELUDE, INCLUDE, LANGUAGE, FORMAT = SETTINGS = ("define", "prelude", "include", "language", "format")
# A colon in front of a slash is of a drive: include=C:\shaders.
_SETTING = rf":({'|'.join(SETTINGS)})=((?:[^:,]|:(?=[\\/]))*)"
_SAID = rf"(?::(?P<encode>{_FUNCTION}):(?P<decode>{_FUNCTION}))?(?P<settings>(?:{_SETTING})*)"
_WORD = re.compile(rf"(?P<file>{_FILE}){_SAID}", re.I | re.S)
# An encoder and its decoder in two files: FILE:ENCODE,FILE:DECODE.
_PLAIN = rf"(?:[A-Z]:(?=[\\/]))?[^:,]*?(?:{'|'.join(map(re.escape, ENDINGS))})"
_TWO = re.compile(
    rf"(?P<file>{_PLAIN}):(?P<encode>{_FUNCTION}),\s*(?P<other>{_PLAIN}):(?P<decode>{_FUNCTION})"
    rf"(?P<settings>(?:{_SETTING})*)",
    re.I | re.S,
)
# A text file of any other ending.
_OTHER = re.compile(rf"(?P<file>(?:[A-Z]:(?=[\\/]))?[^:]*\.\w+){_SAID}", re.I | re.S)
# Of text files that are no shaders.
_NO_SHADERS = frozenset(
    (".toml", ".json", ".csv", ".md", ".txt", ".py", ".obj", ".gltf", ".ply", ".svg", ".html", ".yaml", ".yml", ".ini")
)


def _match(word: str) -> re.Match[str] | None:
    return _TWO.fullmatch(word) or _WORD.fullmatch(word) or _match_of_text(word)


def _match_of_text(word: str) -> re.Match[str] | None:
    """Return the match of a word that names an existing text file with any extension; None for extensions of other
    file types, and for files that are not text."""
    match = _OTHER.fullmatch(word)
    ending = Path(match["file"]).suffix.lower() if match else ""
    if not match or ending in _NO_SHADERS or ending in OTHER_LANGUAGES or not is_file(Path(), match["file"]):
        return None
    try:
        with Path(match["file"]).open("rb") as file:
            return None if b"\0" in file.read(4096) else match
    except OSError:
        return None


class Settings(NamedTuple):
    """Settings for reading a user's file.

    Attributes:
        defines: macros, NAME or NAME=VALUE.
        preludes: files to insert before the user's file.
        roots: folders to search for includes, each with a prefix of include names; an empty prefix fits any name.
        language: one of LANGUAGES; empty for the language of the file's extension.
        format: the storage format of a light encoding; empty for its usual format.
    """

    defines: tuple[str, ...] = ()
    preludes: tuple[str, ...] = ()
    roots: tuple[tuple[str, str], ...] = ()
    language: str = ""
    format: str = ""


LANGUAGES = tuple(dict.fromkeys(name for name in ("HLSL", *TRANSLATED.values()) if name))
_MACRO = re.compile(r"[A-Za-z_]\w*(?:=.*)?")


def _root(text: str) -> tuple[str, str]:
    """Split FOLDER or VIRTUAL=FOLDER. Return the prefix of include names, empty if not given, and the folder."""
    virtual, mark, folder = text.partition("=")
    return (virtual.strip("/"), folder) if mark else ("", text)


@dataclass(frozen=True)
class UserFile:
    """A user's shader file, with the functions to use and the settings for reading it.

    Attributes:
        word: the file, functions and settings as the user typed them.
    """

    word: str

    def __str__(self) -> str:
        return self.word

    @cached_property
    def path(self) -> Path:
        """The path of the file; if the word names two files, the path of the encoder's file."""
        return file_of(self.word)

    @cached_property
    def paths(self) -> list[Path]:
        """The file's path in a list; if the word names two files, the path of the encoder's file and of the decoder's
        file."""
        match = _match(self.word)
        return [self.path, *([Path(match["other"])] if match and match.re is _TWO else [])]

    @cached_property
    def settings(self) -> Settings:
        """The settings for reading the file. Raises UsageError for an invalid macro or language."""
        match = _match(self.word)
        pairs = re.findall(_SETTING, match["settings"], re.I) if match else []
        of = {kind: tuple(value for name, value in pairs if name.lower() == kind) for kind in SETTINGS}
        if odd := [f"{kind}={value}" for kind, value in pairs if not (value and value.isprintable())]:
            raise UsageError(f"{odd[0]!r}: not a valid value; leave it out")
        if wrong := [macro for macro in of[DEFINE] if not _MACRO.fullmatch(macro)]:
            raise UsageError(
                f"-D {wrong[0]!r}: must be NAME or NAME=VALUE; write a macro with a comma in a file for --prelude"
            )
        names = [language for name in of[LANGUAGE] for language in LANGUAGES if language.lower() == name.lower()]
        if of[LANGUAGE] and not names:
            raise UsageError(f"--language {of[LANGUAGE][0]}: must be one of {', '.join(LANGUAGES).lower()}")
        roots = tuple(_root(folder) for folder in of[INCLUDE])
        return Settings(of[DEFINE], of[PRELUDE], roots, names[0] if names else "", "".join(of[FORMAT][:1]))

    @property
    def functions(self) -> tuple[str, str] | None:
        """The names of the encoder and the decoder that the word gives; None if it gives no names."""
        match = _match(self.word)
        return (match["encode"], match["decode"]) if match and match["encode"] else None

    @property
    def plain(self) -> str:
        """The word without its settings."""
        match = _match(self.word)
        return self.word[: match.start("settings")] if match else self.word

    @property
    def twin(self) -> Path:
        """The Python file that may exist next to the shader file."""
        return self.path.with_suffix(".py")

    @property
    def is_translated(self) -> bool:
        """Whether the file is in a language other than GLSL, or the word has functions or settings."""
        match = _match(self.word)
        return self.path.suffix.lower() != GLSL or bool(match and (match["encode"] or match["settings"]))

    def with_pair(self, pair: str) -> UserFile:
        """Return the file with two functions, ENCODE:DECODE, in place of any functions that the word names."""
        match = _match(self.word)
        if not match:
            return UserFile(f"{self.word}:{pair}")
        return UserFile(f"{match['file']}:{pair}{match['settings']}")

    def with_language(self, language: str) -> UserFile:
        """Return the file with a setting for its language."""
        return UserFile(_with_settings(self.word, [f":{LANGUAGE}={language}"]))


def with_settings(words: Iterable[Word], **settings: Iterable[Word]) -> Names:
    """Return all words as a tuple, with settings appended to each word that is a user's file.

    Args:
        settings: the values of each setting, by its name in SETTINGS.

    Raises:
        UsageError: a value contains a colon, which would end the setting.
    """
    more = [f":{kind}={value}" for kind, values in settings.items() for value in values]
    if wrong := next((setting for setting in more if ":" in setting[1:]), ""):
        raise UsageError(
            f"--{wrong[1:].replace('=', ' ', 1)}: the value must not contain a colon; put it in a file for --prelude"
        )
    return tuple(_with_settings(word, more) if isinstance(word, str) else word for word in words)


def _with_settings(word: str, more: Sequence[str]) -> str:
    if names_an_encoder(word):
        there = [match[0] for match in re.finditer(_SETTING, word, re.I)]
        return word + "".join(setting for setting in more if setting not in there)
    before, is_chain, then = word.rpartition(CHAIN)
    name, is_codec, storage = before.rpartition("/")
    if not (is_chain and is_codec):
        return word
    return f"{_with_settings(name, more)}/{storage}{CHAIN}{_with_settings(then, more)}"


def is_a_users_file(word: Word) -> bool:
    """Whether a word names a user's encoder file, by itself or in a chain."""
    return isinstance(word, str) and _with_settings(word, [":"]) != word


def file_names(text: str, folder: Path = Path()) -> tuple[str, ...]:
    """Split comma-separated names into a tuple without duplicates. A comma in a file name is kept, and so is a comma
    between the files of an encoder and its decoder.

    Args:
        folder: the folder to look for files in.
    """
    return names(text, lambda word: bool(_TWO.fullmatch(word)) or is_file(folder, str(file_of(word))))


def parts_of(word: str) -> list[str]:
    """Return the files that a word names, each with its settings: the parts of a chain, or files in settings."""
    if names_an_encoder(word) and (CHAIN not in word or is_file(Path(), str(file_of(word)))):
        return [word]
    before, is_chain, then = word.rpartition(CHAIN)
    parts = (before.rpartition("/")[0], then) if is_chain and not is_file(Path(), word) else ()
    return [name for part in parts for name in parts_of(part)] or files_in(word)


def names_an_encoder(word: str) -> bool:
    """Whether a word names the file of a user's encoder: by its extension, or because it is an existing text file."""
    is_by_ending = Path(file_of(word)).suffix.lower() in ENDINGS and not _is_only_an_ending(word)
    return is_by_ending or _match_of_text(word) is not None


def _is_only_an_ending(word: str) -> bool:
    return Path(word).name.lower() in ENDINGS


def file_of(word: str) -> Path:
    """Return the path of the file in a word: mine.hlsl for mine.hlsl:EncodeNormal:DecodeNormal, mesh.glb for
    mesh.glb#vertices."""
    match = _match(word)
    return Path(match["file"] if match else whole_file_of(word))


def files_in(word: str, folder: Path = Path()) -> list[str]:
    """Return the files that a word names, as spelled in the word: `mine.hlsl` for
    mine.hlsl:EncodeNormal:DecodeNormal, both files for mine.glsl/rg8+best_fit:table=scales.npy, and also the folders
    for mine.hlsl:include=../library.

    Args:
        folder: the folder to look for files in.
    """
    match = _match(word)
    whole = match["file"] if match else whole_file_of(word)
    if is_file(folder, whole):
        settings = UserFile(word).settings
        others = [path for path in (*map(str, UserFile(word).paths[1:]), *settings.preludes) if is_file(folder, path)]
        folders = [root for _, root in settings.roots if (folder / root).is_dir()]
        return list(dict.fromkeys([whole, *others, *folders]))
    files = [value for setting in re.split(r":(?![\\/])", word) if is_file(folder, value := setting.partition("=")[2])]
    # A chain is ENCODING/STORAGE+ENCODING.
    before, is_chain, then = word.rpartition(CHAIN)
    parts = (before.rpartition("/")[0], then) if is_chain else ()
    return list(dict.fromkeys([*files, *(file for part in parts for file in files_in(part, folder))]))


def is_file(folder: Path, text: str) -> bool:
    """Whether a text names an existing plain file in a folder; False for text that cannot be a file's name."""
    try:
        return bool(text) and (folder / text).is_file()
    except (OSError, ValueError):  # no name that a file could have
        return False


def with_files(word: str, others: Mapping[str, str]) -> str:
    """Return a word in which the files that `files_in` found are replaced; `others` maps old names to new names."""
    if not others:
        return word
    known = "|".join(map(re.escape, sorted(others, key=len, reverse=True)))
    return re.sub(rf"(?<![^+=,])(?:{known})(?![^:/+{PART}])", lambda match: others[match[0]], word)


def lacks_a_function(word: str) -> bool:
    """Whether a word names a file but only one of its two functions, such as mine.hlsl:EncodeNormal."""
    head, mark, _ = word.partition(":")
    return bool(mark) and Path(head).suffix.lower() in ENDINGS and not names_an_encoder(word)


def check_word(word: str, known: Collection[str], has_format: bool = False) -> None:
    """Raise UsageError if a word names a shader in an unsupported language, lacks the file extension, names only one
    of two functions, or sets a format although that is not allowed."""
    file = next((word + ending for ending in ENDINGS if names_a_file(word + ending)), None)
    if file and spelled("encoding", word, known) is None:
        raise UsageError(f"unknown encoding {word!r}; did you mean the file {file}?")
    if UserFile(word).settings.format and not has_format:
        raise UsageError(f"{word}: {FORMAT} applies only to light buffers; for others use --storage")
    if lacks_a_function(word):
        raise UsageError(
            f"{word}: name both functions, such as mine.hlsl:EncodeNormal:DecodeNormal, or one in each of two "
            "files, such as pack.hlsl:EncodeNormal,unpack.hlsl:DecodeNormal"
        )
    if (ending := Path(word).suffix.lower()) in OTHER_LANGUAGES:
        language, how = OTHER_LANGUAGES[ending]
        raise UsageError(f"{word}: {language} is not supported; {how}; see docs/your-encoding.md")
