"""The options of `quality` and `render`, each once: its flag, kind, default and help.

The command line, the options of the pytest plugin, and what a gate or a test may name all come from here; those of the
other commands stand in command_options.py. Imports nothing heavy: every run of pytest does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from types import MappingProxyType, NoneType
from typing import Annotated, Any, get_args, get_type_hints

from ..output.errors import UsageError
from .counts import DEFAULT_COUNT


@dataclass(frozen=True)
class Option:
    """What an option is called and what is said of it; its kind and default stand at the field that has it.

    Attributes:
        flag: as typed; "--unpack/--no-unpack" for one that may be denied.
        help: a sentence.
        files: whether its words may be files.
        columns: the columns that are not measured without it, besides one of its own name.
    """

    flag: str
    help: str
    files: bool = False
    columns: tuple[str, ...] = ()


SUPREMUM = ("angle_sup_deg", "sup_x", "sup_y", "sup_z", "sup_found_by", "sup_moved_deg")
ODD_CODES = ("codes_unused", "codes_duplicate", "codes_unstable")

Names = "comma-separated, or all; `normalbench list` shows them"
Encodings = Annotated[str, Option("--encoding", f"Encodings, {Names}.", files=True)]
Backends = Annotated[str, Option("--backend", "jax, glsl; comma-separated, or all.")]
Count = Annotated[int, Option("--count", "Normals in a uniform set.")]
SetSeed = Annotated[int, Option("--seed", "What uniform sets are made with.")]
Pipelines = Annotated[str, Option("--pipeline", f"Pipelines, {Names}.")]
LightBuffers = Annotated[str, Option("--light-buffer", f"Light buffers, {Names}.")]
LightTargets = Annotated[str, Option("--light-targets", "1, 2; comma-separated, or all.")]
Shadow = Annotated[str, Option("--shadow", "on, off; comma-separated, or all.")]
Size = Annotated[str, Option("--size", "WIDTHxHEIGHT of the image.")]
Samples = Annotated[int, Option("--samples", "Samples a pixel; as many as the device has.")]
Scale = Annotated[float, Option("--scale", "Size of inferred's buffers to the image's, up to 1.")]
Objects = Annotated[int, Option("--objects", "Objects in the scene `objects`.")]
Lights = Annotated[int, Option("--lights", "Point lights.")]
Repeats = Annotated[int, Option("--repeats", "Frames that times are taken over.")]


@dataclass(frozen=True, kw_only=True)
class QualityOptions:
    """What `quality` measures: names are comma-separated."""

    encoding: Encodings = "all"
    storage: Annotated[str, Option("--storage", f"Storages, {Names}.")] = "rgba8"
    rounding: Annotated[str, Option("--rounding", "nearest, truncate, truncate_half; comma-separated, or all.")] = (
        "nearest"
    )
    normals: Annotated[str, Option("--normals", f"Normal sets or files, {Names}.", files=True)] = "playground"
    backend: Backends = "jax,glsl"
    count: Count = DEFAULT_COUNT
    seed: SetSeed = 0
    worst_case: Annotated[
        bool,
        Option("--worst-case", "The true supremum and where it is, in float64; seconds a codec.", columns=SUPREMUM),
    ] = False
    codes: Annotated[
        bool,
        Option("--codes", "Codes unused, duplicate, unstable, of up to 2^24; seconds a codec.", columns=ODD_CODES),
    ] = False


@dataclass(frozen=True, kw_only=True)
class Reading:
    """How files of normals are read.

    Attributes:
        channels: a layer, or three channels by name; None for what looks like normals.
        unpack: whether [0, 1] stands for [-1, 1]; None: in files of whole numbers, which have nothing else.
        normalise: whether any length will do.
        space: one of captures.SPACES.
        view_matrix: world to view space, 9 or 16 numbers row by row or a text file of them; for world space.
        mask: a file or a channel, 0 where there is background; None for normals of no length.
        nan_share: of the normals, how many may be NaN or infinite; these are masked and counted.
        fov: vertical, in degrees, of the camera; None for parallel rays.
        size: of the picture of a mesh, WxH.
    """

    channels: Annotated[
        str | None, Option("--channels", "Of a capture: a layer, or the channels of x,y,z by name.")
    ] = None
    unpack: Annotated[
        bool | None, Option("--unpack/--no-unpack", "Of a capture: [0,1] stands for [-1,1]. PNG: always.")
    ] = None
    normalise: Annotated[bool, Option("--normalise", "Of a capture: take normals of any length.")] = False
    space: Annotated[str, Option("--space", "Of a capture: view, view-left-handed, world.")] = "view"
    view_matrix: Annotated[
        str | None, Option("--view-matrix", "World to view space: 9 or 16 numbers by rows, or a file.", files=True)
    ] = None
    mask: Annotated[
        str | None, Option("--mask", "Of a capture: a file or a channel that is 0 on the background.", files=True)
    ] = None
    nan_share: Annotated[float, Option("--nan-share", "Of a capture: the share of NaN that is masked and counted.")] = (
        0.0
    )
    fov: Annotated[float | None, Option("--fov", "Of a capture: vertical degrees, for per-pixel view space.")] = None
    size: Annotated[str, Option("--size", "WIDTHxHEIGHT of the picture of a mesh.")] = "640x480"


AS_USUAL = Reading()


@dataclass(frozen=True, kw_only=True)
class RenderOptions:
    """What `render` measures: names are comma-separated."""

    pipeline: Pipelines = "hybrid"
    layout: Annotated[
        str | None, Option("--layout", "Layouts, names or TOML files, comma-separated. Default: fp32.", files=True)
    ] = None
    encoding: Annotated[
        str | None,
        Option("--encoding", "Encodings to put into each layout, comma-separated, or all.", files=True),
    ] = None
    storage: Annotated[str | None, Option("--storage", "And their storages. Default: rgba8.")] = None
    rounding: Annotated[str | None, Option("--rounding", "And how those round. Default: nearest.")] = None
    light_buffer: LightBuffers = "rgba32f"
    light_targets: LightTargets = "2"
    scene: Annotated[str, Option("--scene", f"Scenes or mesh files, {Names}.", files=True)] = "gloss"
    shadow: Shadow = "on"
    size: Size = "640x480"
    samples: Samples = 1
    scale: Scale = 1.0
    objects: Objects = 200
    lights: Lights = 64
    frames: Annotated[int, Option("--frames", "Moments to average over. 0: as the scene has it.")] = 0
    repeats: Repeats = 3
    seed: Annotated[int, Option("--seed", "What scenes are made with.")] = 0
    flip: Annotated[bool, Option("--flip", "FLIP as well, a perceptual difference; a second a row.")] = False


# The tables that a gate or a test may have measured, and what each may be asked.
MEASURED: Mapping[str, tuple[type, ...]] = MappingProxyType(
    {"quality": (QualityOptions, Reading), "render": (RenderOptions,)}
)


@dataclass(frozen=True)
class Field:
    """An option where it is used: of which type, `str | None` say, and its default."""

    name: str
    type: Any
    default: Any
    option: Option

    @property
    def kind(self) -> type:
        """str, int, float or bool."""
        return next(kind for kind in get_args(self.type) or (self.type,) if kind is not NoneType)

    def checked(self, value: Any) -> Any:
        """A value that came from a file or a test; a text option takes numbers as well. Raises UsageError."""
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if self.kind is str and (number or hasattr(value, "__fspath__")):
            return str(value)
        if isinstance(value, self.kind) and (self.kind is bool or not isinstance(value, bool)):
            return value
        if self.kind is float and number:
            return float(value)
        raise UsageError(f"{self.name} is {value!r}; {KINDS[self.kind]} would do")


def checked_options(table: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """Options of a measured table by name, as a gate or a test says them. Raises UsageError for others."""
    known = fields_of(*MEASURED[table])
    unknown = next((name for name in values if name not in known), None)
    if unknown is not None:
        raise UsageError(f"unknown option {unknown!r}; known: {', '.join(known)}")
    return {name: known[name].checked(value) for name, value in values.items()}


KINDS = {str: "a text", int: "a whole number", float: "a number", bool: "true or false"}


@cache
def fields_of(*groups: type) -> Mapping[str, Field]:
    """The options of classes of them, by the names they have in Python."""
    found: dict[str, Field] = {}
    for group in groups:
        hints = get_type_hints(group, include_extras=True)
        for field in fields(group):
            kind, option = get_args(hints[field.name])
            found.setdefault(field.name, Field(field.name, kind, field.default, option))
    return MappingProxyType(found)
