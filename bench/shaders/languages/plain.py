"""A compiler's GLSL fragment shader for one function, rewritten as a part of another shader.

The shader's inputs become parameters, its output becomes the result of its `main`, and all its names get a prefix.
"""

from __future__ import annotations

import re


class NotPlainError(Exception):
    """A function that reads more than its inputs: a texture, a constant buffer, the pixel's position."""


_LEFT_OUT = re.compile(r"^[ \t]*#(?:version|extension|line)\b.*$|^layout\(\w+_major\) (?:uniform|buffer);$", re.M)
# What SPIRV-Cross writes for [unroll], [branch] and [flatten].
_HINTS = re.compile(r"^#if defined\(GL_EXT_control_flow_attributes\)$.*?^#endif$", re.M | re.S)
# What it writes for numbers of 16 bits, which become numbers of 32.
_HALVES = re.compile(
    r"^#if defined\(GL_\w+\)$(?:(?!^#endif$).)*?^#error No extension available for FP16.*?^#endif$", re.M | re.S
)
_HINT = re.compile(r"\bSPIRV_CROSS_\w+")
# layout(location = 0) in vec3 _102;
_VARIABLE = re.compile(
    r"^(?:flat\s+)?layout\(location = (\d+)\)\s+(?:(?:flat|highp|mediump)\s+)*(in|out)\s+"
    r"(?:(?:highp|mediump)\s+)?(\w+ )(\w+);",
    re.M,
)
# What SPIRV-Cross and Slang call things; a function of GLSL has no such name.
_NAME = re.compile(r"\b(?:_S?\d+|[A-Za-z]\w*_\d+)\b")
_RESOURCE = re.compile(r"\b(?:uniform|buffer|shared|gl_\w+|u?i?(?:sampler|image|texture)\w*)\b")
# [[unroll]], before loops and branches.
_ATTRIBUTE = re.compile(r"\[\[\s*\w+\s*\]\]|(?<=\n)\s*\[\s*\w+\s*\](?=\s*(?:for|while|do|if|switch)\b)")
_HALF = re.compile(r"\bf16(vec|mat)(\d)|\bfloat16_t\b")
_HALF_NUMBER = re.compile(r"(?<=[\d.])HF\b", re.I)


HAS_A_NORMAL = "only the normal and the view-space position are available"


def plain(shader: str, prefix: str, given: str, has: str = HAS_A_NORMAL) -> str:
    """Return the text of a GLSL fragment shader, rewritten as a function `PREFIX_main(PREFIX_0, view)` that returns
    the shader's output.

    Args:
        given: the GLSL type of the shader's first input; its second input has three numbers.
        has: the inputs that the shader may read, in words.

    Raises:
        NotPlainError: the shader reads something else.
    """
    text = _HALF_NUMBER.sub("", _HALF.sub(lambda match: f"{match[1]}{match[2]}" if match[1] else "float", shader))
    text = _HALVES.sub("", _HINT.sub("", _HINTS.sub("", text)))
    text = _ATTRIBUTE.sub("", _LEFT_OUT.sub("", text))
    names = {name: _parameter_name(place, way) for place, way, _, name in _VARIABLE.findall(text)}
    result = next(kind for _, way, kind, _ in _VARIABLE.findall(text) if way == "out")
    text = _VARIABLE.sub("", text)
    names = {name: called if called == "view" else f"{prefix}_{called}" for name, called in names.items()}
    text = _NAME.sub(lambda match: names.get(match[0], f"{prefix}_{match[0].strip('_')}"), text)
    if resource := _RESOURCE.search(text):
        what = "a texture or a constant buffer" if not resource[0].startswith("gl_") else resource[0]
        raise NotPlainError(f"its functions read {what}; {has}")
    return _function_text(re.sub(r"\n\s*\n+", "\n", text.strip()), prefix, given, result.strip()) + "\n"


def _function_text(text: str, prefix: str, given: str, result: str) -> str:
    """Return a shader's text with its last function, `main`, renamed to `PREFIX_main`, which returns the output.

    Args:
        given, result: the GLSL types of the first input and of the output."""
    before, _, main = text.partition("void main()")
    body = re.sub(r"\breturn;", f"return {prefix}_out;", main.strip().removeprefix("{").removesuffix("}"))
    head = f"{result} {prefix}_main({given} {prefix}_0, vec3 view)"
    return f"{before}{head}\n{{\n    {result} {prefix}_out;{body.rstrip()}\n    return {prefix}_out;\n}}"


def _parameter_name(place: str, way: str) -> str:
    return ("0", "view")[int(place)] if way == "in" else "out"
