"""Options of many commands, which the program has once: they may stand anywhere in a command line."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any

import typer

from ...ground.options.option import Field, Reading, Sources, fields_of
from ...ground.output.errors import UsageError
from ...run.workers.words import HELP
from .formats import Format

OUTPUT = "Path to write the command's rows, page or folder to. A stopped command can then be resumed."
FORMAT = f"Output format: {', '.join(Format)}. Default: from the extension of -o, or table."
REPORT = "Write a page with the results, charts and images to this file."
# Panels of the program's help.
WRITTEN, SHADERS, FILES = "Output", "Shader files", "Files of normals"
# Where rows go, by the names that commands have for it in Python.
WRITES: Mapping[str, Any] = MappingProxyType(
    {
        "output": Annotated[Path | None, typer.Option("-o", "--output", help=OUTPUT, rich_help_panel=WRITTEN)],
        "format": Annotated[Format | None, typer.Option(help=FORMAT, metavar="<name>", rich_help_panel=WRITTEN)],
        "report": Annotated[Path | None, typer.Option(help=REPORT, rich_help_panel=WRITTEN)],
        "on": Annotated[str | None, typer.Option(help=HELP, metavar="WORKERS", rich_help_panel=WRITTEN)],
    }
)
# By its name in Python, what the program is given of an option, if it is given.
given: dict[str, Any] = {}


@cache
def own_fields() -> Mapping[str, Field]:
    """Return the options of files of normals and of shaders, which many tables have, by name."""
    return {name: field for name, field in {**fields_of(Sources), **fields_of(Reading)}.items() if name != "size"}


def parameters(parameter_of: Callable[[Field, str], inspect.Parameter]) -> Iterator[inspect.Parameter]:
    """Yield the program's own options that commands share; of each None says that it is not given.

    Args:
        parameter_of: (field, panel) -> the option of a field.
    """
    for name, kind in WRITES.items():
        yield inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind)
    for name, field in own_fields().items():
        parameter = parameter_of(field, FILES if name in fields_of(Reading) else SHADERS)
        kind, *more = parameter.annotation.__args__[0], *parameter.annotation.__metadata__
        yield parameter.replace(default=None, annotation=Annotated[kind | None, *more])


# Stands in the annotation of an option of a command that is one of the program's.
SHARED = "shared"


def marks(field: Field) -> tuple[str, ...]:
    """Return what marks an option as one that the program has; nothing for another one, whatever its name."""
    own = own_fields().get(field.name)
    return (SHARED,) if own and own.option == field.option else ()


def split(command: Callable[..., Any]) -> tuple[Callable[..., Any], list[str]]:
    """Return a command without the options that it shares, which it is called with all the same; and their names."""
    every = inspect.signature(command, eval_str=True).parameters.values()
    marked = (p for p in every if p.name in WRITES or SHARED in getattr(p.annotation, "__metadata__", ()))
    shared = {parameter.name: parameter.default for parameter in marked}

    def call(**typed: Any) -> Any:
        if odd := next((name for name in given if name not in shared), ""):
            raise UsageError(f"--{odd.replace('_', '-')} is not an option of this command")
        return command(**typed, **{name: given.get(name, default) for name, default in shared.items()})

    left = [parameter for parameter in every if parameter.name not in shared]
    call.__doc__, call.__signature__ = command.__doc__, inspect.Signature(left)  # pyright: ignore
    call.__annotations__ = {parameter.name: parameter.annotation for parameter in left}
    return call, list(shared)


def moved_to_the_front(
    words: Sequence[str], command: Sequence[Any], shared: Sequence[Any]
) -> tuple[list[str], list[str]]:
    """Return a command's words: those of the program's options, and the others.

    Args:
        words: with each option once, see `added_up`.
        command: options of the command, as typer has them.
        shared: those of the program that the command takes.
    """
    by_flag = {flag: option for option in shared for flag in (*option.opts, *option.secondary_opts)}
    own = {flag for option in command for flag in (*option.opts, *option.secondary_opts)}
    front, rest, left = list[str](), list[str](), iter(words)
    for word in left:
        flag = word.partition("=")[0] if word.startswith("--") else word[:2]
        option = by_flag.get(flag) if word.startswith("-") and flag not in own else None
        if option is None:
            rest.append(word)
        elif option.is_flag or word != flag:
            front.append(word)
        else:
            front += [word, *([value] if (value := next(left, None)) is not None else [])]
    return front, rest
