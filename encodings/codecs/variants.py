"""Variants of an encoding by name: `stereographic:scale=1.31`, `octahedral:axis=y:sign=-1`."""

from __future__ import annotations

from collections.abc import Mapping

from .encoding import AXES, Encoding

MARK, TABLE = ":", "table"
SIGNS = ("1", "-1")


def settings_in(word: str) -> tuple[str, dict[str, str]]:
    """The name and the settings of a word such as NAME:KEY=VALUE:KEY=VALUE.

    Raises:
        ValueError: a setting has no value, or is there twice; a sentence.
    """
    name, *settings = word.split(MARK)
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
    return known | ({"axis": "y", "sign": "-1"} if encoding.can_turn else {})


def variant(encoding: Encoding, values: Mapping[str, str]) -> Encoding:
    """An encoding with settings: its own parameters by number, and `axis` and `sign` where it holds every direction.

    Raises:
        ValueError: an unknown setting, or a value that it cannot have; a sentence.
    """
    for key in values:
        if key not in known_settings(encoding):
            known = ", ".join(known_settings(encoding)) or "none"
            raise ValueError(f"{encoding.name} has no parameter {key!r}; known: {known}")
    turns = {key: values[key] for key in ("axis", "sign") if key in values}
    numbers = {key: _number(encoding, key, text) for key, text in values.items() if key not in turns}
    made = encoding.with_parameters(numbers) if numbers else encoding
    return _turned(made, turns) if turns else made


def _number(encoding: Encoding, key: str, text: str) -> float:
    parameter = next(p for p in encoding.parameters if p.name == key)
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not parameter.least <= value <= parameter.most:
        raise ValueError(f"{key} is a number from {parameter.least:g} to {parameter.most:g}, not {text!r}")
    return value


def _turned(encoding: Encoding, turns: Mapping[str, str]) -> Encoding:
    axis, sign = turns.get("axis", "z"), turns.get("sign", "1")
    for key, value, known in (("axis", axis, tuple(AXES)), ("sign", sign, SIGNS)):
        if value not in known:
            raise ValueError(f"{key} is {', '.join(known[:-1])} or {known[-1]}, not {value!r}")
    return encoding.turned(axis, int(sign), "".join(f"{MARK}{key}={value}" for key, value in turns.items()))
