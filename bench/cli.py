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
from ..reports.plots import PlotError
from .counts import DEFAULT_COUNT
from .errors import MissingError, UsageError
from .output import abandon_output, write
from .progress import ending

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


PipelineOption = Annotated[str, typer.Option("--pipeline", help=f"Pipelines, {Names}.")]
LightBufferOption = Annotated[str, typer.Option("--light-buffer", help=f"Light buffers, {Names}.")]
LightTargetsOption = Annotated[str, typer.Option("--light-targets", help="1, 2; comma-separated, or all.")]
ShadowOption = Annotated[str, typer.Option("--shadow", help="on, off; comma-separated, or all.")]
SizeOption = Annotated[str, typer.Option("--size", help="WIDTHxHEIGHT of the image.")]
SamplesOption = Annotated[int, typer.Option("--samples", help="Samples a pixel; as many as the device has.")]
ScaleOption = Annotated[float, typer.Option("--scale", help="Size of inferred's buffers to the image's, up to 1.")]
LightsOption = Annotated[int, typer.Option("--lights", help="Point lights.")]
RepeatsOption = Annotated[int, typer.Option("--repeats", help="Frames that times are taken over.")]
SWEEP_OBJECTS = "100,200,500,1000,2000"


@app.command("list")
def list_command(
    what: Annotated[
        str, typer.Argument(help="encodings, storages, normals, layouts, pipelines, scenes, lights, or all.")
    ] = "all",
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What there is: encodings, storages, normal sets, layouts, pipelines, scenes and light buffers."""
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
def render(
    pipeline: PipelineOption = "hybrid",
    layout: Annotated[
        str | None, typer.Option("--layout", help="Layouts, names or TOML files, comma-separated. Default: fp32.")
    ] = None,
    encoding: Annotated[
        str | None, typer.Option("--encoding", help="Encodings to put into each layout, comma-separated, or all.")
    ] = None,
    storage: Annotated[str | None, typer.Option("--storage", help="And their storages. Default: rgba8.")] = None,
    rounding: Annotated[str | None, typer.Option("--rounding", help="And how those round. Default: nearest.")] = None,
    light_buffer: LightBufferOption = "rgba32f",
    light_targets: LightTargetsOption = "2",
    scene: Annotated[str, typer.Option("--scene", help=f"Scenes, {Names}.")] = "gloss",
    shadow: ShadowOption = "on",
    size: SizeOption = "640x480",
    samples: SamplesOption = 1,
    scale: ScaleOption = 1.0,
    objects: Annotated[int, typer.Option("--objects", help="Objects in the scene `objects`.")] = 200,
    lights: LightsOption = 64,
    frames: Annotated[int, typer.Option("--frames", help="Moments to average over. 0: as the scene has it.")] = 0,
    repeats: RepeatsOption = 3,
    seed: Annotated[int, typer.Option("--seed", help="What scenes are made with.")] = 0,
    flip: Annotated[
        bool, typer.Option("--flip", help="FLIP as well, a perceptual difference; a second a row.")
    ] = False,
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
    from .render_commands import RenderRequest, render_command

    request = RenderRequest(
        *(pipeline, layout, encoding, storage, rounding, light_buffer, light_targets, scene, shadow, size),
        *(samples, scale, objects, lights, frames, repeats, seed),
    )
    render_command(request, flip, images, format, output)


@app.command()
def sweep(
    pipeline: PipelineOption = "prepass,hybrid,deferred,inferred,forward",
    objects: Annotated[str, typer.Option("--objects", help="Numbers of objects, comma-separated.")] = SWEEP_OBJECTS,
    shadow: ShadowOption = "on,off",
    layout: Annotated[
        str | None, typer.Option("--layout", help="Layouts. Default: the one that each pipeline is published with.")
    ] = None,
    light_buffer: LightBufferOption = "rgba16f",
    light_targets: LightTargetsOption = "2",
    size: SizeOption = "1024x768",
    samples: SamplesOption = 1,
    scale: ScaleOption = 0.5,
    lights: LightsOption = 64,
    repeats: RepeatsOption = 5,
    seed: Annotated[int, typer.Option("--seed", help="What the scene is made with.")] = 0,
    plot: Annotated[Path | None, typer.Option("--plot", help="Draw it into this PNG, SVG or PDF file.")] = None,
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """How each pipeline's passes grow with the number of objects: light pre-pass against hybrid and the others.

    With -o a sweep that was stopped goes on where it was when the same command is run again.
    """
    from .sweep_command import SweepRequest, sweep_command

    request = SweepRequest(
        *(pipeline, objects, shadow, layout, light_buffer, light_targets, size, samples, scale),
        *(lights, repeats, seed),
    )
    sweep_command(request, plot, format, output)


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


if __name__ == "__main__":
    sys.exit(main())
