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
NormalsOption = Annotated[str, typer.Option("--normals", help=f"Normal sets or files, {Names}.")]
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
        str, typer.Argument(help="encodings, storages, depths, normals, layouts, pipelines, scenes, lights, or all.")
    ] = "all",
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What there is: encodings, storages, depth codes, normal sets, layouts, pipelines, scenes and light buffers."""
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
    channels: Annotated[
        str | None, typer.Option("--channels", help="Of a capture: a layer, or the channels of x,y,z by name.")
    ] = None,
    unpack: Annotated[
        bool | None, typer.Option("--unpack/--no-unpack", help="Of a capture: [0,1] stands for [-1,1]. PNG: always.")
    ] = None,
    normalise: Annotated[bool, typer.Option("--normalise", help="Of a capture: take normals of any length.")] = False,
    space: Annotated[str, typer.Option("--space", help="Of a capture: view, view-left-handed, world.")] = "view",
    view_matrix: Annotated[
        str | None, typer.Option("--view-matrix", help="World to view space: 9 or 16 numbers by rows, or a file.")
    ] = None,
    mask: Annotated[
        str | None, typer.Option("--mask", help="Of a capture: a file or a channel that is 0 on the background.")
    ] = None,
    nan_share: Annotated[
        float, typer.Option("--nan-share", help="Of a capture: the share of NaN that is masked and counted.")
    ] = 0.0,
    fov: Annotated[
        float | None, typer.Option("--fov", help="Of a capture: vertical degrees, for per-pixel view space.")
    ] = None,
    size: Annotated[str, typer.Option("--size", help="WIDTHxHEIGHT of the picture of a mesh.")] = "640x480",
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What each codec loses of the normals of a set: MSE, PSNR, angles, effective bits.

    A set may be a file: a captured frame (EXR, PNG, NPY) or a mesh seen by a camera (glTF, GLB, OBJ, PLY).
    """
    from .captures import Reading
    from .commands import Request, quality_command

    reading = Reading(channels, unpack, normalise, space, view_matrix, mask, nan_share, fov, size)
    request = Request(encoding, storage, rounding, normals, backend, count, seed, reading)
    quality_command(request, images, format, output)


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
    scene: Annotated[str, typer.Option("--scene", help=f"Scenes or mesh files, {Names}.")] = "gloss",
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
def lights(
    experiment: Annotated[
        str, typer.Option("--experiment", help="equal, random, banding, chromaticity, resolve, image; or all.")
    ] = "all",
    light_buffer: LightBufferOption = "all",
    light_targets: LightTargetsOption = "all",
    sums: Annotated[str, typer.Option("--sum", help="equal: what the lights sum to; random: the least.")] = "1,4",
    counts: Annotated[str, typer.Option("--counts", help="equal, random: how many they are.")] = "8,64,256",
    peaks: Annotated[str, typer.Option("--peak", help="banding: the light at a lamp's centre.")] = "0.1,1,2,3",
    samples: Annotated[str, typer.Option("--samples", help="resolve: samples a pixel.")] = "1,2,4,8",
    pipeline: PipelineOption = "prepass",
    scene: Annotated[
        str, typer.Option("--scene", help=f"resolve, image: scenes or mesh files, {Names}.")
    ] = "objects,gloss",
    power: Annotated[str, typer.Option("--power", help="image: specular powers.")] = "1,47,256",
    size: SizeOption = "320x240",
    objects: Annotated[int, typer.Option("--objects", help="Objects in the scene `objects`.")] = 200,
    lights: LightsOption = 64,
    seed: Annotated[int, typer.Option("--seed", help="What lights and scenes are made with.")] = 0,
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
    from .lights_command import LightsRequest, lights_command

    request = LightsRequest(
        *(experiment, light_buffer, light_targets, sums, counts, peaks, samples, pipeline, scene, power, size),
        *(objects, lights, seed),
    )
    lights_command(request, images, plot, format, output)


@app.command()
def depth(
    depth: Annotated[str, typer.Option("--depth", help=f"Depth codes, {Names}.")] = "all",
    storage: Annotated[
        str | None, typer.Option("--storage", help=f"Depth storages, {Names}. Default: where each code usually lies.")
    ] = None,
    rebuild: Annotated[
        str | None,
        typer.Option(
            "--rebuild", help="inverse_projection, eye_ray; comma-separated, or all. Default: each code's usual."
        ),
    ] = None,
    near: Annotated[str, typer.Option("--near", help="Near planes, comma-separated.")] = "0.1,1",
    far: Annotated[str, typer.Option("--far", help="Far planes, comma-separated.")] = "1000",
    distance: Annotated[
        str | None, typer.Option("--distance", help="Distances, comma-separated. Default: every power of ten.")
    ] = None,
    fov: Annotated[float, typer.Option("--fov", help="Vertical field of view in degrees, of a 16:9 image.")] = 60.0,
    backend: BackendOption = "jax,glsl",
    count: Annotated[int, typer.Option("--count", help="Points at each distance.")] = 2**14,
    seed: Annotated[int, typer.Option("--seed", help="What points are made with.")] = 0,
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
    from .depth_command import DepthRequest, depth_command

    request = DepthRequest(depth, storage, rebuild, near, far, distance, fov, backend, count, seed)
    depth_command(request, images, plot, format, output)


@app.command()
def cost(
    encoding: EncodingOption = "all",
    isa: Annotated[bool, typer.Option("--isa", help="What compilers make of the GLSL; needs no GPU.")] = False,
    time: Annotated[bool, typer.Option("--time", help="Nanoseconds a megapixel on the GL device.")] = False,
    jax: Annotated[bool, typer.Option("--jax", help="Million normals a second in JAX.")] = False,
    family: Annotated[
        str, typer.Option("--family", help="GPUs: polaris10, vega10, navi10, navi21, navi31; comma-separated, or all.")
    ] = "all",
    stage: Annotated[
        str, typer.Option("--stage", help="fragment, compute; comma-separated, or all.")
    ] = "fragment,compute",
    operation: Annotated[
        str, typer.Option("--operation", help="encode, decode; comma-separated, or all.")
    ] = "encode,decode",
    storage: Annotated[
        str, typer.Option("--storage", help="Storages and packings whose own cost is shown, comma-separated, or all.")
    ] = "rgba8,rgba8_snorm,11:11,12:12,16:16,11:10:11,depth16,depth24",
    size: Annotated[str, typer.Option("--size", help="WIDTHxHEIGHT of the target that is timed.")] = "256x256",
    repeats: Annotated[int, typer.Option("--repeats", help="Repetitions that medians are taken over.")] = 9,
    count: Annotated[int, typer.Option("--count", help="Normals, for JAX and in uniform sets.")] = 2**20,
    seed: SeedOption = 0,
    normals: Annotated[str, typer.Option("--normals", help=f"--plot: normal sets, {Names}.")] = "playground",
    error: Annotated[str, typer.Option("--error", help="--plot: psnr, mean or max, the largest angle.")] = "psnr",
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
    from .cost_command import CostRequest, cost_command

    request = CostRequest(
        *(encoding, isa, time, jax, family, stage, operation, storage, size, repeats, count, seed, normals, error),
    )
    cost_command(request, seeds, disassembly, plot, format, output)


@app.command()
def run(
    tables: Annotated[
        str, typer.Option("--tables", help="quality, render, lights, depth, passes; comma-separated, or all.")
    ] = "all",
    count: CountOption = DEFAULT_COUNT,
    seed: SeedOption = 0,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="Results folder, new or of a run that was stopped. Default: results/<time>."
        ),
    ] = None,
) -> None:
    """The default suite into a results folder with tables and pictures: normals, images, light, depth, pass times.

    A run that was stopped goes on when the same command is run again.
    """
    from .run_command import run_command
    from .suite import SuiteRequest

    run_command(SuiteRequest(tables, count, seed), output)


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
    from .check_command import check_command

    return check_command(gates, run, format, output)


@app.command()
def compare(
    before: Annotated[Path, typer.Argument(help="A results folder.")],
    after: Annotated[Path, typer.Argument(help="Another one.")],
    format: FormatOption = Format.table,
    output: OutputOption = None,
) -> None:
    """What changed between two runs: figures exactly, times only where the difference is more than chance."""
    from .compare_command import compare_command

    compare_command(before, after, format, output)


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
