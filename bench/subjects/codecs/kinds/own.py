"""A user's own encoding of a kind: how it is read, how its kind tries it, and how it becomes an encoding.

A kind is a module next to this one, and a line of `table.py`; `languages/shapes.py` defines the inputs and outputs of
its functions.
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
    """A user's own encoding, as it is read.

    Attributes:
        file: the file, with the names of its functions if they are needed.
        made: its translation.
        found: the findings of the first look: see `look.py`.
    """

    file: UserFile
    made: Translated
    found: Mapping[str, Any]

    @property
    def shape(self) -> Shape:
        """The inputs and outputs of its functions."""
        return next(
            shape for shapes in SHAPES.values() for shape in shapes if shape.template == self.made.shaped["template"]
        )

    @property
    def settings(self) -> Sequence[str]:
        """The names of the other inputs of its functions."""
        return self.made.shaped["settings"]

    @property
    def is_unit(self) -> bool:
        """Whether its numbers are in [0, 1] where the catalogue's are in [-1, 1]."""
        return self.found.get("is_unit", False)

    def size(self, part: str) -> tuple[int, int]:
        """Return how many numbers of a part the encoder takes and the decoder returns; 0 for none."""
        encoded, decoded = self.made.shaped["parts"].get(part, (0, 0))
        return encoded, decoded

    def tried(self, gl: Device, given: np.ndarray, more: np.ndarray, codes: np.ndarray | None = None) -> Tried:
        """Encode and decode values with the functions, or only decode `codes`: see `own_passes.tried`."""
        results = min(len(self.shape.results), len(RESULTS))
        return tried(gl, self.made.glsl(False), self.made.prefix, results, given, more, codes)

    def described(self) -> dict[str, Any]:
        """Return by name the arguments that encodings of every kind have; `encode` and `decode` raise NoTwinError."""
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
    """Inputs to try functions with: `given` for an adapter, and `more`, of which it takes three numbers; float32 of
    shape (count, 4)."""

    given: np.ndarray
    more: np.ndarray


@dataclass(frozen=True)
class OwnKind:
    """A kind of users' own encodings: how they are tried, and how they become encodings like the catalogue's.

    Attributes:
        kind: the kind in the catalogue.
        values: the values that an encoding is tried with.
        errors: (values, results of the adapters) -> the errors; float64 of shape (count,).
        unit: the unit of the errors.
        nearly: the largest error of an encoding that round-trips, before any storage.
        exactly: by name, a value that should round-trip exactly.
        encoding: the user's functions as an encoding like those of the catalogue.
        facts: other findings of the first look; `wrong` and `notes` are lines, `is_open` means that codes are
            unbounded.
        said: a value in words.
        rounded: how far a number may exceed the range of storages.
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
    """Return at most four columns as float32 of shape (count, 4), with zeros in the remaining columns."""
    wide = np.broadcast_arrays(*columns, *[0.0] * (4 - len(columns)))
    return np.stack(wide, axis=-1).astype(np.float32)


def of_range(count: int) -> np.ndarray:
    """Return the setting of functions that take a range: 1, as rows of shape (count, 4)."""
    return rows(np.ones(count))


def numbers(given: np.ndarray, _: np.ndarray) -> str:
    """Return the numbers of a value as text, four digits each: (0.1, 0.25)."""
    return f"({', '.join(f'{value:.4g}' for value in given)})"


def number(given: np.ndarray, _: np.ndarray) -> str:
    """Return the first number of a value as text, four digits."""
    return f"{given[0]:.4g}"


def one_number_errors(values: Values, trial: Tried) -> np.ndarray:
    """Return the absolute error of the first number of each value."""
    return np.abs(trial.back[0][:, 0].astype(np.float64) - values.given[:, 0])


def longest(ascending: np.ndarray, is_in: np.ndarray) -> tuple[float, float] | None:
    """Return the first and the last value of the longest run for which `is_in` is true; None if it is never true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], is_in, [False]]).astype(int)))
    runs = edges.reshape(-1, 2)
    if not len(runs):
        return None
    first, last = max(runs, key=lambda run: run[1] - run[0])
    return float(ascending[first]), float(ascending[last - 1])
