"""Texts for the judge of compiler input: joins, comments, directives and macros, each from a seed."""

from __future__ import annotations

import random
import re
from pathlib import Path
from unittest.mock import patch

from typed import translated

from normalbench.bench.ground.compilers import slang
from normalbench.bench.ground.compilers.text import RULES, RefusedError, judged
from normalbench.bench.ground.user_files import UserFile
from normalbench.bench.shaders.languages import child, hlsl
from normalbench.bench.shaders.languages import slang as languages_slang
from normalbench.bench.shaders.languages.translated import UsageError

from .kind import MEASURED, REFUSED, Attack, Kind

ENDINGS = ("hlsl", "slang", "frag", "glsl", "wgsl")
# NOTE is a file elsewhere, whose function the encoder needs; PART one next to it.
NEEDED = "two"
CODE = {
    "hlsl": "float2 p_encode(float3 n) { return n.xy * two(); }\nfloat3 p_decode(float2 e) { return float3(e, 0); }\n",
    "glsl": "vec2 p_encode(vec3 n) { return n.xy * two(); }\nvec3 p_decode(vec2 e) { return vec3(e, 0.0); }\n",
    "wgsl": "fn p_encode(n: vec3f) -> vec2f { return n.xy * two(); }\n"
    "fn p_decode(e: vec2f) -> vec3f { return vec3f(e, 0.0); }\n",
}
CODE |= {"slang": CODE["hlsl"], "frag": CODE["glsl"]}
NOTE = dict.fromkeys(CODE, "float two() { return 2.0; }\n") | {"wgsl": "fn two() -> f32 { return 2.0; }\n"}
JOINS = ("\\\n", "\\\r\n", "\\ \n", "\\\t \n", "\\\f\n", "\\\\\n", "\\", "\\\n\\\n", "??/\n")
PIECES = (
    *(
        "#",
        "# ",
        "#\t",
        "##",
        "%:",
        "%:%:",
        "??=",
        "\n",
        "\n",
        "\n",
        "\r",
        " ",
        "\t",
        "\f",
        "\v",
        "\u2028",
        "\x85",
        "\0",
    ),
    *("//", "/*", "*/", "/**/", '"', "'", "<", ">", "(", ")", "{", "}", ";", "@", "$", "`"),
    *(
        "include",
        "inc",
        "lude",
        "import",
        "imp",
        "ort",
        "__include",
        "__import",
        "implementing",
        "embed",
        "include_next",
    ),
    *(
        "line",
        "pragma",
        "version 430",
        "extension",
        "define",
        "undef",
        "if 1",
        "if 0",
        "else",
        "endif",
        "error",
        "once",
    ),
    *("__target_switch", "__intrinsic_asm", "__requirePrelude", "spirv_asm", "__has_include", "_Pragma", "module x"),
    *("A", "A(x) x", "A(a, b) a##b", "I include", "A(imp, ort)", "float x;", '"NOTE"', "<NOTE>", "NOTE", '"PART"'),
)


def text_of(seed: int, most: int = 14) -> str:
    """Return a few pieces in a row; a join may cut each piece, and a line may be a whole directive."""
    draw = random.Random(seed)
    parts = []
    for _ in range(draw.randint(1, most)):
        piece = draw.choice(PIECES)
        if draw.random() < 0.25 and len(piece) > 1:
            place = draw.randrange(1, len(piece))
            piece = piece[:place] + draw.choice(JOINS) + piece[place:]
        parts += [piece, draw.choice((" ", "", "\n", draw.choice(JOINS)))]
    if most > 4 and draw.random() < 0.4:
        word = draw.choice(("line ", "pragma ", "version ", "extension ", "define X ", "if 0 ", "error "))
        parts[:0] = ["#", word, draw.choice(JOINS)]
        parts += ["\n", "#", draw.choice(("", draw.choice(JOINS))), "include ", '"NOTE"']
    return "".join(parts)


def _written(folder: Path, seed: int) -> Path:
    """Write the file of a seed: its text is in the file, in an included file, or in the file's prelude."""
    ending = ENDINGS[seed % len(ENDINGS)]
    path, part, note = folder / f"mine.{ending}", folder / f"part.{ending}", folder / "elsewhere" / "note.txt"
    note.parent.mkdir(exist_ok=True)
    note.write_text(NOTE[ending])
    text = text_of(seed).replace("NOTE", str(note)).replace("PART", part.name) + "\n"
    way = seed // len(ENDINGS) % 3
    path.write_text((text, f'#include "{part.name}"\n', "")[way] + CODE[ending], newline="")
    part.write_text(text, newline="")
    return Path(f"{path}:prelude={part}") if way == 2 else path


class _Stand:
    """A substitute for Slang's compiler that refuses any bytes that were not judged, and compiles nothing."""

    failed, said = False, ""

    def __init__(self, words: list[str]):
        given = Path(words[0]).read_bytes().decode()
        assert given in _seen, f"it was not judged: {given!r}"
        _compare(given)


_seen: list[str] = []


def _compare(given: str) -> None:
    """Check, by rules other than the judge's, that every line of the text is what it appears to be."""
    for line in given.split("\n"):
        first = line.strip()
        assert not first.endswith("\\") and "//" not in line and "/*" not in line, repr(line)
        assert line.isprintable() or "\t" in line, repr(line)
        if first.startswith(("#", "%:", "??=")):
            assert re.match(r"#\s*(define|undef|if|ifdef|ifndef|elif|else|endif|error|warning)\b", first), repr(line)


def _remembering(text: str, *more):
    source = judged(text, *more)
    _seen[:] = [source.content]
    return source


def boundary(folder: Path) -> Attack:
    """Return an attack on the boundary: all text that a compiler gets was judged, in the same bytes."""

    def expanded(words: list[str]) -> str:
        given = Path(words[0]).read_bytes().decode()
        _compare(given)
        return given

    (folder / "work").mkdir()

    def case(seed: int) -> str:
        _seen.clear()
        with (
            patch.multiple(slang, judged=_remembering, Compiled=_Stand, _expanded=expanded),
            patch.object(hlsl, "judged", _remembering),
            patch.object(languages_slang, "functions_of", lambda *_: []),
        ):
            answer = child.answer(UserFile(str(_written(folder, seed))), folder / "work")
        message = str(answer.get("error", ""))
        assert "\n" not in message and NEEDED not in str(answer.get("text", "")).replace("two()", "")
        return MEASURED if _seen else REFUSED

    return case


def compiled(folder: Path) -> Attack:
    """Return an attack whose encoder needs a note outside the folder: a case fails if a compiler reads the note."""

    def case(seed: int) -> str:
        try:
            translated(_written(folder, seed))
        except UsageError as error:
            assert "\n" not in str(error) and "return 2.0" not in str(error), str(error)
            return REFUSED
        raise AssertionError(f"it was read: {text_of(seed)!r}")

    return case


def languages(folder: Path) -> Attack:
    """Return an attack on the judge of each language: no accepted line may have another meaning for a compiler."""
    del folder

    def case(seed: int) -> str:
        language = sorted(RULES)[seed % len(RULES)]
        text = text_of(seed, 4)
        try:
            given = judged(text, language, lambda plain: plain.content)
        except RefusedError as error:
            assert "\n" not in str(error) and error.line <= text.count("\n") + 1
            return REFUSED
        assert given.content == text
        if not any(
            line.lstrip().startswith(("#include", "#pragma", "#version", "#extension")) for line in text.split("\n")
        ):
            _compare(text)
        return MEASURED

    return case


KINDS = (
    Kind("judge: what is given", boundary, 12_000, seconds=2.0),
    Kind("judge: what is judged", languages, 8_000, seconds=2.0),
    Kind("judge: compilers", compiled, 500, 0, seconds=10.0, chunk=50),
)
