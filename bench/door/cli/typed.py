"""What people type, before it is parsed: options that are repeated, and words in a wrong place."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, get_args

from ...ground.output.errors import UsageError


def check_begins_with_command(
    words: Sequence[str], commands: Callable[[], Collection[str]], own: Collection[str]
) -> None:
    """Raises UsageError where a command's options stand before the command.

    Args:
        commands: gives their names in the order of the help, for which every table is imported.
        own: the options of the program itself.
    """
    if not words or not words[0].startswith("-") or words[0].partition("=")[0] in own:
        return
    names = commands()
    command = next((word for word in words if word in names), None)
    if command is None:
        raise UsageError(f"{words[0]}: begin with a command: {', '.join(names)}")
    others = [word for word in words if word != command]
    raise UsageError(f"the command comes first: normalbench {' '.join([command, *others])}")


def added_up(words: Sequence[str], options: Sequence[Any]) -> list[str]:
    """Words with each option once: texts, which are lists of names, are joined by commas.

    Args:
        words: what follows the name of the command.
        options: the command's, as typer has them.

    Raises:
        UsageError: another option is given twice, with different values, or a word belongs to no option.
    """
    by_flag = _by_flag(options)
    has_arguments = any(option.param_type_name == "argument" for option in options)
    merged: list[str] = []
    # Of each option its flag as typed first, and where its value stands among `made`.
    seen: dict[str, tuple[str, int]] = {}
    rest = iter(words)
    for word in rest:
        flag, option = _option_of(word, by_flag)
        if option is None and word.startswith("--"):
            # What follows an option that is not known is for the parser to refuse.
            return [*merged, word, *rest]
        if option is None and not (has_arguments or word.startswith("-")):
            raise _stray(word, merged, by_flag)
        if option is None:
            merged.append(word)
        elif option.is_flag:
            _add_flag(merged, word, seen, option)
        else:
            value = _value_of(word, flag, rest)
            if value is None:
                merged.append(word)
            else:
                _add(merged, (flag, value), seen, option)
    return merged


def read_values(words: Sequence[str], options: Sequence[Any]) -> Iterator[str]:
    """The values among words that a command reads. Options that take a path are what it writes.

    Args:
        words, options: as for `added_up`, which has refused what is wrong.
    """
    by_flag, rest = _by_flag(options), iter(words)
    for word in rest:
        flag, option = _option_of(word, by_flag)
        value = word if option is None or option.is_flag else _value_of(word, flag, rest)
        if value and not (option and _takes(option, Path)):
            yield value


def _by_flag(options: Sequence[Any]) -> dict[str, Any]:
    return {flag: option for option in options for flag in (*option.opts, *option.secondary_opts)}


def _stray(word: str, arguments: Sequence[str], by_flag: dict[str, Any]) -> UsageError:
    """What is wrong with a word that follows no option."""
    flag = arguments[-2] if len(arguments) > 1 else ""
    if flag in by_flag and _takes(by_flag[flag], str):
        return UsageError(f"separate names by commas: {flag} {arguments[-1]},{word}")
    return UsageError(f"unexpected argument {word}; did you mean {next(iter(by_flag))} {word}?")


def _option_of(word: str, by_flag: dict[str, Any]) -> tuple[str, Any]:
    flag = word.partition("=")[0] if word.startswith("--") else word[:2]
    return flag, by_flag.get(flag) if word.startswith("-") and word != "-" else None


def _value_of(word: str, flag: str, rest: Any) -> str | None:
    """Return the value of a flag: the rest of its word, or the next word; None if there is none."""
    if word == flag:
        return next(rest, None)
    return word[len(flag) :].removeprefix("=")


def _add_flag(arguments: list[str], word: str, seen: dict[str, tuple[str, int]], option: Any) -> None:
    first, _ = seen.setdefault(option.name, (word, len(arguments)))
    if first != word:
        raise UsageError(f"{first} and {word} contradict each other; give one of them")
    if word not in arguments:
        arguments.append(word)


def _add(arguments: list[str], typed: tuple[str, str], seen: dict[str, tuple[str, int]], option: Any) -> None:
    flag, value = typed
    if option.name not in seen:
        seen[option.name] = flag, len(arguments) + 1
        arguments += [flag, value]
        return
    first, index = seen[option.name]
    if _takes(option, str):
        arguments[index] = f"{arguments[index]},{value}"
    elif arguments[index] != value:
        raise UsageError(f"{first} is given twice, {arguments[index]} and {value}; give it once")


def _takes(option: Any, kind: type) -> bool:
    annotation = option.type_descriptor.annotation
    return annotation is kind or kind in get_args(annotation)
