"""Options as typed fields, each with its flag, kind, default and help in one place.

The command line, the pytest plugin, gates and Python all read these fields. Imports nothing heavy: every pytest run
imports this module.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from types import MappingProxyType, NoneType
from typing import Annotated, Any, get_args, get_type_hints

from ..output.errors import UsageError
from ..user_files import file_names
from .counts import whole_number
from .words import Names, names, typed


@dataclass(frozen=True)
class Option:
    """The name and the help of an option. The field that has the option also has its type and default.

    Attributes:
        flag: as typed: "--count"; "--unpack/--no-unpack" if it can be negated; without dashes for an argument.
        help: a sentence.
        files: whether the option's words may name files.
        in_run: whether `run` also takes the option, for every table that has an option of this name in `run`.
        letter: a short form, such as "-D".
        repeats: whether a name that is given twice counts twice.
    """

    flag: str
    help: str
    files: bool = False
    in_run: bool = False
    letter: str = ""
    repeats: bool = False


NAMED = "comma-separated, or all; `normalbench list` shows them"
Encodings = Annotated[
    Names, Option("--encoding", f"Encodings or files of GLSL, HLSL, Slang or WGSL, {NAMED}.", files=True, in_run=True)
]
StorageNames = Annotated[
    Names,
    Option(
        "--storage", f"Storages, {NAMED}. Bit counts also work: unorm:9:7, snorm:12:12, unorm:4:4..16:16.", in_run=True
    ),
]
Roundings = Annotated[
    Names, Option("--rounding", "nearest, truncate, truncate_half; comma-separated, or all.", in_run=True)
]
# Of tables that add noise.
RoundingsAndDithered = Annotated[
    Names, Option("--rounding", "nearest, truncate, truncate_half, dithered; comma-separated, or all.", in_run=True)
]
Normals = Annotated[Names, Option("--normals", f"Normal sets or files, {NAMED}.", files=True, in_run=True)]
Backends = Annotated[Names, Option("--backend", "jax, glsl; comma-separated, or all.", in_run=True)]
# Of a table that measures by WGSL on Vulkan as well.
BackendsAndWgsl = Annotated[Names, Option("--backend", "jax, glsl, wgsl; comma-separated, or all.", in_run=True)]
Count = Annotated[int, Option("--count", "Number of normals in a uniform set.", in_run=True)]
Seed = Annotated[int, Option("--seed", "Random seed of uniform sets, points and scenes.", in_run=True)]
Pipelines = Annotated[Names, Option("--pipeline", f"Pipelines, {NAMED}.", in_run=True)]
Layouts = Annotated[Names | None, Option("--layout", "Layouts: names or TOML files.", files=True, in_run=True)]
Scenes = Annotated[
    Names, Option("--scene", f"Scenes, mesh files or captured frames (gbuffer.json), {NAMED}.", files=True, in_run=True)
]
Powers = Annotated[
    Names | None,
    Option("--power", "Specular powers of all materials, comma-separated. Default: each material's own.", in_run=True),
]
LightBuffers = Annotated[
    Names,
    Option(
        "--light-buffer",
        f"Light buffers or your own files, {NAMED}. Bit counts also work: ufloat:6:9, linear/unorm:10:10:10.",
        files=True,
        in_run=True,
    ),
]
Effects = Annotated[
    Names | None, Option("--effects", "Effects in the image, applied together, with settings: gtao:size=half,lpv.")
]
LightTargets = Annotated[Names, Option("--light-targets", "1, 2; comma-separated, or all.")]
Shadow = Annotated[Names, Option("--shadow", "on, off; comma-separated, or all.")]
Size = Annotated[str, Option("--size", "WIDTHxHEIGHT of the image.")]
Samples = Annotated[int, Option("--samples", "Samples per pixel; the device may give more.")]
Scale = Annotated[float, Option("--scale", "Size of the inferred pipeline's buffers relative to the image, at most 1.")]
Objects = Annotated[int, Option("--objects", "Number of objects in the scene `objects`.")]
Lights = Annotated[int, Option("--lights", "Number of point lights.")]
Families = Annotated[
    Names, Option("--family", "GPU families to count issue slots on, comma-separated; the highest count is used.")
]
Arithmetics = Annotated[
    Names,
    Option(
        "--arithmetic",
        "Arithmetic of the encodings: float (32 bits), half (every step rounded to 16 bits), or declared: float, and "
        "also half for a file that declares half, min16float, float16_t or mediump; comma-separated, or all.",
        in_run=True,
    ),
]
Repeats = Annotated[int, Option("--repeats", "Number of frames to time; 0 in render for no timing.")]
Images = Annotated[Path | None, Option("--images", "Write pictures to this folder.")]
Live = Annotated[
    Path | None,
    Option("--live", "Write the GLSL ES of each codec, which a page runs in the browser, to this folder."),
]
Plot = Annotated[Path | None, Option("--plot", "Plot the table to this PNG, SVG or PDF file.")]
Verbose = Annotated[
    bool, Option("--verbose", "Print every sentence of the answer, and every column that fits.", letter="-v")
]


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options that split comma-separated text into names when they are constructed, and nowhere else."""

    def __post_init__(self) -> None:
        for name, field in fields_of(type(self)).items():
            object.__setattr__(self, name, field.read(getattr(self, name)))


@dataclass(frozen=True, kw_only=True)
class Sources(Options):
    """Options for reading users' encoding files. The values are comma-separated.

    Attributes:
        define: macros.
        prelude: files to insert before the shader file.
        include: folders to search for includes.
        language: the language of the files, regardless of their extensions.
    """

    define: Annotated[
        Names | None, Option("--define", "Shader files: macros, NAME or NAME=VALUE.", in_run=True, letter="-D")
    ] = None
    prelude: Annotated[
        Names | None, Option("--prelude", "Shader files: files to read before them.", files=True, in_run=True)
    ] = None
    include: Annotated[
        Names | None,
        Option("--include", "Shader files: folders of #includes, FOLDER or NAME=FOLDER for NAME/file.", True, True),
    ] = None
    language: Annotated[
        str | None,
        Option("--language", "Shader files: hlsl, slang, glsl or wgsl. Default: by the extension.", in_run=True),
    ] = None


@dataclass(frozen=True, kw_only=True)
class Reading(Options):
    """Options for reading files of normals.

    Attributes:
        channels: a layer, or three channels by name; None for the channels that look like normals.
        unpack: whether [0, 1] represents [-1, 1]; None: only in integer files, which have no negative numbers.
        curve: the curve that was applied to the components before they were stored, one of captures.CURVES.
        normalise: whether any length is accepted.
        space: the space of the frame, one of captures.SPACES.
        code_space: the space to encode the frame's normals in, one of captures.CODE_SPACES.
        view_matrix: world to view space, 9 or 16 numbers row by row or a text file with them; for world space.
        mask: a file or a channel that is 0 on the background; None if normals of length 0 mark the background.
        nan_share: the largest share of normals that may be NaN or infinite; such normals are masked and counted.
        fov: the camera's vertical field of view in degrees; None for parallel rays.
        size: the size of a mesh's image, WxH.
    """

    channels: Annotated[
        str | None, Option("--channels", "Captures: a layer, or the channels of x,y,z by name.", in_run=True)
    ] = None
    unpack: Annotated[
        bool | None,
        Option("--unpack/--no-unpack", "Captures: map [0,1] to [-1,1]. Default: only for integers.", in_run=True),
    ] = None
    curve: Annotated[
        str,
        Option(
            "--curve",
            "Captures: transfer curve of the values: linear, srgb (decode), srgb-removed (decoded by mistake; encode "
            "again).",
            in_run=True,
        ),
    ] = "linear"
    normalise: Annotated[bool, Option("--normalise", "Captures: accept normals of any length.", in_run=True)] = False
    space: Annotated[
        str, Option("--space", "Captures: space of the normals: view, view-left-handed, world.", in_run=True)
    ] = "view"
    code_space: Annotated[
        str, Option("--code-space", "Captures: space to encode normals in: view, world.", in_run=True)
    ] = "view"
    view_matrix: Annotated[
        str | None,
        Option("--view-matrix", "World-to-view matrix: 9 or 16 numbers in rows, or a file.", files=True, in_run=True),
    ] = None
    mask: Annotated[
        str | None,
        Option("--mask", "Captures: a file or a channel that is 0 on the background.", files=True, in_run=True),
    ] = None
    nan_share: Annotated[
        float, Option("--nan-share", "Captures: largest share of NaN to mask and count.", in_run=True)
    ] = 0.0
    fov: Annotated[
        float | None,
        Option("--fov", "Captures: vertical field of view in degrees, for per-pixel view space.", in_run=True),
    ] = None
    size: Annotated[str, Option("--size", "WIDTHxHEIGHT of the image of a mesh.")] = "640x480"

    @property
    def reading(self) -> Reading:
        """Only the options of `Reading`, with the values that they have here."""
        return Reading(**{field.name: getattr(self, field.name) for field in fields(Reading)})


@dataclass(frozen=True)
class Field:
    """A use of an option, with its type, such as `str | None`, and its default."""

    name: str
    type: Any
    default: Any
    option: Option

    @property
    def has_names(self) -> bool:
        """Whether the option takes several names, which are typed as one text."""
        return self.type in (Names, Names | None)

    @property
    def kind(self) -> type:
        """The type of the option's value on the command line: str, also for several names, int, float, bool or
        Path."""
        return str if self.has_names else next(k for k in get_args(self.type) or (self.type,) if k is not NoneType)

    @property
    def typed(self) -> Any:
        """The default as the user types it: several names are one comma-separated text."""
        return typed(self.default)

    def read(self, value: Any, folder: Path = Path()) -> Any:
        """Return the option's value for a given value: text with several names is split into a tuple of names, and
        any other value is unchanged.

        Args:
            folder: the folder to look for files in.
        """
        if not self.has_names or not isinstance(value, str):
            return value
        return file_names(value, folder) if self.option.files else names(value, repeats=self.option.repeats)

    def checked(self, value: Any) -> Any:
        """Return a value from a file or a test, converted to the option's type. A text option also takes numbers and
        paths, and a float option whole numbers. Raises UsageError for any other type."""
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if self.kind is str and (number or hasattr(value, "__fspath__")):
            value = str(value)
        if self.has_names and isinstance(value, str | tuple):
            return self.read(value)
        if isinstance(value, self.kind) and (self.kind is bool or not isinstance(value, bool)):
            return value
        if self.kind is float and number:
            return float(value)
        raise UsageError(f"{self.name} is {value!r}; it must be {KINDS[self.kind]}")

    def parsed(self, value: Any) -> Any:
        """Return typed text as a number for an option of type int or float; other values are unchanged. Raises
        UsageError for text that is not such a number."""
        if isinstance(value, str) and self.kind in (int, float):
            try:
                return whole_number(value) if self.kind is int else float(value)
            except ValueError as error:
                raise UsageError(f"{self.name} is {value!r}; it must be {KINDS[self.kind]}") from error
        return value


KINDS = {str: "text", int: "a whole number", float: "a number", bool: "true or false", Path: "a path"}


@cache
def fields_of(group: type) -> Mapping[str, Field]:
    """Return the options of a dataclass by their Python names: first its own options, then inherited options."""
    hints, options = get_type_hints(group, include_extras=True), {}
    for field in fields(group):
        kind, option = get_args(hints[field.name])
        options[field.name] = Field(field.name, kind, field.default, option)
    own = inspect.get_annotations(group)
    return MappingProxyType(dict(sorted(options.items(), key=lambda item: item[0] not in own)))


def checked_options(group: type, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return option values by name, each in its option's type. Raises UsageError for unknown names and wrong
    types."""
    known = fields_of(group)
    unknown = next((name for name in values if name not in known), None)
    if unknown is not None:
        raise UsageError(f"unknown option {unknown!r}; known: {', '.join(known)}")
    return {name: known[name].checked(value) for name, value in values.items()}
