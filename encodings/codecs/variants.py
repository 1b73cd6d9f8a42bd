"""Variants of an encoding by name: `stereographic:scale=1.31`, `octahedral:axis=y`, `octahedral:arithmetic=half`,
`octahedral:range=64`."""

from __future__ import annotations

import re
from collections.abc import Mapping

from .encoding import AXES, Encoding

MARK, TABLE = ":", "table"
# Of codes that are stored within the range of their patch: how many normals that is, and a meshlet's usual number.
RANGE, LOCAL = "range", "local"
LEAST_PATCH, USUAL_PATCH, MOST_PATCH = 4, 64, 2**18
SIGNS = ("1", "-1")
FLOAT, HALF = ARITHMETICS = ("float", "half")
# In place of an arithmetic: float, and half as well for a file that declares numbers of 16 bits.
DECLARED = "declared"
# What the name of an encoding in half arithmetic ends with.
HALF_NAME = f"{MARK}arithmetic={HALF}"


def settings_in(word: str) -> tuple[str, dict[str, str]]:
    """The name and the settings of a word such as NAME:KEY=VALUE:KEY=VALUE.

    Raises:
        ValueError: a setting has no value, or is there twice; a sentence.
    """
    # A mark in front of a slash is of a drive: table=C:\scales.npy.
    name, *settings = re.split(rf"{MARK}(?![\\/])", word)
    values: dict[str, str] = {}
    for setting in settings:
        key, is_set, value = setting.partition("=")
        if not (is_set and value) or key in values:
            raise ValueError(f"{setting!r} is not a setting: write each once, as NAME=VALUE")
        values[key] = value
    return name, values


def known_settings(encoding: Encoding) -> dict[str, str]:
    """The settings of an encoding, each with a value as an example."""
    known = {name: f"{value:g}" for name, value in encoding.published.items()}
    known |= {TABLE: "FILE.npy"} if encoding.look_up else {}
    known |= {"axis": "y", "sign": "-1"} if encoding.can_turn else {}
    known |= {RANGE: LOCAL} if has_ranges(encoding) else {}
    return known | {"arithmetic": HALF}


def has_ranges(encoding: Encoding) -> bool:
    """Whether its codes may be stored within a range: numbers that are no index, and are not searched among codes."""
    is_index = bool(encoding.levels) or encoding.is_packed or encoding.is_precise or encoding.searches
    return not (is_index or encoding.sign_bits or encoding.look_up or encoding.is_half)


def variant(encoding: Encoding, values: Mapping[str, str]) -> Encoding:
    """An encoding with settings: its own parameters by number, `axis` and `sign` where it holds every direction, and
    `arithmetic`.

    Raises:
        ValueError: an unknown setting, or a value that it cannot have; a sentence.
    """
    for key in values:
        if key not in known_settings(encoding):
            known = ", ".join(known_settings(encoding)) or "none"
            raise ValueError(f"{encoding.name} has no parameter {key!r}; known: {known}")
    turns = {key: values[key] for key in ("axis", "sign") if key in values}
    arithmetic = values.get("arithmetic", FLOAT)
    _check("arithmetic", arithmetic, ARITHMETICS)
    own = [key for key in values if key in encoding.published]
    numbers = {key: _checked_number(encoding, key, values[key]) for key in own}
    made = encoding.with_parameters(numbers) if numbers else encoding
    made = _turned_encoding(made, turns) if turns else made
    if RANGE in values:
        if arithmetic == HALF:
            raise ValueError("a range is not computed in half arithmetic; leave out one of the two")
        return made.in_patches(_checked_patch(values[RANGE]), f"{MARK}{RANGE}={values[RANGE]}")
    return in_half(made) if arithmetic == HALF else made


def in_half(encoding: Encoding) -> Encoding:
    """The encoding computed in floats of 16 bits."""
    return encoding.in_half(HALF_NAME)


def _checked_patch(text: str) -> int:
    if text == LOCAL:
        return USUAL_PATCH
    patch = int(text) if text.isdecimal() and len(text) < 9 else 0
    if not LEAST_PATCH <= patch <= MOST_PATCH or patch & (patch - 1):
        raise ValueError(
            f"{RANGE} is {LOCAL} or how many normals share one, a power of two from {LEAST_PATCH} to {MOST_PATCH}, not "
            f"{text!r}"
        )
    return patch


def _checked_number(encoding: Encoding, key: str, text: str) -> float:
    parameter = next(p for p in encoding.parameters if p.name == key)
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not parameter.least <= value <= parameter.most:
        raise ValueError(f"{key} is a number from {parameter.least:g} to {parameter.most:g}, not {text!r}")
    return value


def _turned_encoding(encoding: Encoding, turns: Mapping[str, str]) -> Encoding:
    axis, sign = turns.get("axis", "z"), turns.get("sign", "1")
    _check("axis", axis, tuple(AXES))
    _check("sign", sign, SIGNS)
    return encoding.turned(axis, int(sign), "".join(f"{MARK}{key}={value}" for key, value in turns.items()))


def _check(key: str, value: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise ValueError(f"{key} is {', '.join(known[:-1])} or {known[-1]}, not {value!r}")
