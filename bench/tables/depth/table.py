"""The depth table: the error of positions rebuilt from stored depth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import NAMED, Backends, Images, Option, Plot, RoundingsAndDithered, Seed
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class DepthOptions(SourceOptions):
    """Options for what `depth` measures. Names and numbers are comma-separated; None stands for the usual value."""

    depth: Annotated[Names, Option("--depth", f"Depth encodings or your own files, {NAMED}.", files=True)] = ("all",)
    storage: Annotated[
        Names | None, Option("--storage", f"Depth storages, {NAMED}. Default: each encoding's usual storage.")
    ] = None
    rounding: RoundingsAndDithered = ("nearest",)
    rebuild: Annotated[
        Names | None,
        Option(
            "--rebuild",
            "inverse_projection, projection_terms, eye_ray; comma-separated, or all. Default: each encoding's usual "
            "method.",
        ),
    ] = None
    near: Annotated[Names, Option("--near", "Near planes, comma-separated.")] = ("0.1", "1")
    far: Annotated[Names, Option("--far", "Far planes, comma-separated.")] = ("1000",)
    distance: Annotated[
        Names | None, Option("--distance", "Distances, comma-separated. Default: every power of ten.")
    ] = None
    fov: Annotated[
        float | None,
        Option(
            "--fov",
            "Vertical field of view in degrees. Default: 60 (16:9 image); with --depths, points are on the view axis.",
        ),
    ] = None
    depths: Annotated[
        Names | None,
        Option("--depths", "Depth images to measure instead of generated points: EXR, TIFF, PNG, NPY.", files=True),
    ] = None
    channel: Annotated[
        str | None,
        Option("--channel", "Depth images: the channel. Default: the channel named for depth, or the only one."),
    ] = None
    depths_are: Annotated[
        str,
        Option(
            "--depths-are",
            "Depth images: view (along the view axis), or their depth encoding: window, reversed_window, linear.",
        ),
    ] = "view"
    depth_unit: Annotated[
        float, Option("--depth-unit", "Depth images: their unit in units of --near, such as 0.001 for millimetres.")
    ] = 1.0
    backend: Backends = ("jax", "glsl")
    count: Annotated[int, Option("--count", "Number of points at each distance.")] = 2**14
    seed: Seed = 0


@dataclass(frozen=True, kw_only=True)
class DepthOutputs:
    """Files that `depth` writes besides its rows."""

    images: Images = None
    plot: Plot = None


COLUMNS = (
    Column("depth", "How a distance is turned into a number.", KEY),
    Column("storage", "The format that the number is stored in.", KEY),
    shared.ROUNDING_NOW_SAID,
    Column("bits", "Bits of the stored depth.", drops=4),
    Column(
        "rebuilt",
        "How the position is rebuilt. inverse_projection: with the inverse matrix in float32; projection_terms: with "
        "the projection's two terms, z = B / (ndc + A), and the eye ray; eye_ray: with the encoding's decoder and "
        "the eye ray.",
        KEY,
        drops=6,
    ),
    Column("backend", "jax emulates the storage; glsl goes through the real target or depth buffer.", KEY),
    Column("near", "The near plane.", KEY),
    Column("far", "The far plane.", KEY, drops=7),
    Column("ratio", "Far over near.", HOW),
    Column("fov", "Vertical field of view; empty if points are on the view axis.", HOW, "degrees"),
    Column("depths", "The image whose depths were measured; empty for generated points.", KEY),
    Column(
        "distance",
        "Depths within a sixteenth of this distance; empty: depths spread evenly over the range, or the depths of an "
        "image.",
        KEY,
    ),
    Column("count", "How many points were measured.", HOW),
    Column("background", "Pixels of the image nearer than near or beyond far; excluded from the errors.", HOW, drops=8),
    Column("not_finite", "Pixels of the image that are NaN; excluded from the errors.", HOW, drops=8),
    Column(
        "relative_mean",
        "Mean error of the depth along the view axis, as a fraction of the depth.",
        better="less",
    ),
    Column(
        "relative_max",
        "Largest error of the depth along the view axis, as a fraction of the depth.",
        better="less",
    ),
    Column(
        "error_mean", "Mean distance between true and rebuilt position, in the unit of near and far.", better="less"
    ),
    Column("error_max", "The largest distance between true and rebuilt position.", better="less"),
    Column(
        "half_step",
        "How far rounding can move the position: half a step of the storage with rounding to nearest, otherwise one "
        "step.",
        HOW,
    ),
    Column("bound", "How far rounding and float32 arithmetic together can move the position.", HOW),
    Column("signs_lost", "Signs stored with the depth that decoded wrongly.", better="less", drops=3),
    shared.DEVICE,
    shared.ROUNDED_BY,
    shared.SEED,
    shared.SKIPPED,
)
ALSO = (
    Column("at_*", "The largest position error at that distance.", better="less"),
    Column("max_even", "The largest position error over points spread evenly over the range.", better="less"),
    Column("mean_even", "The mean position error over the same points.", better="less", drops=5),
    Column("max_*", "The largest position error at that distance.", better="less"),
)

TABLE = Table(
    package=__package__ or "",
    help="Measure positions rebuilt from stored depth.\n\nErrors are distances in the unit of --near and --far, for "
    "points anywhere on the screen. A distance stands for depths up to a sixteenth of it nearer or farther. "
    "--depths measures your own depth image.",
    example="normalbench depth --depth reversed_window,logarithmic --near 0.1 --far 1000",
    step_s=0.04,
    options=DepthOptions,
    outputs=DepthOutputs,
    columns=COLUMNS,
    also=ALSO,
    usual=({"near": "0.1"},),
    single={"depth": "linear", "backend": "jax", "near": "0.1"},
    section=Section(
        title="Depth accuracy",
        short="Depth",
        intro="A view-space position is rebuilt from the stored depth: how large is its error at each distance?",
        method="Points are anywhere on the screen: at each distance, within a sixteenth of it, and spread evenly "
        "over the range. Errors are distances in the unit of the near and far planes. z/w and reversed z/w go "
        "through real depth buffers.",
    ),
)
