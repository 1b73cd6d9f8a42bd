"""Measurement and display of the table of curves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from ....encodings.codecs.curve_codec import CurveCodec
from ....encodings.kinds import CURVE
from ....encodings.storages.storage import ROUNDINGS_AND_DITHERED
from ...ground.options.counts import check_seed, checked_numbers, in_range
from ...ground.options.targets import that_fit
from ...subjects.codecs.kinds.codecs import codecs_of_kind
from ...subjects.names.backends import backends_here
from ...subjects.names.storages import roundings_named
from ..charts import one_backend
from ..table import NoOutputs, Row, Sheet, Step, Work, each
from ..verdicts import by_bits
from . import measure
from .charts import charts
from .table import CurvesOptions

MAX_QUANTITIES, RANGES = 2**22, (1e-4, 65504.0)


def cases(options: CurvesOptions) -> list[measure.CurveCase]:
    """Return one case for each curve, range, storage, rounding and backend.

    Raises:
        UsageError: unknown names, numbers out of range, or no codec that fits its storage.
        MissingError: only GLSL is requested and there is no OpenGL device.
    """
    check_seed(options.seed)
    in_range("--count", options.count, 2, MAX_QUANTITIES)
    chosen = codecs(options)
    backends = backends_here(options.backend, measure.BACKENDS)
    return [measure.CurveCase(codec, backend, options.count, options.seed) for codec in chosen for backend in backends]


def codecs(options: CurvesOptions) -> list[CurveCodec]:
    """Return the requested codecs; codecs that do not fit their storage are named on standard error."""
    roundings = roundings_named(options.rounding, ROUNDINGS_AND_DITHERED)
    ranges = None if options.range is None else checked_numbers("--range", options.range, float, *RANGES)
    return that_fit(
        replace(codec, range=largest)
        for codec in codecs_of_kind(CURVE, options.encoding, options.storage, roundings)
        for largest in ranges or (codec.range,)
    )


def _steps(options: CurvesOptions, _: NoOutputs) -> list[Step]:
    return [Step(_key(case), case, case.name) for case in cases(options)]


def _key(case: measure.CurveCase) -> Row:
    key: Row = {"codec": case.codec.name, "rounding": case.codec.rounding, "backend": case.backend}
    return key | {"range": case.codec.range, "count": case.count, "seed": case.seed}


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return the rows by bits, then by largest error in ascending order; rows without figures come last."""
    return sorted(rows, key=lambda row: (row["bits"], math.inf if row["error_max"] is None else row["error_max"]))


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    measured = one_backend([row for row in rows if row["error_max"] is not None])
    quantities = {"error_max": "roughness, metallic and AO", "display_max": "colours, in display steps"}
    for figure, quantity in quantities.items():
        part = [row for row in measured if row[figure] is not None]
        if part:
            best = by_bits(part, figure, lambda row, figure=figure: f"{row[figure]:.2g}")
            yield f"Most accurate for {quantity}, by largest error: {best}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    measured = one_backend([row for row in rows if row["error_mean"] is not None])
    names = ("encoding", "storage", "rounding", "range", "bits", "error_mean", "error_max", "display_max", "least")
    if measured:
        yield Sheet("material values, by bits", [{name: row[name] for name in names} for row in measured])


WORK = Work(
    steps=_steps,
    measure=each(lambda case: [measure.measure(case)]),
    finish=in_order,
    verdict=_verdict,
    summary=_summary,
    charts=charts,
)
