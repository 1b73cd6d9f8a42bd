"""GLSL with two arguments of a call exchanged, which a parity test must notice."""

import itertools
import re
from collections.abc import Iterable
from pathlib import Path

COMMUTATIVE = {"dot", "max", "min"}
CALL = re.compile(r"\b([A-Za-z_]\w*)\(")


def split_arguments(text: str, start: int) -> tuple[list[str], int]:
    """Return the arguments of a call whose parenthesis opens just before `start`, and where it closes."""
    depth, begin, arguments = 0, start, []
    for i in range(start, len(text)):
        if text[i] in "([":
            depth += 1
        elif text[i] in ")]" and depth:
            depth -= 1
        elif text[i] in ",)" and not depth:
            arguments.append(text[begin:i].strip())
            begin = i + 1
            if text[i] == ")":
                return arguments, i
    return arguments, len(text)


def exchanged(arguments: list[str], i: int, j: int) -> list[str]:
    """Exchange two arguments; in a definition, exchange only their names and keep the types."""
    swapped = list(arguments)
    first, second = arguments[i].split(" "), arguments[j].split(" ")
    if len(first) == len(second) == 2 and first[0] in ("float", "vec2", "vec3"):
        swapped[i], swapped[j] = f"{first[0]} {second[1]}", f"{second[0]} {first[1]}"
    else:
        swapped[i], swapped[j] = arguments[j], arguments[i]
    return swapped


def swapped_calls(text: str) -> list[tuple[str, str]]:
    """Return (what, text) for each call or definition in a GLSL text and each pair of its arguments exchanged."""
    changes = []
    text = re.sub(r"//[^\n]*", lambda comment: " " * len(comment[0]), text)
    for match in CALL.finditer(text):
        arguments, end = split_arguments(text, match.end())
        if match[1] in COMMUTATIVE or match[1] in ("if", "for"):
            continue
        for i, j in itertools.combinations(range(len(arguments)), 2):
            if arguments[i] != arguments[j]:
                swapped = ", ".join(exchanged(arguments, i, j))
                changes.append((f"{match[1]}({swapped})", text[: match.end()] + swapped + text[end:]))
    return changes


def part_of(text: str, function: str) -> tuple[int, int]:
    """Return the start and end of the definition of `function`, or of the whole text if `function` is empty."""
    if not function:
        return 0, len(text)
    start = text.index(function)
    return start, text.find("\n", start)


def mutants(glsl: Path, shared: Iterable[str] = ()) -> list[tuple[str, Path, str]]:
    """Return (what, file, its text) for each pair of arguments exchanged in an encoding's file and in its shared
    files: FILE or FILE:FUNCTION in the folder above."""
    changes = []
    for spec in ("", *shared):
        name, _, function = spec.partition(":")
        file = glsl.parents[1] / name if name else glsl
        text = file.read_text()
        start, end = part_of(text, function)
        swapped = swapped_calls(text[start:end])
        changes += [(what, file, text[:start] + changed + text[end:]) for what, changed in swapped]
    return changes
