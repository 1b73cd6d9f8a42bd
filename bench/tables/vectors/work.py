"""Measurement and display of the table of motion vectors."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ....encodings.codecs.motion_codec import MotionCodec
from ....encodings.kinds import MOTION
from ....encodings.storages.storage import ROUNDINGS_AND_DITHERED
from ...ground.options.counts import check_seed, checked_numbers, checked_sides, in_range
from ...ground.options.targets import that_fit
from ...subjects.codecs.kinds.codecs import codecs_of_kind
from ...subjects.names.backends import backends_here
from ...subjects.names.storages import roundings_named
from ..charts import but_without_twins, one_backend
from ..table import Measured, NoOutputs, Row, Sheet, Step, Work, each
from ..verdicts import by_bits
from . import measure
from .charts import charts
from .order import place
from .paths import Paths
from .table import VectorsOptions

MAX_SIDE, MAX_POINTS = 2**16, 2**24
SPEEDS, RANGES = (1e-6, 1e5), (1e-3, 16.0)
# What tells a line of a sheet or a chart from another.
LINE = ("encoding", "storage", "rounding", "backend", "range", "size")
# The speed that a verdict compares at, in pixels per frame.
EVERYDAY_PX = 4.0
# Errors up to this are alike: reprojection filters between pixels.
UNNOTICED_PX = 0.01


def cases(options: VectorsOptions) -> list[measure.MotionVectorCase]:
    """Return a case for each codec, range and backend; a codec that needs no range has one case per backend.

    Raises:
        UsageError: unknown names, numbers out of range, or no codec that fits.
        MissingError: only GLSL is requested and there is no OpenGL device.
    """
    check_seed(options.seed)
    in_range("--count", options.count, 1, MAX_POINTS)
    paths = Paths(options.count, options.seed, checked_sides(options.size, MAX_SIDE, "pixels"))
    speeds = checked_numbers("--speed", options.speed, float, *SPEEDS)
    ranges = checked_numbers("--range", options.range, float, *RANGES)
    chosen = codecs(options)
    backends = backends_here(options.backend, measure.BACKENDS)
    return [
        measure.MotionVectorCase(codec, backend, largest, speeds, paths)
        for codec in chosen
        for largest in codec.ranges(ranges)
        for backend in backends
    ]


def codecs(options: VectorsOptions) -> list[MotionCodec]:
    """Return the requested codecs; codecs that do not fit their storage are named on standard error."""
    roundings = roundings_named(options.rounding, ROUNDINGS_AND_DITHERED)
    return that_fit(codecs_of_kind(MOTION, options.encoding, options.storage, roundings))


def _steps(options: VectorsOptions, _: NoOutputs) -> list[Step]:
    return [Step(_key(case), case, case.name) for case in cases(options)]


def _key(case: measure.MotionVectorCase) -> Row:
    key: Row = {"codec": case.codec.name, "backend": case.backend, "range": case.largest, "size": case.size}
    return key | {"speeds": list(case.speeds), "count": case.paths.count, "seed": case.paths.seed}


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return the rows by bits, then by the codec's error at the lowest speed in ascending order; the rows of a codec
    stay together."""
    best: dict[tuple, float] = {}
    for row in sorted(rows, key=lambda row: row["speed"], reverse=True):
        error = row["error_mean_px"]
        best[_code(row)] = math.inf if error is None else error
    return sorted(rows, key=lambda row: (row["bits"], best[_code(row)], *map(str, _line(row))))


def _code(row: Row) -> tuple:
    return row["encoding"], row["storage"], row["rounding"]


def _line(row: Row) -> tuple:
    return tuple(row[name] for name in LINE)


def _by_speed(rows: Sequence[Row], figure: str, names: Sequence[str]) -> list[Row]:
    """Return a row for each codec and range, with the columns `names` followed by the figure at each speed."""
    lines: dict[tuple, Row] = {}
    for row in rows:
        line = lines.setdefault(_line(row), {name: _said(row[name]) for name in names})
        line[f"{row['speed']:g} px"] = row[figure]
    return list(lines.values())


def _said(value: object) -> object:
    """Return a float of at least 0.001 as text of up to six digits, such as `0.5`; any other value is unchanged."""
    return f"{value:g}" if isinstance(value, float) and value >= 1e-3 else value


def _shown(done: Measured) -> Iterator[Sheet]:
    rows = but_without_twins(done.rows)
    names = ("encoding", "storage", "rounding", "bits", "backend", "range")
    sheets = {
        "error_mean_px": ("mean error in pixels, by speed in pixels per frame", ("still_px", "least_px")),
        "drift_px": ("drift in pixels after 16 frames, by speed", ()),
        "lost_percent": ("percentage of motions decoded as no motion, by speed; encodings that lose any", ()),
    }
    for figure, (title, more) in sheets.items():
        losing = {_line(row) for row in rows if figure != "lost_percent" or row[figure]}
        part = [row for row in rows if _line(row) in losing]
        if part:
            yield Sheet(f"{title}; {part[0]['size']}", _by_speed(part, figure, (*names, *more)), ("range",))


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence on the most accurate encodings at an everyday speed among those that keep still pixels still,
    or a sentence that no encoding does; nothing without figures."""
    measured = one_backend([row for row in rows if row["error_mean_px"] is not None])
    speed = min((row["speed"] for row in measured), key=lambda speed: abs(speed - EVERYDAY_PX), default=0.0)
    still = [row for row in sorted(measured, key=place) if row["speed"] == speed and not row["still_px"]]
    seen = [row | {"at_least_px": max(row["error_mean_px"], UNNOTICED_PX)} for row in still]
    if seen:
        best = by_bits(seen, "at_least_px", lambda row: f"{row['error_mean_px']:.2g} px")
        how = f"still pixels exact; errors up to {UNNOTICED_PX:g} px count as equal"
        yield f"Most accurate at {speed:g} px per frame ({how}): {best}."
    elif measured:
        yield "No encoding keeps still pixels still; use a storage with an exact code for 0 (_centred or _snorm)."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    measured = one_backend([row for row in rows if row["error_mean_px"] is not None])
    if measured:
        names = ("encoding", "storage", "rounding", "bits", "still_px", "least_px")
        title = f"motion vectors, mean error in pixels by speed, {measured[0]['size']}"
        yield Sheet(title, _by_speed(measured, "error_mean_px", names))


WORK = Work(
    steps=_steps,
    measure=each(measure.measure),
    finish=in_order,
    shown=_shown,
    verdict=_verdict,
    summary=_summary,
    charts=charts,
)
