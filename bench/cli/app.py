"""The command line: `normalbench COMMAND`.

Heavy packages are imported inside the commands, so that `--help` and `list` answer at once; so is whatever imports the
catalogue, so that an encoding that cannot be imported is said in one line.
"""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from enum import StrEnum
from pathlib import Path
from typing import Annotated, NoReturn

import typer
from typer.exceptions import Abort, TyperException

from ...encodings.errors import CatalogueError
from ...reports.charts.plots import PlotError
from ..options.command_options import (
    CostOptions,
    DepthOptions,
    FramesOptions,
    LightsOptions,
    SuiteOptions,
    SweepOptions,
    TuneOptions,
)
from ..options.option import QualityOptions, Reading, RenderOptions
from ..output.errors import MissingError, UsageError
from ..output.progress import ending
from ..output.writing import abandon_output, write
from .signatures import with_options

app = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Measures what compact normals and thin G-buffers cost: encodings in JAX and GLSL, stored as hardware does.",
)

INTERRUPTED = 130


class Format(StrEnum):
    table = "table"
    json = "json"
    csv = "csv"
    markdown = "markdown"


FormatOption = Annotated[Format, typer.Option("--format", help="How to write the rows.")]
OutputOption = Annotated[Path | None, typer.Option("-o", "--output", help="Write the rows to this file.")]


@app.command("list")
def list_command(
    what: Annotated[
        str,
        typer.Argument(
            help="encodings, storages, depths, frames, normals, layouts, pipelines, scenes, lights, or all."
        ),
    ] = "all",
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What there is: encodings, storages, codes of depth and frames, sets, layouts, pipelines, scenes, lights."""
    from .listing import listing

    write(listing(what), format, output)


@app.command()
def doctor(format: FormatOption = Format.table, output: OutputOption = None) -> None:
    """What this machine has: versions, cores, the GL device and how it rounds."""
    from ..machine.doctor import examine

    write(examine(), format, output)


@app.command()
@with_options
def quality(
    options: QualityOptions,
    reading: Reading,
    images: Annotated[
        Path | None, typer.Option("--images", help="Write the seeds' pictures of each codec here (image sets).")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> int:
    """What each codec loses of the normals of a set: MSE, PSNR, angles, effective bits.

    A set may be a file: a captured frame (EXR, PNG, NPY) or a mesh seen by a camera (glTF, GLB, OBJ, PLY).
    """
    from ..tables.quality.command import Request, quality_command

    return quality_command(Request(**vars(options), reading=reading), images, format, output)


@app.command()
@with_options
def render(
    options: RenderOptions,
    images: Annotated[
        Path | None, typer.Option("--images", help="Write final, reference and difference pictures here.")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What codecs, layouts and light buffers do to the final image, against the same pipeline in fp32.

    Without --layout every encoding lies in rgba8 in an otherwise exact G-buffer. With --layout and none of --encoding,
    --storage and --rounding the layouts are measured as they are.
    """
    from ..tables.render.command import RenderRequest, render_command

    render_command(RenderRequest(**vars(options)), images, format, output)


@app.command()
@with_options
def sweep(
    options: SweepOptions,
    plot: Annotated[Path | None, typer.Option("--plot", help="Draw it into this PNG, SVG or PDF file.")] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """How each pipeline's passes grow with the number of objects: light pre-pass against hybrid and the others.

    With -o a sweep that was stopped goes on where it was when the same command is run again.
    """
    from ..tables.sweep.command import SweepRequest, sweep_command

    sweep_command(SweepRequest(**vars(options)), plot, format, output)


@app.command()
@with_options
def lights(
    options: LightsOptions,
    images: Annotated[
        Path | None, typer.Option("--images", help="Write falloffs, resolves, final and difference pictures here.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", help="Draw errors over the number of lights into this PNG, SVG or PDF.")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What light buffers lose: adding lights up, banding, rebuilt colour, antialiasing, and the final image.

    The model, in JAX, stands beside what the GL device does. Without a GL device the model is measured alone.
    """
    from ..tables.lights.command import LightsRequest, lights_command

    lights_command(LightsRequest(**vars(options)), images, plot, format, output)


@app.command()
@with_options
def depth(
    options: DepthOptions,
    images: Annotated[
        Path | None, typer.Option("--images", help="Write pictures of each code's error in a scene here.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", help="Draw errors over distance: a PNG, SVG or PDF file.")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """How far off a position is that was rebuilt from a stored depth, at distances and over the whole range.

    Errors are distances in the unit of --near and --far, of points anywhere on the screen; a distance stands for depths
    up to a sixteenth of it nearer or farther.
    """
    from ..tables.depth.command import DepthRequest, depth_command

    depth_command(DepthRequest(**vars(options)), images, plot, format, output)


@app.command()
@with_options
def frames(options: FramesOptions, format: FormatOption = Format.table, output: OutputOption = None) -> int:
    """What tangent frame codes lose: the angles of normals, of tangents and of the whole rotation, and lost hands.

    A set may be a mesh (glTF, GLB, OBJ, PLY): the frames of its vertices, authored or along its uv.
    """
    from ..tables.tangent_frames.command import FramesRequest, frames_command

    return frames_command(FramesRequest(**vars(options)), format, output)


@app.command()
@with_options
def cost(
    options: CostOptions,
    seeds: Annotated[bool, typer.Option("--seeds", help="The article's figures beside them.")] = False,
    disassembly: Annotated[
        Path | None, typer.Option("--disassembly", help="Write what each family's compiler made here.")
    ] = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", help="Draw cost against error into this PNG, SVG or PDF file.")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What encoding and decoding cost: instructions on five GPU families, and time; all of it by default.

    Counts are by Mesa's RADV for GPUs that need not be there, less an empty kernel that moves the same numbers.
    """
    from ..tables.cost.command import CostRequest, cost_command

    cost_command(CostRequest(**vars(options)), seeds, disassembly, plot, format, output)


@app.command()
@with_options
def tune(
    encoding: Annotated[str, typer.Argument(help="An encoding; `normalbench list encodings` shows them.")],
    options: TuneOptions,
    reading: Reading,
    table: Annotated[
        Path | None, typer.Option("--table", help="Write a tuned look-up into this file, a NumPy array.")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """Fit an encoding's parameters and its numbers' bits to normals; what that gains on a half that was held out.

    What is found has a name that --encoding and --storage take in every command, such as stereographic:scale=1.31.
    """
    from ..tables.tune.command import tune_command

    tune_command(encoding, options, reading, table, format, output)


@app.command()
@with_options
def run(
    options: SuiteOptions,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="Results folder, new or of a run that was stopped. Default: results/<time>."
        ),
    ] = None,
) -> None:
    """The default suite into a results folder with its report: normals, images, light, depth, frames, pass times.

    A run that was stopped goes on when the same command is run again.
    """
    from ..suite.run_command import run_command
    from ..suite.suite import SuiteRequest

    run_command(SuiteRequest(**vars(options)), output)


@app.command()
def check(
    gates: Annotated[Path, typer.Argument(help="A TOML file of [[gate]] tables.")],
    run: Annotated[
        Path | None, typer.Option("--run", help="Take the figures from this results folder. Default: measure them.")
    ] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> int:
    """Hold figures to a team's limits: pass or fail for each, exit status 1 where one fails."""
    from ..gates.check_command import check_command

    return check_command(gates, run, format, output)


@app.command()
def compare(
    before: Annotated[Path, typer.Argument(help="A results folder.")],
    after: Annotated[Path, typer.Argument(help="Another one.")],
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What changed between two runs: figures exactly, times only where the difference is more than chance."""
    from ..results.compare_command import compare_command

    compare_command(before, after, format, output)


@app.command()
def report(
    run: Annotated[Path, typer.Argument(help="A results folder.")],
    markdown: Annotated[
        bool, typer.Option("--markdown", help="A text for a pull request comment instead, to standard output or -o.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write the page to this file. Default: report.html in the folder."),
    ] = None,
) -> None:
    """A run on one page: who wins, tables, pictures, charts, and how each figure was measured. Opens offline.

    The charts lie beside the page in the folder charts, as PNG and SVG files. The run's own files stay as they are.
    """
    from ..suite.report_command import report_command

    report_command(run, markdown, output)


def _say(message: str) -> None:
    print(f"normalbench: {' '.join(message.split())}", file=sys.stderr)


def _end(by: BaseException) -> None:
    ending.append(by)
    sys.unraisablehook = _say_unless_ending
    raise by


def _say_unless_ending(what: sys.UnraisableHookArgs) -> None:
    """What a callback swallowed: nothing to be said of what the next step raises again."""
    if not any(what.exc_value is by for by in ending):
        sys.__unraisablehook__(what)


def main() -> int:
    """Run the command line. Exit status: 0 well, 1 a check failed, 2 bad input or usage, 3 something is missing."""
    # A terminated run clears up after itself as an interrupted one does.
    signal.signal(signal.SIGTERM, lambda *_: _end(SystemExit(143)))
    signal.signal(signal.SIGINT, lambda *_: _end(KeyboardInterrupt()))
    ending.clear()
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
    except (CatalogueError, PlotError) as error:
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


def program() -> NoReturn:
    """`main` as a process of its own, which an interruption ends at once: what is computed in other threads cannot be
    stopped, and the interpreter should not tidy up beneath them."""
    try:
        status = main()
    except SystemExit as end:
        status = end.code
    if ending and isinstance(status, int):
        for stream in filter(None, (sys.stdout, sys.stderr)):
            with suppress(OSError, ValueError):
                stream.flush()
        os._exit(status)
    sys.exit(status)
