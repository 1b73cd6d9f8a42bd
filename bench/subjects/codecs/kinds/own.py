"""A user's own encoding of a kind: how it is read and tested, and how it becomes an encoding like the catalogue's.

Each kind has a module next to this one and a line in `table.py`; `languages/shapes.py` defines the inputs and outputs
of its functions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .....encodings.codecs.files import called
from .....encodings.kinds import AnyEncoding, Kind
from .....gbuffer.codecs.own.own_passes import RESULTS, Tried, tried
from .....gbuffer.gl.device import Device
from ....ground.output.errors import NO_TWIN
from ....ground.user_files import UserFile
from ....shaders.code.twin import lacking_twin
from ....shaders.languages.shapes import SHAPES, Shape
from ....shaders.languages.translated import Translated

# How many values of a kind are tried, and with which seed.
COUNT, SEED = 4096, 0
# How far a number may lead beyond what a storage holds.
ROUNDED = 2e-5


@dataclass(frozen=True)
class Own:
    """A user's own encoding, as read from its file.

    Attributes:
        file: the file, with the names of its functions if they are needed.
        made: the translation of the file.
        found: the findings of the first look (see `look.py`).
    """

    file: UserFile
    made: Translated
    found: Mapping[str, Any]

    @property
    def shape(self) -> Shape:
        """The inputs and outputs of the encoding's functions."""
        return next(
            shape for shapes in SHAPES.values() for shape in shapes if shape.template == self.made.shaped["template"]
        )

    @property
    def settings(self) -> Sequence[str]:
        """The names of the other inputs of the encoding's functions."""
        return self.made.shaped["settings"]

    @property
    def is_unit(self) -> bool:
        """Whether codes are in [0, 1], where the catalogue's codes are in [-1, 1]."""
        return self.found.get("is_unit", False)

    def size(self, part: str) -> tuple[int, int]:
        """Return the number of components of a part that the encoder takes and the decoder returns; 0 for none."""
        encoded, decoded = self.made.shaped["parts"].get(part, (0, 0))
        return encoded, decoded

    def tried(self, gl: Device, given: np.ndarray, more: np.ndarray, codes: np.ndarray | None = None) -> Tried:
        """Encode and decode values with the functions, or only decode `codes` (see `own_passes.tried`)."""
        results = min(len(self.shape.results), len(RESULTS))
        return tried(gl, self.made.glsl(False), self.made.prefix, results, given, more, codes)

    def described(self) -> dict[str, Any]:
        """Return the arguments that all encodings share, by name; `encode` and `decode` raise NoTwinError."""
        lacking = lacking_twin(f"{self.made.name} {NO_TWIN}")
        return {
            "name": self.made.name,
            "title": called(str(self.file)),
            "citation": called(str(self.file)),
            "encode": lacking,
            "decode": lacking,
            "glsl": self.made.glsl(self.is_unit),
            "functions": self.made.prefix,
            "ulps": (0, 0),
            "ulps_reason": "a user's own",
        }


@dataclass(frozen=True)
class Values:
    """Inputs to test functions with: an adapter reads all of `given` and three components of `more`; float32 of shape
    (count, 4)."""

    given: np.ndarray
    more: np.ndarray


@dataclass(frozen=True)
class OwnKind:
    """A kind of users' own encodings: how they are tested, and how they become encodings like the catalogue's.

    Attributes:
        kind: the kind in the catalogue.
        values: a function that returns the values to test an encoding with.
        errors: a function from values and the results of the adapters to errors, float64 of shape (count,).
        unit: the unit of the errors.
        nearly: the largest error of an encoding that round-trips, before any storage.
        exactly: a function that returns, by name, values that should round-trip exactly.
        encoding: a function that returns the user's functions as an encoding like the catalogue's.
        facts: a function that returns other findings of the first look; `wrong` and `notes` are lines, `is_open`
            means that codes are unbounded.
        said: a function that returns a value as text.
        rounded: how far a component may exceed the range of storages.
    """

    kind: Kind
    values: Callable[[Own], Values]
    errors: Callable[[Values, Tried], np.ndarray]
    unit: str
    nearly: float
    exactly: Callable[[Own], Mapping[str, Values]]
    encoding: Callable[[Own], AnyEncoding]
    facts: Callable[[Own, Device], dict[str, Any]]
    said: Callable[[np.ndarray, np.ndarray], str]
    rounded: float = ROUNDED


def rows(*columns: np.ndarray | float) -> np.ndarray:
    """Return up to four columns as float32 of shape (count, 4), with zeros in the remaining columns."""
    wide = np.broadcast_arrays(*columns, *[0.0] * (4 - len(columns)))
    return np.stack(wide, axis=-1).astype(np.float32)


def of_range(count: int) -> np.ndarray:
    """Return the setting for functions that take a range: 1, as rows of shape (count, 4)."""
    return rows(np.ones(count))


def numbers(given: np.ndarray, _: np.ndarray) -> str:
    """Return the components of a value as text, with four significant digits, such as (0.1, 0.25)."""
    return f"({', '.join(f'{value:.4g}' for value in given)})"


def number(given: np.ndarray, _: np.ndarray) -> str:
    """Return the first component of a value as text, with four significant digits."""
    return f"{given[0]:.4g}"


def one_number_errors(values: Values, trial: Tried) -> np.ndarray:
    """Return the absolute error of the first component of each value."""
    return np.abs(trial.back[0][:, 0].astype(np.float64) - values.given[:, 0])


def longest(ascending: np.ndarray, is_in: np.ndarray) -> tuple[float, float] | None:
    """Return the first and last values of the longest run in which `is_in` is true; None if it is never true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], is_in, [False]]).astype(int)))
    runs = edges.reshape(-1, 2)
    if not len(runs):
        return None
    first, last = max(runs, key=lambda run: run[1] - run[0])
    return float(ascending[first]), float(ascending[last - 1])
