"""Measurements of figures as their sources describe them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import jax
import numpy as np

from normalbench.bench.ground.output import cache as kept
from normalbench.bench.ground.output.sources import sources
from normalbench.bench.measures.metrics import published
from normalbench.bench.subjects.codecs.names import codecs_named
from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS, NormalSet, from_arrays
from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec

COUNT = 2**20
# Angles have a standard deviation of about half their mean, and two means of a million are compared: four deviations.
SCATTER_OF_MEANS = 4 * 0.5 * 2**0.5 / COUNT**0.5
FAMILY, STAGE = "polaris10", "fragment"
SUPREMUM = "angle_sup_deg"
# What is taken of a row of the quality table.
FIGURES = ("angle_mean_deg", SUPREMUM, "limit_max_deg", "psnr_article_db")


def codec_of(encoding: str, storage: str, rounding: str = "nearest") -> Codec:
    """Return a codec of the catalogue."""
    (codec,) = codecs_named((encoding,), (storage,), (rounding,))
    return codec


@cache
def _row(codec: Codec, normals: NormalSet, worst_case: bool) -> quality.Row:
    """Return a row of the quality table, which is measured only once."""
    case = quality.QualityCase(codec, normals, "jax", worst_case=worst_case)
    words = (codec.name, codec.rounding, normals.name, str(normals.count), str(worst_case))
    key = kept.key_of("published", sources(), jax.__version__, *words)
    return kept.kept(key, lambda: {name: value for name, value in quality.measure(case).items() if name in FIGURES})


@cache
def _normal_set(name: str) -> NormalSet:
    return NORMAL_SETS[name](COUNT, 0)


class Exact:
    """A measure without samples of its own: another measurement gives the same figure."""

    @property
    def scatter(self) -> float:
        """See figure.Measure."""
        return 0.0


@dataclass(frozen=True)
class Quality:
    """A column of the quality table."""

    encoding: str
    storage: str
    column: str
    normals: str = "sphere"
    rounding: str = "nearest"

    @property
    def command(self) -> str:
        """The command that shows the figure."""
        more = f" --rounding {self.rounding}" if self.rounding != "nearest" else ""
        more += " --worst-case" if self.column == SUPREMUM else ""
        words = f"--encoding {self.encoding} --storage {self.storage} --normals {self.normals}"
        return f"normalbench quality {words} --backend jax{more}"

    @property
    def scatter(self) -> float:
        """The scatter of a mean; suprema and image figures have none."""
        return SCATTER_OF_MEANS if self.column == "angle_mean_deg" else 0.0

    def figure(self) -> float | None:
        """Return the column's value."""
        codec = codec_of(self.encoding, self.storage, self.rounding)
        return _row(codec, _normal_set(self.normals), self.column == SUPREMUM)[self.column]


@dataclass(frozen=True)
class ArticleMse(Exact):
    """The squared error that corresponds to the article's PSNR."""

    encoding: str

    @property
    def command(self) -> str:
        """The command that shows the figure."""
        return f"{Quality(self.encoding, published.STORAGE, '', published.NORMALS).command}; 10^(-psnr_article_db / 10)"

    def figure(self) -> float | None:
        """Return 10^(-PSNR / 10)."""
        decibels = Quality(self.encoding, published.STORAGE, "psnr_article_db", published.NORMALS).figure()
        return None if decibels is None else 10 ** (-decibels / 10)


@cache
def in_a_cube(is_half: bool) -> NormalSet:
    """Return directions of points spread evenly in a cube, denser towards its corners; a hemisphere if `is_half`."""
    points = np.random.default_rng(0).random((COUNT, 3)) * 2 - 1
    n = points / np.linalg.norm(points, axis=1, keepdims=True)
    n[:, 2] = np.abs(n[:, 2]) if is_half else n[:, 2]
    view = np.broadcast_to(np.array([0, 0, -1], np.float32), n.shape)
    return from_arrays("cube.npy", "points of a cube", n.astype(np.float32), view, np.ones(COUNT, bool))


@dataclass(frozen=True)
class InACube:
    """A mean over directions of points spread evenly in a cube."""

    encoding: str
    storage: str
    is_half: bool = False

    @property
    def command(self) -> str:
        """The command that shows the figure."""
        return f"normalbench quality --encoding {self.encoding} --storage {self.storage} --normals cube.npy"

    @property
    def scatter(self) -> float:
        """The scatter of a mean."""
        return SCATTER_OF_MEANS

    def figure(self) -> float | None:
        """Return the mean angle in degrees."""
        return _row(codec_of(self.encoding, self.storage), in_a_cube(self.is_half), False)["angle_mean_deg"]


@cache
def _instructions() -> dict[tuple[str, str], float]:
    names = {*(name for name, _ in published.SLOTS), *(name for name, _ in published.SLOTS_2009)}
    rows = cost.counted(cost.cases((ENCODINGS[name] for name in sorted(names)), (), cost.OPERATIONS), FAMILY, STAGE)
    return {key: float(row["instructions"]) for key, row in rows.items()}


@dataclass(frozen=True)
class Instructions(Exact):
    """Instructions of an operation in a fragment shader."""

    encoding: str
    operation: str

    @property
    def command(self) -> str:
        """The command that shows the figure."""
        words = f"--encoding {self.encoding} --operation {self.operation}"
        return f"normalbench cost --isa --family {FAMILY} --stage {STAGE} {words}"

    def figure(self) -> float | None:
        """Return the number of instructions, or None without a compiler."""
        return _instructions().get((self.encoding, self.operation))


@dataclass(frozen=True)
class Counted(Exact):
    """The result of a short computation."""

    compute: Callable[[], float]
    source: str

    @property
    def command(self) -> str:
        """The command that shows the figure."""
        return f"python -m tests.published {self.source}"

    def figure(self) -> float | None:
        """Return the computed value."""
        return self.compute()
