"""The command line: `normalbench COMMAND`.

Heavy packages are imported inside the commands, so that `--help` and `list` answer at once; so is whatever imports the
catalogue, so that an encoding that cannot be imported is said in one line.
"""

from __future__ import annotations

import signal
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer
from typer.exceptions import Abort, TyperException

from ..encodings.errors import CatalogueError
from .counts import DEFAULT_COUNT
from .errors import MissingError, UsageError
from .output import abandon_output, write

app = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Measures what compact normals cost in quality: encodings in JAX and GLSL, stored as hardware stores them.",
)


INTERRUPTED = 130


class Format(StrEnum):
    table = "table"
    json = "json"
    csv = "csv"
    markdown = "markdown"


Names = "comma-separated, or all; `normalbench list` shows them"
FormatOption = Annotated[Format, typer.Option("--format", help="How to write the rows.")]
OutputOption = Annotated[Path | None, typer.Option("-o", "--output", help="Write the rows to this file.")]
EncodingOption = Annotated[str, typer.Option("--encoding", help=f"Encodings, {Names}.")]
StorageOption = Annotated[str, typer.Option("--storage", help=f"Storages, {Names}.")]
RoundingOption = Annotated[str, typer.Option("--rounding", help="nearest, truncate; comma-separated, or all.")]
NormalsOption = Annotated[str, typer.Option("--normals", help=f"Normal sets, {Names}.")]
BackendOption = Annotated[str, typer.Option("--backend", help="jax, glsl; comma-separated, or all.")]
CountOption = Annotated[int, typer.Option("--count", help="Normals in a uniform set.")]
SeedOption = Annotated[int, typer.Option("--seed", help="What uniform sets are made with.")]


@app.command("list")
def list_command(
    what: Annotated[str, typer.Argument(help="encodings, storages, normals, or all.")] = "all",
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What there is: encodings, storages and normal sets."""
    from .listing import listing

    write(listing(what), format, output)


@app.command()
def doctor(format: FormatOption = Format.table, output: OutputOption = None) -> None:
    """What this machine has: versions, cores, the GL device and how it rounds."""
    from .doctor import examine

    write(examine(), format, output)


@app.command()
def quality(
    encoding: EncodingOption = "all",
    storage: StorageOption = "rgba8",
    rounding: RoundingOption = "nearest",
    normals: NormalsOption = "playground",
    backend: BackendOption = "jax,glsl",
    count: CountOption = DEFAULT_COUNT,
    seed: SeedOption = 0,
    images: Annotated[
        Path | None, typer.Option("--images", help="Write the seeds' pictures of each codec here (image sets).")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What each codec loses of the normals of a set: MSE, PSNR, angles, effective bits."""
    from .commands import Request, quality_command

    quality_command(Request(encoding, storage, rounding, normals, backend, count, seed), images, format, output)


@app.command()
def run(
    count: CountOption = DEFAULT_COUNT,
    seed: SeedOption = 0,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Results folder; must not exist. Default: results/<time>.")
    ] = None,
) -> None:
    """The default suite: the seeds' encodings in rgba8 and rg16f, as a table and a results folder with pictures."""
    from .commands import run_command

    run_command(count, seed, output)


def _say(message: str) -> None:
    print(f"normalbench: {' '.join(message.split())}", file=sys.stderr)


def main() -> int:
    """Run the command line. Exit status: 0 well, 1 a check failed, 2 bad input or usage, 3 something is missing."""
    # A terminated run clears up after itself as an interrupted one does.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        if sys.stdout is None:
            raise UsageError("standard output is closed; name a file with -o")
        # Alone, the command shows its help; that is no error.
        status = app(sys.argv[1:] or ["--help"], standalone_mode=False) or 0
        if status == INTERRUPTED:
            _say("interrupted")
        return status
    except (UsageError, MissingError) as error:
        _say(str(error))
        return error.exit_code
    except CatalogueError as error:
        _say(str(error))
        return UsageError.exit_code
    except TyperException as error:
        commands = ", ".join(c.name or c.callback.__name__ for c in app.registered_commands if c.callback)
        hint = f" Commands: {commands}." if "command" in error.format_message() else ""
        _say(error.format_message() + hint)
        return UsageError.exit_code
    except (KeyboardInterrupt, Abort):
        _say("interrupted")
        return INTERRUPTED
    except OSError as error:
        abandon_output()
        _say(f"cannot write: {error.strerror or error}")
        return UsageError.exit_code


if __name__ == "__main__":
    sys.exit(main())
