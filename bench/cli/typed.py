"""What people type, before it is parsed: options that are repeated."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, get_args

from ..output.errors import UsageError


def added_up(words: Sequence[str], options: Sequence[Any]) -> list[str]:
    """Words with each option once: texts, which are lists of names, are joined by commas.

    Args:
        words: what follows the name of the command.
        options: the command's, as typer has them.

    Raises:
        UsageError: another option is given twice, with different values.
    """
    by_flag = {flag: option for option in options for flag in (*option.opts, *option.secondary_opts)}
    made: list[str] = []
    # Of each option its flag as typed first, and where its value stands among `made`.
    seen: dict[str, tuple[str, int]] = {}
    rest = iter(words)
    for word in rest:
        if word == "--":
            return [*made, word, *rest]
        flag, option = _option_of(word, by_flag)
        if option is None:
            made.append(word)
        elif option.is_flag:
            _add_flag(made, word, seen, option)
        else:
            value = _value_of(word, flag, rest)
            if value is None:
                made.append(word)
            else:
                _add(made, (flag, value), seen, option)
    return made


def _option_of(word: str, by_flag: dict[str, Any]) -> tuple[str, Any]:
    flag = word.partition("=")[0] if word.startswith("--") else word[:2]
    return flag, by_flag.get(flag) if word.startswith("-") and word != "-" else None


def _value_of(word: str, flag: str, rest: Any) -> str | None:
    """What stands behind the flag, or after it; None where nothing does, which the parser says."""
    if word == flag:
        return next(rest, None)
    return word[len(flag) :].removeprefix("=")


def _add_flag(made: list[str], word: str, seen: dict[str, tuple[str, int]], option: Any) -> None:
    first, _ = seen.setdefault(option.name, (word, len(made)))
    if first != word:
        raise UsageError(f"{first} and {word} contradict each other; give one of them")
    if word not in made:
        made.append(word)


def _add(made: list[str], typed: tuple[str, str], seen: dict[str, tuple[str, int]], option: Any) -> None:
    flag, value = typed
    if option.name not in seen:
        seen[option.name] = flag, len(made) + 1
        made += [flag, value]
        return
    first, at = seen[option.name]
    if _is_text(option):
        made[at] = f"{made[at]},{value}"
    elif made[at] != value:
        raise UsageError(f"{first} is given twice, {made[at]} and {value}; give it once")


def _is_text(option: Any) -> bool:
    kind = option.type_descriptor.annotation
    return kind is str or str in get_args(kind)
