"""The commands, each of which is built when it is asked for; those of tables are made from the registry."""

from __future__ import annotations

import inspect
import sys
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command_from_info, get_command_name
from typer.models import CommandInfo

from ...ground.options.counts import whole_number
from ...ground.options.option import Field, Reading, fields_of
from ...ground.output.writing import check_is_folder, check_page
from ...run.workers.words import check_place
from ...tables.registry import TABLES
from ...tables.table import Group, Table
from .formats import Format, format_of
from .names import NAMES, completion_of
from .shared import FILES, WRITTEN, marks, split

# A panel of a command's help.
MEASURED = "Measurement"


MOST_OPTIONS = 12
HELP_ALL = "--help-all"


def is_told_all() -> bool:
    """Whether every option is to be shown."""
    return HELP_ALL in sys.argv


class Command(TyperCommand):
    """A command whose help has its options in groups.

    Attributes:
        taken: the names of the program's options that it takes.
    """

    taken: Sequence[str] = ()

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write each group of options under its title: all of them, or the first MOST_OPTIONS, those of the example
        before others."""
        options = [param for param in self.get_params(ctx) if param.param_type_name == "option"]
        words = (self.epilog or "").split()
        first = sorted(options, key=lambda option: not {*option.opts} & {*words})[:MOST_OPTIONS]
        groups: dict[str, list[tuple[str, str]]] = {}
        for param in self.get_params(ctx):
            title = getattr(param, "rich_help_panel", None) or f"{param.param_type_name.capitalize()}s"
            is_shown = is_told_all() or param in first or param not in options
            if is_shown and (record := param.get_help_record(ctx)):
                groups.setdefault(title, []).append(record)
        for title, records in groups.items():
            with formatter.section(title):
                formatter.write_dl(records)
        self._write_others(ctx, formatter, len(options) - len(first))

    def _write_others(self, ctx: Any, formatter: Any, left_out: int) -> None:
        """Say which options there are besides."""
        every = ctx.parent.command.params if ctx.parent else ()
        flags = [max(option.opts, key=len) for option in every if option.name in self.taken]
        more = [f"{left_out} more"] * bool(left_out and not is_told_all())
        if flags or more:
            formatter.write_paragraph()
            text = f"Also: {', '.join([*flags, *more])}. See normalbench {self.name} {HELP_ALL}."
            formatter.write(f"{textwrap.fill(text, formatter.width)}\n")


class Commands(Mapping[str, Any]):
    """The commands by name. One is built when it is asked for: the options of all take longer than most commands.

    Args:
        ready: commands whose functions are there.
        late: of further ones the information, whose callback makes the function.
    """

    def __init__(self, ready: typer.Typer, late: Mapping[str, Callable[[], CommandInfo]]):
        infos = [info for info in ready.registered_commands if info.callback]
        self._ready = {info.name or get_command_name(info.callback.__name__): info for info in infos}  # pyright: ignore
        self._late = late

    def info(self, name: str) -> CommandInfo:
        """Return what is known of a command without its options."""
        return self._ready.get(name) or self._late[name]()

    def __getitem__(self, name: str) -> Any:
        info = self.info(name)
        function = info.callback() if name in self._late and info.callback else info.callback
        callback, taken = split(function)  # pyright: ignore[reportArgumentType]
        named = {**vars(info), "name": name, "cls": Command, "callback": callback}
        command: Any = get_command_from_info(CommandInfo(**named), pretty_exceptions_short=False, rich_markup_mode=None)
        command.taken = taken
        return command

    def __contains__(self, name: object) -> bool:
        return name in self._ready or name in self._late

    def __iter__(self) -> Iterator[str]:
        return iter([*self._ready, *self._late])

    def __len__(self) -> int:
        return len(self._ready) + len(self._late)


# Commands that few people need, which the front page names without a line.
FURTHER = frozenset(("worker", "import", "columns", "renderdoc", "devices", "roofline", "sweep"))


class Grouped(TyperGroup):
    """The program, whose help has the commands by what they are for."""

    commands: Commands  # pyright: ignore[reportIncompatibleVariableOverride]

    def list_commands(self, ctx: Any = None) -> list[str]:  # noqa: ARG002
        """Return the names of the commands, those for one purpose together."""
        return sorted(self.commands, key=lambda name: [*Group].index(self._group(name)))

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write a page of one line for each command, or everything."""
        if is_told_all():
            super().format_help(ctx, formatter)
            return
        formatter.write(f"{inspect.getdoc(self.callback)}\n")
        for group, names in groupby(self.list_commands(ctx), key=self._group):
            formatter.write(f"{group}:\n")
            formatter.write("".join(f"  {name:<10}{self._lead(name)}\n" for name in names if name not in FURTHER))
        formatter.write(f"More: {', '.join(sorted(FURTHER))}\n")
        formatter.write(f"COMMAND --help shows the options of a command; {HELP_ALL} shows everything.\n")

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the first paragraph of each command's help under the title of its group."""
        for group, names in groupby(self.list_commands(ctx), key=self._group):
            with formatter.section(group):
                formatter.write_dl([(name, self._lead(name)) for name in names])

    def _group(self, name: str) -> Group:
        return Group(self.commands.info(name).rich_help_panel)

    def _lead(self, name: str) -> str:
        info = self.commands.info(name)
        return (info.help or inspect.getdoc(info.callback) or "").partition("\n\n")[0]


def table_info(name: str) -> CommandInfo:
    """Return a table's command, without its options."""
    table = TABLES[name]
    more = {"epilog": f"Example: {table.example}", "rich_help_panel": table.group}
    return CommandInfo(name, help=table.help, callback=partial(command_of, table), **more)


def command_of(table: Table) -> Callable[..., int]:
    """A table's command, with its options, what it writes, and what every table takes."""

    def command(format: Format | None, output: Path | None, report: Path | None, on: str | None, **typed: Any) -> int:
        from ..table_command import table_command

        check_page(report)
        check_place(on)
        check_is_folder(typed.get("images"), "--images writes into")
        options, outputs = (_made(group, typed) for group in (table.options, table.outputs))
        return table_command(table, options, outputs, format_of(format, output), output, report, on)

    ends = {"format": Format | None, "output": Path | None, "report": Path | None, "on": str | None}
    reads = fields_of(Reading) if issubclass(table.options, Reading) else {}
    typed = [parameter_of(f, FILES if f.name in reads else MEASURED) for f in fields_of(table.options).values()]
    typed += [parameter_of(field, WRITTEN) for field in fields_of(table.outputs).values()]
    typed += [
        inspect.Parameter(n, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind) for n, kind in ends.items()
    ]
    return with_parameters(command, typed)


def command_with(group: type, command: Callable[..., int], **ends: Any) -> Callable[..., int]:
    """A command of one dataclass of options, and of further ones by their annotations, none of which need be given."""

    def call(**typed: Any) -> int:
        return command(_made(group, typed), **{name: typed[name] for name in ends})

    keyword = inspect.Parameter.KEYWORD_ONLY
    typed = [parameter_of(field) for field in fields_of(group).values()]
    typed += [inspect.Parameter(name, keyword, default=None, annotation=kind) for name, kind in ends.items()]
    return with_parameters(call, typed)


def with_options(group: type, command: Callable[..., int]) -> Callable[..., int]:
    """A command that takes the options of a dataclass as well, by their names in Python."""
    own = inspect.signature(command, eval_str=True).parameters.values()
    typed = [parameter for parameter in own if parameter.kind is not inspect.Parameter.VAR_KEYWORD]
    return with_parameters(command, [*typed, *map(parameter_of, fields_of(group).values())])


def _made(group: type, typed: dict[str, Any]) -> Any:
    """Typed values as a dataclass of options."""
    return group(**{name: typed[name] for name in fields_of(group)})


def parameter_of(field: Field, panel: str = MEASURED) -> inspect.Parameter:
    """An option as typer sees it, in a panel of its help; without dashes it is an argument."""
    option, kind = field.option, inspect.Parameter.KEYWORD_ONLY
    if not option.flag.startswith("-"):
        shown = Annotated[_typed(field), typer.Argument(help=option.help, metavar=option.flag)]
        return inspect.Parameter(field.name, kind, annotation=shown)
    more: dict[str, Any] = {"rich_help_panel": panel}
    if field.kind is int:
        more |= {"parser": _whole_number, "metavar": "<int>"}
    if field.name in NAMES:
        more |= {"autocompletion": completion_of(field.name)}
    flags = [flag for flag in (option.letter, option.flag) if flag]
    shown = Annotated[_typed(field), typer.Option(*flags, help=option.help, **more), *marks(field)]
    return inspect.Parameter(field.name, kind, default=field.typed, annotation=shown)


def _typed(field: Field) -> Any:
    """An option's type as typer knows it: several names are one text."""
    if not field.has_names:
        return field.type
    return str if isinstance(field.default, tuple) else str | None


def _whole_number(text: str) -> int:
    try:
        return whole_number(text)
    except ValueError as error:
        raise typer.BadParameter(str(error)) from error


def with_parameters(command: Callable[..., Any], parameters: list[inspect.Parameter]) -> Callable[..., Any]:
    """A function with another signature, as typer reads it."""
    command.__signature__ = inspect.Signature(parameters)  # pyright: ignore[reportFunctionMemberAccess]
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return command
