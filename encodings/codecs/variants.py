"""Named variants of an encoding: `stereographic:scale=1.31`, `octahedral:axis=y`, `octahedral:arithmetic=half`."""

from __future__ import annotations

import re
from collections.abc import Mapping

from .encoding import AXES, Encoding

MARK, TABLE = ":", "table"
SIGNS = ("1", "-1")
FLOAT, HALF = ARITHMETICS = ("float", "half")
# In place of an arithmetic: float, and half as well for a file that declares numbers of 16 bits.
DECLARED = "declared"
# What the name of an encoding in half arithmetic ends with.
HALF_NAME = f"{MARK}arithmetic={HALF}"


def settings_in(word: str) -> tuple[str, dict[str, str]]:
    """Split a word such as NAME:KEY=VALUE:KEY=VALUE. Return the name, and the values as text by key.

    Raises:
        ValueError: a setting has no value, or is given twice; the message is one sentence.
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
    """Return the names of an encoding's settings, each with an example value as text."""
    known = {name: f"{value:g}" for name, value in encoding.published.items()}
    known |= {TABLE: "FILE.npy"} if encoding.look_up else {}
    known |= {"axis": "y", "sign": "-1"} if encoding.can_turn else {}
    return known | {"arithmetic": HALF}


def variant(encoding: Encoding, values: Mapping[str, str]) -> Encoding:
    """Return an encoding with settings applied: its own parameters as numbers, `axis` and `sign` if it represents
    every direction, and `arithmetic`. A setting `table` is accepted but not applied.

    Raises:
        ValueError: a setting is unknown, or its value is invalid; the message is one sentence.
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
    varied = encoding.with_parameters(numbers) if numbers else encoding
    varied = _turned_encoding(varied, turns) if turns else varied
    return in_half(varied) if arithmetic == HALF else varied


def in_half(encoding: Encoding) -> Encoding:
    """Return the encoding computed in 16-bit floats, with HALF_NAME appended to its name."""
    return encoding.in_half(HALF_NAME)


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
