"""A user's file translated, in a process that may hang or die.

    python -m normalbench.bench.shaders.languages.child FOLDER FILE LANGUAGE [ENCODE DECODE]

FOLDER is an empty one to work in. LANGUAGE is the one whose compiler reads the file; empty for its own. Prints a line
of JSON: `error`, what is wrong with the file; `missing`, what to install; else what `Translated` has.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

from ....encodings.codecs.files import called
from ...ground.machine import children
from ...ground.output.errors import MissingError, UsageError
from . import programs
from .language import Language, also_read_by, language_of
from .pairs import NORMAL, Function, NoPairError, Pair, pair_of
from .plain import NotPlainError, plain
from .programs import TranslationError, has_halves
from .source import Source
from .tools import ToolError
from .words import TRANSLATED

READ_BY = "it is read by {}'s compiler, as the compiler of {} does not read it"
IN_32_BITS = "half and min16float are computed in 32 bits; --arithmetic half computes in 16"


def answer(path: Path, asked: tuple[str, str] | None, folder: Path, by: str = "") -> dict[str, Any]:
    """What there is to say of a file; see above."""
    try:
        return _by_whoever_reads_it(path, asked, folder, by)
    except (UsageError, TranslationError) as error:
        return {"error": str(error)}
    except (NoPairError, NotPlainError, ToolError) as error:
        return {"error": f"{path}: {error}"}
    except MissingError as error:
        return {"missing": f"{path}: {error}"}


def _by_whoever_reads_it(path: Path, asked: tuple[str, str] | None, folder: Path, by: str) -> dict[str, Any]:
    """By the compiler of its own language, or by another one that reads that language where the first does not."""
    try:
        return _translated(path, asked, folder, by)
    except (TranslationError, NoPairError) as error:
        other = "" if by else also_read_by(path)
        if not other:
            raise
        try:
            found = _translated(path, asked, folder, other)
        except (TranslationError, NoPairError, NotPlainError, ToolError, MissingError):
            raise error from None
        return found | {"notes": [*found["notes"], READ_BY.format(other, TRANSLATED[path.suffix.lower()])]}


def _translated(path: Path, asked: tuple[str, str] | None, folder: Path, by: str) -> dict[str, Any]:
    source, language = Source(path), language_of(path, by)
    pair = pair_of(language.functions(language.preprocessed(source, folder)), asked, path.name)
    name = _name(path, pair, asked)
    prefix = "user_" + re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")
    return {
        "name": name,
        "prefix": prefix,
        "components": pair.components,
        "notes": [IN_32_BITS] if has_halves(source) else [],
        "texts": _texts(source, language, pair, prefix, folder),
        "functions": [(one.name, one.takes_view) for one in (pair.encode, pair.decode)],
    }


def _name(path: Path, pair: Pair, asked: tuple[str, str] | None) -> str:
    """What rows call it: NAME of NAME_encode and NAME_decode, as in GLSL; else the file's name."""
    names = [pair.encode.name.removesuffix("_encode"), pair.decode.name.removesuffix("_decode")]
    if names[0] == names[1]:
        return names[0]
    return called(f"{path.name}:{pair.encode.name}" if asked else path.name)


def _texts(source: Source, language: Language, pair: Pair, prefix: str, folder: Path) -> list[str]:
    """The two functions in GLSL, of codes in [-1, 1] and of codes in [0, 1]."""
    sides = {f"{prefix}_e": pair.encode, f"{prefix}_d": pair.decode}
    made = "".join(plain(language.shader(source, one, folder), name, one.given[0]) for name, one in sides.items())
    mains = (Function(f"{name}_main", one.result, (one.given[0], NORMAL)) for name, one in sides.items())
    encoder, decoder = mains
    return [made + programs.pair(prefix, pair.components, encoder, decoder, is_unit) for is_unit in (False, True)]


if __name__ == "__main__":
    children.limit_this_process()
    work, file, language, *functions = sys.argv[1:]
    print(json.dumps(answer(Path(file), (functions[0], functions[1]) if functions else None, Path(work), language)))
