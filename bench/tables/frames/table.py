"""The frames table: the errors of encoded tangent frames."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ...ground.options.option import NAMED, Backends, Option, RoundingsAndDithered, Seed
from ...ground.options.source_options import SourceOptions
from ...ground.options.words import Names
from .. import shared_columns as shared
from ..table import Column, Role, Section, Table

KEY, HOW = Role.KEY, Role.HOW


@dataclass(frozen=True, kw_only=True)
class FramesOptions(SourceOptions):
    """Options for what `frames` measures. Names are comma-separated; by default each encoding is measured in its
    usual storage."""

    encoding: Annotated[
        Names, Option("--encoding", f"Tangent frame encodings or your own files, {NAMED}.", files=True)
    ] = ("all",)
    storage: Annotated[
        Names | None, Option("--storage", f"Tangent frame storages, {NAMED}. Default: each encoding's usual storage.")
    ] = None
    rounding: RoundingsAndDithered = ("nearest",)
    frames: Annotated[
        Names, Option("--frames", f"Tangent frame sets, or mesh files for their vertices, {NAMED}.", files=True)
    ] = ("rotations",)
    backend: Backends = ("jax", "glsl")
    count: Annotated[int, Option("--count", "Number of tangent frames in a uniform set.")] = 2**16
    seed: Seed = 0
    worst_case: Annotated[
        bool,
        Option(
            "--worst-case",
            "Find the true largest rotation, by float64 search; takes seconds per encoding.",
            in_run=True,
        ),
    ] = False


def _angle_columns(what: str, says: str, *drops: int) -> tuple[Column, ...]:
    figures = zip(("mean", "rms", "max"), ("Mean", "Root mean square", "Largest"), drops, strict=True)
    return tuple(
        Column(f"{what}_{name}_deg", f"{title} {says}", unit="degrees", better="less", drops=drop)
        for name, title, drop in figures
    )


COLUMNS = (
    Column("encoding", "How a tangent frame is turned into numbers.", KEY),
    shared.STORAGE,
    shared.ROUNDING_NOW_SAID,
    Column("frame_set", "The set of tangent frames that was measured.", KEY),
    shared.BACKEND,
    shared.BITS,
    Column("count", "How many tangent frames were measured.", HOW, drops=13),
    Column("invalid", "Decodes that were NaN or infinite; each counts as 180 degrees.", better="less", drops=17),
    Column(
        "hands_lost",
        "Tangent frames decoded with the wrong handedness. Empty for encodings of rotations, which store none.",
        better="less",
    ),
    *_angle_columns("normal", "angle between a tangent frame's normal and its decode.", 11, 9, 16),
    *_angle_columns("tangent", "angle between a tangent and its decode.", 10, 8, 15),
    *_angle_columns("rotation", "angle of the rotation from the true tangent frame to the decoded one.", 12, 0, 0),
    Column(
        "rotation_sup_deg",
        "The largest rotation over all tangent frames in exact arithmetic, by search; no sample can exceed it.",
        unit="degrees",
        better="less",
        drops=18,
        option="worst_case",
    ),
    Column(
        "sup_moved_deg",
        "How much the last round of the search still raised rotation_sup_deg.",
        HOW,
        "degrees",
        drops=2,
        option="worst_case",
    ),
    Column(
        "effective_bits",
        "log2 of the number of ideally placed codes that have this RMS rotation; uniform sets only.",
        unit="bits",
        better="more",
    ),
    shared.CODES,
    Column(
        "limit_mean_deg",
        "Bound on the mean rotation for this number of codes.",
        HOW,
        "degrees",
        drops=7,
    ),
    Column("limit_rms_deg", "Bound on the RMS rotation for this number of codes.", HOW, "degrees", drops=14),
    Column("limit_max_deg", "Bound on the largest rotation for this number of codes.", HOW, "degrees", drops=7),
    *shared.REACHED,
    shared.BELOW_LIMIT,
    shared.DEVICE,
    shared.ROUNDED_BY,
    shared.SEED,
    shared.SKIPPED,
)

TABLE = Table(
    package=__package__ or "",
    help="Measure encodings of tangent frames.\n\nA set may be a mesh (glTF, GLB, OBJ, PLY): the tangent frames of "
    "its vertices, authored or along its uv.",
    example="normalbench frames --encoding smallest_three --backend jax",
    step_s=0.05,
    options=FramesOptions,
    columns=COLUMNS,
    single={"encoding": "smallest_three", "backend": "jax"},
    section=Section(
        title="Tangent frame accuracy",
        short="Frames",
        intro="A normal, a tangent and the handedness of the bitangent in one texel: how far is the decoded tangent "
        "frame rotated?",
        method="Rotations spread evenly by Haar's measure, half of them mirrored, are encoded, stored and decoded as "
        "normals are. The angle is the rotation from the true tangent frame to the decoded one; lost "
        "handedness is counted. The bound assumes that each code covers a ball of rotations.",
    ),
)
