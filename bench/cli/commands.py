"""The commands of the tables, made from the registry."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Annotated, Any

import typer

from ..options.option import Field, fields_of
from ..tables.table import Table
from .formats import Format, FormatOption, OutputOption

ReportOption = Annotated[
    Path | None,
    typer.Option("--report", help="Write a page of this table, with its charts and pictures, to this file."),
]


def add_tables(app: typer.Typer, tables: Iterable[Table]) -> None:
    """A command for each table."""
    for table in tables:
        app.command(table.name, help=table.help)(command_of(table))


def command_of(table: Table) -> Callable[..., int]:
    """A table's command, with its options, what it writes, and what every table takes."""

    def command(format: Format, output: Path | None, report: Path | None, **typed: Any) -> int:
        from ..suite.table_command import table_command

        options, outputs = (_made(group, typed) for group in (table.options, table.outputs))
        return table_command(table, options, outputs, format, output, report)

    ends = {"format": (FormatOption, Format.table), "output": (OutputOption, None), "report": (ReportOption, None)}
    typed = [parameter_of(field) for group in (table.options, table.outputs) for field in fields_of(group).values()]
    typed += [
        inspect.Parameter(n, inspect.Parameter.KEYWORD_ONLY, default=d, annotation=a) for n, (a, d) in ends.items()
    ]
    return with_parameters(command, typed)


def command_with(group: type, command: Callable[[Any, Path | None], int], output: Any) -> Callable[..., int]:
    """A command of one dataclass of options and an output."""

    def call(output: Path | None, **typed: Any) -> int:
        return command(_made(group, typed), output)

    typed = [parameter_of(field) for field in fields_of(group).values()]
    typed.append(inspect.Parameter("output", inspect.Parameter.KEYWORD_ONLY, default=None, annotation=output))
    return with_parameters(call, typed)


def _made(group: type, typed: dict[str, Any]) -> Any:
    """Typed values as a dataclass of options."""
    return group(**{name: typed[name] for name in fields_of(group)})


def parameter_of(field: Field) -> inspect.Parameter:
    """An option as typer sees it; without dashes it is an argument."""
    option, kind = field.option, inspect.Parameter.KEYWORD_ONLY
    if not option.flag.startswith("-"):
        shown = Annotated[field.type, typer.Argument(help=option.help, metavar=option.flag)]
        return inspect.Parameter(field.name, kind, annotation=shown)
    shown = Annotated[field.type, typer.Option(option.flag, help=option.help)]
    return inspect.Parameter(field.name, kind, default=field.default, annotation=shown)


def with_parameters(command: Callable[..., int], parameters: list[inspect.Parameter]) -> Callable[..., int]:
    """A function with another signature, as typer reads it."""
    command.__signature__ = inspect.Signature(parameters)  # pyright: ignore[reportFunctionMemberAccess]
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return command
