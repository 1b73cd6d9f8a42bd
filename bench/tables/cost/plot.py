"""The plot of `cost`: what a codec's encoding and storage cost together, against what the codec loses."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from types import MappingProxyType

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.storage import Storage
from ....reports.charts import pareto
from ....reports.charts.chart import Chart
from ...ground.output.errors import tell
from ...subjects.normals.normal_sets import NormalSet
from ..quality import measure as quality
from .charts import front_chart
from .codec_costs import Costs, LeftOutError, Where
from .measure import Row

# Of each measure that is drawn a column, what it is in the plot, and how many of that one of the column's is.
UNITS = MappingProxyType(
    {"isa": ("instructions", "instructions", 1.0), "time": ("ns_per_megapixel", "ms a megapixel", 1e-6)}
)
# What measures a codec's error: the first that can.
BACKENDS = ("jax", "glsl")


@dataclass(frozen=True)
class Wanted:
    """A panel to be: the codecs of a storage on a set of normals, by one measure on one machine."""

    storage: Storage
    normals: NormalSet
    where: Where
    operation: str

    @property
    def name(self) -> str:
        where = (self.where.family, self.where.stage) if self.where.family else (self.where.measure,)
        return " ".join(filter(None, (self.storage.name, self.normals.name, *where, self.operation)))


def charts(
    rows: Sequence[Row], encodings: Sequence[Encoding], chosen: Sequence[Storage], sets: Sequence[NormalSet], error: str
) -> list[Chart]:
    """A chart for each measure; none where there is nothing to draw."""
    made = panels(rows, encodings, chosen, sets, error)
    about = pareto.ERRORS[error][1]
    subtitle = f"Cost against {about.label}"
    return [
        front_chart("cost", subtitle, [panel for panel in made if panel.unit == unit], about)
        for unit in dict.fromkeys(panel.unit for panel in made)
    ]


def panels(
    rows: Sequence[Row], encodings: Sequence[Encoding], chosen: Sequence[Storage], sets: Sequence[NormalSet], error: str
) -> list[pareto.Panel]:
    """A panel for each storage, normal set, measure, family, stage and operation.

    What is left out is said on standard error.
    """
    wanted = list(_wanted_panels(rows, chosen, sets))
    drawing = Drawing(rows, encodings, error)
    made = [panel for want in wanted[: pareto.MOST_PANELS] if (panel := drawing.panel(want)).points]
    for line in (*drawing.left_out(), *_left_out_lines(wanted[pareto.MOST_PANELS :])):
        tell(f"--plot: {line}")
    return made


def _wanted_panels(rows: Sequence[Row], chosen: Sequence[Storage], sets: Sequence[NormalSet]) -> Iterator[Wanted]:
    for storage, normals, (measure, (column, *_)) in product(chosen, sets, UNITS.items()):
        known = [r for r in rows if r["measure"] == measure and r["encoding"] and r[column] is not None]
        where = dict.fromkeys((r["family"], r["stage"], r["operation"]) for r in known)
        for family, stage, operation in where:
            yield Wanted(storage, normals, Where(measure, family, stage), operation)


def _left_out_lines(wanted: Sequence[Wanted]) -> Iterator[str]:
    if wanted:
        names = ", ".join(want.name for want in wanted)
        yield f"there is room for {pareto.MOST_PANELS} panels; left out: {names}"


class Drawing:
    """Panels of points, and what has none."""

    def __init__(self, rows: Sequence[Row], encodings: Sequence[Encoding], error: str):
        self._encodings, self._column = encodings, pareto.ERRORS[error][0]
        self._rows, self._costs = rows, Costs(rows)
        self._errors: dict[tuple[Codec, str], float | None] = {}
        self._lost: dict[str, dict[str, None]] = {}

    def left_out(self) -> Iterator[str]:
        """Which codecs have no point, a line for each reason."""
        for reason, names in self._lost.items():
            yield f"left out, {reason}: {', '.join(names)}"

    def panel(self, want: Wanted) -> pareto.Panel:
        """A panel's points, some of which may be missing."""
        codecs = (Codec(encoding, want.storage) for encoding in self._encodings)
        points = [point for codec in codecs if (point := self._point(want, codec))]
        return pareto.Panel(
            self._title(want), UNITS[want.where.measure][1], points, is_counted=want.where.measure == "isa"
        )

    def _title(self, want: Wanted) -> str:
        measure, family, stage = want.where.measure, want.where.family, want.where.stage
        alike = (row for row in self._rows if (row["measure"], row["family"], row["stage"]) == (measure, family, stage))
        row = next(row for row in alike if row["device"])
        machine = (family, stage, row["driver"]) if family else (row["device"],)
        mark = ", in software" if row["software"] else ""
        return f"{want.operation}, {want.storage.title}, {want.normals.name}\n{', '.join(map(str, machine))}{mark}"

    def _point(self, want: Wanted, codec: Codec) -> pareto.Point | None:
        column, _, scale = UNITS[want.where.measure]
        try:
            total = self._costs.of(codec, want.where, want.operation, column)
            error = self._error(codec, want.normals)
        except LeftOutError as reason:
            self._lost.setdefault(str(reason), {})[codec.encoding.name] = None
            return None
        name, spread = codec.encoding.name, total.spread * scale
        return pareto.Point(name, total.cost * scale, error, codec.bits, spread, total.branches)

    def _error(self, codec: Codec, normals: NormalSet) -> float:
        key = codec, normals.name
        if key not in self._errors:
            # A user's own encoding may have no Python twin.
            by_backend = (quality.measure(quality.Case(codec, normals, name))[self._column] for name in BACKENDS)
            self._errors[key] = next((error for error in by_backend if error is not None), None)
        error = self._errors[key]
        if error is None:
            raise LeftOutError("its error cannot be measured")
        if error == 0 or not math.isfinite(error):
            raise LeftOutError(f"nothing is lost on {normals.name}")
        return error
