"""The two functions of a user's GLSL file.

    vec2 mine_encode(vec3 n, vec3 view)      vec3 mine_decode(vec2 e, vec3 view)

Either function may leave out the view. Functions in another form are reported, with the right form, before a compiler
sees them.
"""

from __future__ import annotations

import re
from itertools import takewhile
from typing import NamedTuple

from ...ground.output.errors import UsageError
from ...ground.user_files import UserFile

# Type, name and parameters, of a definition or of a declaration; not of a call or a macro.
FUNCTION = r"\b(?!return\b|else\b|define\b)(\w+)\s+({name})\s*\(([^(){{}};]*)\)"
ENCODE, MAIN = re.compile(FUNCTION.format(name=r"\w+_encode")), re.compile(r"\bvoid\s+main\s*\(")
CODES = ("vec2", "vec3")
HLSL = re.compile(r"\b(?:float|half|int|uint)[234](?:x[234])?\b")
NO_FUNCTION = "no function vec2 (or vec3) NAME_encode(vec3 n, vec3 view)"
OWN_MAIN = "it defines main; remove main, because normalbench defines its own"
OWN_VERSION = "it has #version; remove that line, because normalbench adds its own"
FROM_HLSL = "rename float2 to vec2, lerp to mix, and so on"
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


VERSION = re.compile(r"^\s*#\s*version\b", re.M)
# What a program is given from outside: a number, a texture, or a block with a name of its own or without one.
GIVEN = re.compile(r"\b(?:uniform|buffer)\b([^;{]*)(?:\{([^}]*)\}([^;]*))?;")
SIZE = re.compile(r"\[[^\]]*\]")


class Encode(NamedTuple):
    """The first encode function in a file: its encoding's name and component count, and the names of other encodings
    in the file."""

    name: str
    components: int
    others: tuple[str, ...]


def encode_of(file: UserFile, text: str) -> Encode:
    """Return the name and component count of the first encoding in GLSL code, and the names of others with a decode.

    Raises:
        UsageError: no encode has the right form, its decode has the wrong types, or the code has a main function, a
            #version line or an unclosed comment.
    """
    code = COMMENT.sub(" ", text)
    if "/*" in code:
        raise UsageError(f"{file}: a comment that begins with /* is not closed")
    if MAIN.search(code):
        raise UsageError(f"{file}: {OWN_MAIN}")
    if VERSION.search(code):
        raise UsageError(f"{file}: {OWN_VERSION}")
    signatures = [match.groups() for match in ENCODE.finditer(code)]
    right = list(dict.fromkeys(signature[:2] for signature in signatures if _is_encode(signature)))
    if not right:
        raise UsageError(f"{file}: {_no_encode(signatures)}")
    (kind, name), *others = [(kind, name.removesuffix("_encode")) for kind, name in right]
    _check_decode(file, code, name, kind)
    return Encode(name, int(kind[-1]), tuple(other for _, other in others if f"{other}_decode" in code))


def check_given(file: UserFile, code: str) -> None:
    """Raise UsageError if a shader reads external input: a uniform without a value, a texture or a buffer.

    Declarations that are not used are accepted.

    Args:
        code: the text of the file and its includes, without comments.
    """
    if given := _given_and_read(code):
        raise UsageError(f"{file}: it reads {given}, which has no value here; use a constant instead")


def _given_and_read(code: str) -> str:
    rest = GIVEN.sub(" ", code)
    for declared, members, instance in (match.groups() for match in GIVEN.finditer(code)):
        # The members of a block with a name are read by that name. A uniform with a value has it here, too.
        is_named = members is not None and instance.strip()
        declarations = instance if is_named else declared if members is None else members
        what = "the uniform {}" if members is None else "the block {}" if is_named else "{} of a block"
        unvalued = takewhile(lambda text: "=" not in text, re.split("[;,]", declarations))
        names = [words[-1] for declaration in unvalued if (words := re.findall(r"\w+", SIZE.sub(" ", declaration)))]
        if read := next((name for name in names if _is_read(name, rest)), ""):
            return what.format(read)
    return ""


def _is_read(name: str, code: str) -> bool:
    """Whether GLSL code uses a name, other than as a member (`n.x`), without declaring or #defining it."""
    own = rf"\b(?!return\b|else\b)\w+\s+{name}\s*[,)=;\[]|#\s*define\s+{name}\b"
    return bool(re.search(rf"(?<![.\w]){name}\b", code)) and not re.search(own, code)


def _is_encode(function: tuple[str, ...]) -> bool:
    return function[0] in CODES and _types(function[2]) in (["vec3"], ["vec3", "vec3"])


def _types(parameters: str) -> list[str]:
    """Return the types in a parameter list, without `in` and `const`; for `in vec3 n, vec3 view`, vec3 twice."""
    words = [parameter.split() for parameter in parameters.split(",")]
    return [" ".join(word for word in parameter[:-1] if word not in ("in", "const")) for parameter in words]


def _no_encode(signatures: list[tuple[str, ...]]) -> str:
    """Return why no function is a valid encode: the right form of the first candidate, or that none was found."""
    if not signatures:
        return NO_FUNCTION
    kind, name, _ = signatures[0]
    wanted = f"{kind if kind in CODES else 'vec2 (or vec3)'} {name}(vec3 n, vec3 view)"
    return _should_be(signatures[0], wanted)


def _check_decode(file: UserFile, code: str, name: str, kind: str) -> None:
    """Raise UsageError if a decode is defined, but with the wrong types."""
    signatures = [match.groups() for match in re.finditer(FUNCTION.format(name=f"{name}_decode"), code)]
    if signatures and not any(
        signature[0] == "vec3" and _types(signature[2]) in ([kind], [kind, "vec3"]) for signature in signatures
    ):
        wanted = f"vec3 {name}_decode({kind} e, vec3 view)"
        raise UsageError(f"{file}: {_should_be(signatures[0], wanted)}")


def _should_be(function: tuple[str, ...], wanted: str) -> str:
    """Return a message with the actual and the required form of a function, and what is wrong with it."""
    kind, name, parameters = function
    signature = f"{kind} {name}({' '.join(parameters.split())})"
    signature = "".join(letter if letter.isprintable() else "?" for letter in signature)
    why = of_hlsl(signature) or ("a code has two or three numbers" if "vec4" in signature else "")
    return f"{signature} must be {wanted}" + (f"; {why}" if why else "")


def of_hlsl(text: str) -> str:
    """Return advice on GLSL with HLSL types; empty if the text has no HLSL types."""
    match = HLSL.search(COMMENT.sub(" ", text))
    return f"{match[0]} is HLSL: {FROM_HLSL}" if match else ""
