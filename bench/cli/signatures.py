"""Commands as typer sees them: a parameter that is a class of options becomes those options."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator
from dataclasses import is_dataclass
from typing import Annotated, Any

import typer

from ..options.option import fields_of


def with_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The command as a function of each single option."""
    own = inspect.signature(command, eval_str=True).parameters
    groups: dict[str, Any] = {
        name: parameter.annotation for name, parameter in own.items() if is_dataclass(parameter.annotation)
    }
    parameters = [single for parameter in own.values() for single in _singly(parameter)]

    @functools.wraps(command)
    def call(**typed: Any) -> Any:
        made = {name: group(**{one: typed.pop(one) for one in fields_of(group)}) for name, group in groups.items()}
        return command(**made, **typed)

    call.__signature__ = inspect.Signature(parameters)  # pyright: ignore[reportAttributeAccessIssue]
    call.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return call


def _singly(parameter: inspect.Parameter) -> Iterator[inspect.Parameter]:
    if not is_dataclass(parameter.annotation):
        yield parameter.replace(kind=parameter.KEYWORD_ONLY)
        return
    for field in fields_of(parameter.annotation).values():
        shown = Annotated[field.type, typer.Option(field.option.flag, help=field.option.help)]
        yield inspect.Parameter(field.name, parameter.KEYWORD_ONLY, default=field.default, annotation=shown)
