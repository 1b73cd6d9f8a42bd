"""The command line: `normalbench COMMAND`.

Heavy packages are imported inside the commands, so that `--help` and `list` answer at once; so is whatever imports the
catalogue, so that an encoding that cannot be imported is a one-line error.
"""

from __future__ import annotations

import atexit
import inspect
import io
import os
import re
import signal
import sys
from collections.abc import Callable
from enum import StrEnum
from functools import partial
from pathlib import Path
from types import FrameType
from typing import IO, Annotated, Any, NoReturn

import typer
from typer.exceptions import Abort, TyperException
from typer.models import CommandInfo

from ....encodings.codecs.files import CatalogueError
from ....reports.charts.plots import PlotError
from ...ground.machine.memory import lack_of_memory, require_memory
from ...ground.machine.systems import alarm
from ...ground.options.code import CodeOptions
from ...ground.options.option import Sources
from ...ground.options.words import names
from ...ground.output.errors import MissingError, UsageError, tell, told
from ...ground.output.progress import ending
from ...ground.output.replacing import reads
from ...ground.output.writing import abandon_output, check_is_folder
from ...keep.row_files import write
from ...run.workers.words import check_place
from ...tables.registry import TABLES
from ...tables.table import Group
from . import shared
from .commands import (
    HELP_ALL,
    Commands,
    Grouped,
    command_with,
    parameter_of,
    table_info,
    with_options,
    with_parameters,
)
from .device_commands import add_devices
from .formats import Format, format_of
from .history_commands import add_history
from .inputs import keep_inputs
from .renderdoc_commands import add_renderdoc
from .typed import added_up, check_begins_with_command

# The program itself, and the commands whose functions are here.
program_alone = typer.Typer(
    cls=Grouped,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
app = typer.Typer()

# What `list` leaves out where the terminal is narrow.
SPARED = (
    *("from", "holds", "decals", "year", "reflects_by", "bytes_with_light", "bytes_per_pixel", "components"),
    *("domain", "engine"),
)
INTERRUPTED, TERMINATED = 130, 143
NO_CACHE, ANEW = "--no-cache", "--anew"
# What the library that reads values says, and what is said for it.
PARSERS_WORDS = {
    "Value error, ": "",
    "Input should be a valid number, unable to parse string as a number": "expected a number, such as 0.5",
    "Input should be a valid integer, unable to parse string as an integer": "expected a whole number, such as 4",
}
# How soon an interruption is tried again that came at a bad time, in seconds.
AGAIN_S = 0.02
# A part of the paths of moderngl's own files.
MODERNGL = f"{os.sep}moderngl{os.sep}"


def _version(is_asked: bool) -> None:
    """Say the version, and end."""
    if is_asked:
        from importlib.metadata import version

        print(version("normalbench"))
        raise typer.Exit


def every_command(
    _is_asked: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
    no_cache: Annotated[
        bool, typer.Option(NO_CACHE, help="Do not read or write cached instruction counts and compiled programs.")
    ] = False,
    anew: Annotated[
        bool, typer.Option(ANEW, help="Ignore cached results of pick, budget and cost, and measure again.")
    ] = False,
    **typed: Any,
) -> None:
    """Measure how accurate and how expensive compact normals and G-buffers are."""
    if no_cache:
        from ...ground.output import cache

        cache.switch_off()
    if anew:
        from ...ground.output import cache

        cache.measure_anew()
    shared.given.clear()
    shared.given.update({name: value for name, value in typed.items() if value is not None})


def _with_shared(command: Callable[..., None]) -> Any:
    """Give the program the options that its commands share."""
    own = [p for p in inspect.signature(command, eval_str=True).parameters.values() if p.name != "typed"]
    return with_parameters(command, [*own, *shared.parameters(parameter_of)])


program_alone.callback()(_with_shared(every_command))


@app.command("list", rich_help_panel=Group.MACHINE, epilog="Example: normalbench list storages")
def list_command(
    what: Annotated[
        str,
        typer.Argument(
            help="What to list: encodings, storages, depths, frames, vectors, curves, normals, layouts, pipelines, "
            "effects, scenes, environments, lights, or all."
        ),
    ] = "all",
    format: Format | None = None,
    output: Path | None = None,
) -> None:
    """List encodings, storages, layouts, scenes and the rest."""
    from ...subjects.names.listing import listing

    write(listing(names(what)), format_of(format, output), output, SPARED, by="kind")


def doctor(
    file: Annotated[
        Path | None, typer.Argument(help="Shader file, or a folder of shader files: GLSL, HLSL, Slang or WGSL.")
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            "--plot", help="Plot the encoding's error over the sphere to this file, with bad directions marked."
        ),
    ] = None,
    storage: Annotated[
        str | None,
        typer.Option(
            "--storage", help="Storage for the plot and for the comparison with the catalogue. Default: rgba8."
        ),
    ] = None,
    domain: Annotated[
        str | None,
        typer.Option(
            "--domain", help="Normals that the encoding is meant for: sphere, hemisphere or view. Default: detected."
        ),
    ] = None,
    diff: Annotated[
        Path | None,
        typer.Option(
            "--diff", help="Folders only: write a patch with better encodings to this file; it is not applied."
        ),
    ] = None,
    report: Path | None = None,
    format: Format | None = None,
    output: Path | None = None,
    **sources: Any,
) -> int:
    """Describe this machine, or check a shader file or a folder of them.

    The exit status is 1 if a problem is found. Without a file: versions, cores, the OpenGL device and how it rounds.
    With a file: what encode and decode do to directions before any storage. With a folder: one line per pair in it,
    with the best encoding of the same bit count.
    """
    require_memory()
    if file is None and plot is None and not any((storage, domain, diff, report, *sources.values())):
        from ...keep.machine import examine

        write(examine(), format_of(format, output), output)
        return 0
    from ..examine import examine_encoding

    return examine_encoding(file, plot, format_of(format, output), output, storage, domain, diff, report, sources)


app.command(rich_help_panel=Group.OWN, epilog="Example: normalbench doctor mine.glsl --plot sphere.png")(
    with_options(Sources, doctor)
)


def _run(options: Any, output: Path | None, on: str | None, commit: str | None) -> int:
    from ..run import run_command

    check_is_folder(output, "run writes into")
    check_place(on)
    return run_command(options, output, on, commit)


CommitOption = Annotated[
    str | None,
    typer.Option(
        "--commit",
        help="Name of this run's commit in history. Default: the commit of this folder's Git repository.",
        metavar="NAME",
    ),
]


def _run_info() -> CommandInfo:
    """Return the command `run`, without its options: they are those of all tables."""
    return CommandInfo(
        rich_help_panel=Group.ANSWER,
        help="Measure the default suite and write a report to a folder.\n\n"
        "To resume a run that was stopped, repeat the command. With -o, a finished run is extended.",
        epilog="Example: normalbench run --tables quality,cost --encoding octahedral,xyz --storage rgb10a2",
        callback=_run_with_options,
    )


def _run_with_options() -> Callable[..., int]:
    from ..run_options import RunOptions

    return command_with(RunOptions, _run, output=Path | None, on=str | None, commit=CommitOption)


@app.command(rich_help_panel=Group.MACHINE, epilog="Example: normalbench worker tcp://127.0.0.1:8786")
def worker(
    scheduler: Annotated[str, typer.Argument(help="Address of a dask scheduler.", metavar="tcp://HOST:PORT")],
) -> int:
    """Measure for commands that name this scheduler in --on, until interrupted."""
    from ...run.workers.worker import worker_command

    return worker_command(scheduler)


def _code(options: Any, format: Format | None, output: Path | None) -> int:
    from ..code_command import code_command

    return code_command(options, format_of(format, output if options.check else None), output)


app.command(
    "code",
    rich_help_panel=Group.OWN,
    help="Write verified shader functions for an encoding in a storage.\n\n"
    "Encode, pack, unpack and decode are run and compared with the catalogue before they are written.",
    epilog="Example: normalbench code octahedral --storage rgb10a2 --to hlsl",
)(command_with(CodeOptions, _code, format=Format | None, output=Path | None))


@app.command("columns", rich_help_panel=Group.MACHINE, epilog="Example: normalbench columns quality")
def columns_command(
    table: Annotated[str, typer.Argument(help="Tables, comma-separated, or all.")],
    format: Format | None = None,
    output: Path | None = None,
) -> None:
    """Explain the columns of a table: definitions, units and which direction is better."""
    from ...tables.columns import columns

    write(columns(names(table)), format_of(format, output), output, by="table")


@app.command(rich_help_panel=Group.KEEP, epilog="Example: normalbench check gates.toml")
def check(
    gates: Annotated[Path, typer.Argument(help="TOML file of [[gate]] tables.")],
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Check only the gates that use one of these files, directly or by #include.", metavar="FILE..."
        ),
    ] = None,
    run: Annotated[
        Path | None, typer.Option("--run", help="Take the figures from this results folder. Default: measure them.")
    ] = None,
    write_baseline: Annotated[
        bool,
        typer.Option("--write-baseline", help="Write the baselines of the gates instead of comparing with them."),
    ] = False,
    format: Format | None = None,
    output: Path | None = None,
) -> int:
    """Check figures against a team's thresholds.

    The exit status is 1 if any fails.
    """
    from ..gates.check_command import check_command

    return check_command(gates, files or (), run, write_baseline, format_of(format, output), output)


class FailOn(StrEnum):
    never = "never"
    worse = "worse"
    change = "change"


@app.command(rich_help_panel=Group.KEEP, epilog="Example: normalbench compare before after")
def compare(
    before: Annotated[Path, typer.Argument(help="Results folder before the change.")],
    after: Annotated[Path, typer.Argument(help="Results folder after the change.")],
    fail_on: Annotated[FailOn, typer.Option("--fail-on", help="When to exit with status 1.")] = FailOn.never,
    format: Format | None = None,
    output: Path | None = None,
) -> int:
    """Compare two runs, the largest changes first.

    Figures are compared exactly; timings count only if the change exceeds the noise. Tables and Markdown have at most
    20 lines; JSON and CSV contain every figure that differs.
    """
    from ...keep.compare_command import compare_command

    return compare_command(before, after, fail_on, format_of(format, output), output)


@app.command(rich_help_panel=Group.KEEP, epilog="Example: normalbench show before quality")
def show(
    run: Annotated[Path, typer.Argument(help="Results folder.", metavar="RUN")],
    tables: Annotated[str, typer.Argument(help="Tables to print, comma-separated, or all.", metavar="TABLE")] = "",
) -> None:
    """Print the verdict of each table of a run, or whole tables."""
    from ...show.show_command import show_command

    show_command(run, names(tables))


class PicturePlace(StrEnum):
    inside = "inside"
    beside = "beside"


@app.command(rich_help_panel=Group.KEEP, epilog="Example: normalbench report before -o page.html")
def report(
    run: Annotated[Path, typer.Argument(help="Results folder.", metavar="RUN")],
    markdown: Annotated[
        bool,
        typer.Option("--markdown", help="Write Markdown for a pull request comment to standard output or -o instead."),
    ] = False,
    pictures: Annotated[
        PicturePlace,
        typer.Option(
            "--pictures", help="inside: as many images as keep the page small; beside: all, in files next to the page."
        ),
    ] = PicturePlace.inside,
    charts: Annotated[
        bool,
        typer.Option("--charts", help="Also write every chart as PNG and SVG to a folder next to the page."),
    ] = False,
    output: Path | None = None,
) -> None:
    """Write a run's report as one page that opens offline.

    The run itself is not changed.
    """
    from ...show.report import report_command

    report_command(run, markdown, pictures is PicturePlace.beside, charts, output)


add_history(app)
add_renderdoc(app)
add_devices(app)
COMMANDS = Commands(app, {name: partial(table_info, name) for name in TABLES} | {"run": _run_info})


def command_line() -> Grouped:
    """Return the program with its commands, which are built as they are asked for."""
    group: Any = typer.main.get_command(program_alone)
    group.commands = COMMANDS
    return group


def _say(message: str) -> None:
    tell(message)


def _end(number: int, frame: FrameType | None) -> None:
    """Raise what ends the program, once no module is being imported and no call of moderngl is under way: libraries in
    C++ would not survive it there."""
    if _is_delicate(frame):
        alarm.call_later(AGAIN_S, lambda later: _end(number, later))
        return
    # What was put off before would end the program a second time, while it tidies up.
    alarm.call_none()
    by = SystemExit(TERMINATED) if number == signal.SIGTERM else KeyboardInterrupt()
    ending.append(by)
    sys.unraisablehook = _say_unless_ending
    raise by


def _is_delicate(frame: FrameType | None) -> bool:
    """Whether an exception that is raised here could pass through C++ that does not expect one: imports, and moderngl,
    whose compiled half calls Python back."""
    while frame:
        file = frame.f_code.co_filename
        if file.startswith("<frozen importlib") or MODERNGL in file:
            return True
        frame = frame.f_back
    return False


def _say_unless_ending(what: sys.UnraisableHookArgs) -> None:
    """What a callback swallowed: what was to end the program is raised again, since a worker that waits for its next
    job has no next step that would do so."""
    if not any(what.exc_value is by for by in ending):
        sys.__unraisablehook__(what)
        return
    number = signal.SIGTERM if isinstance(what.exc_value, SystemExit) else signal.SIGINT
    alarm.call_later(AGAIN_S, lambda later: _end(number, later))


def main() -> int:
    """Run the command line. Exit status: 0 well, 1 a check failed, 2 bad input or usage, 3 something is missing."""
    # A terminated run clears up after itself as an interrupted one does.
    signal.signal(signal.SIGTERM, _end)
    signal.signal(signal.SIGINT, _end)
    ending.clear()
    told.clear()
    reads.clear()
    try:
        if sys.stdout is None:
            _without_output(sys.argv)
        # Alone, the command shows its help; that is no error.
        command: Any = command_line()
        status = command(_words(sys.argv[1:], command) or ["--help"], standalone_mode=False) or 0
        if status == INTERRUPTED:
            _say("interrupted")
        return status
    except (UsageError, MissingError) as error:
        _say(str(error))
        return error.exit_code
    except (CatalogueError, PlotError) as error:
        _say(str(error))
        return UsageError.exit_code
    except TyperException as error:
        message = _plainly(error.format_message())
        _say(message + _hint(message))
        return UsageError.exit_code
    except (KeyboardInterrupt, Abort):
        _say("interrupted")
        return INTERRUPTED
    except (MemoryError, ImportError, RuntimeError) as error:
        # Without memory neither libraries nor threads start.
        why = lack_of_memory()
        if not (why or isinstance(error, MemoryError)):
            raise
        _say(why or f"not enough memory: {str(error) or 'the system has none left'}; measure less at once")
        return MissingError.exit_code
    except OSError as error:
        # Standard output has no name.
        if error.filename is None:
            abandon_output()
        _say(f"{error.filename or 'cannot write'}: {error.strerror or error}")
        return UsageError.exit_code


def _plainly(message: str) -> str:
    """Return the parser's message in this program's words."""
    for theirs, ours in PARSERS_WORDS.items():
        message = message.replace(theirs, ours)
    return message


def _hint(message: str) -> str:
    """Return a hint for the end of the parser's message; empty if there is none."""
    if "extra argument" in message:
        return "; give one name, or several separated by commas"
    return f" Commands: {', '.join(command_line().list_commands())}." if "command" in message else ""


def _words(words: list[str], group: Any) -> list[str]:
    """Return the typed words with each option once. Raises UsageError."""
    own = ["-h", "--help", *(flag for option in group.params for flag in option.opts)]
    # They may stand anywhere.
    words = ["--help" if word == HELP_ALL else word for word in words]
    anywhere = [flag for flag in (NO_CACHE, ANEW) if flag in words]
    words = [word for word in words if word not in anywhere]
    check_begins_with_command(words, group.list_commands, own)
    if not (words and words[0] in group.commands):
        return anywhere + words
    command = group.commands[words[0]]
    taken = [option for option in group.params if option.name in command.taken]
    typed = added_up(words[1:], [*command.params, *taken])
    keep_inputs(typed, [*command.params, *taken])
    front, rest = shared.moved_to_the_front(typed, command.params, taken)
    return [*anywhere, *front, words[0], *rest]


def _without_output(words: list[str]) -> None:
    """Standard output is closed: what is written there goes nowhere. Raises UsageError where no file is named."""
    if not any(word.startswith("--output") or re.match("-[a-z]*o", word) for word in words):
        raise UsageError("standard output is closed; name a file with -o")
    sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115 # until the process ends


def program() -> NoReturn:
    """`main` as a process of its own, which ends once its output is written: the interpreter would tidy up a million
    objects first, and beneath what is computed in other threads, which cannot be stopped."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        # As Python has stderr: where the terminal has no ° it reads \xb0, and the table is there.
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        status = main()
    except SystemExit as end:
        status = end.code
    # What is left is to tidy up, which takes less time than it takes to say that it was interrupted.
    alarm.call_none()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    if not ending:
        atexit._run_exitfuncs()
    unwritten = [stream for stream in (sys.stdout, sys.stderr) if stream and not _is_flushed(stream)]
    if isinstance(status, int) and (ending or not unwritten):
        os._exit(status)
    # Python says what cannot be written, and that the command failed.
    sys.exit(status)


def _is_flushed(stream: IO[str]) -> bool:
    """Whether a stream took all that was written to it."""
    try:
        stream.flush()
    except (OSError, ValueError):
        return False
    return True
