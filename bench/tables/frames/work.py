"""Measurement and display of the table of tangent frames."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ....encodings.codecs.frame_codec import FrameCodec
from ....encodings.kinds import FRAME
from ....encodings.storages.storage import ROUNDINGS_AND_DITHERED
from ...ground.options.counts import check_seed, checked_count
from ...ground.options.targets import not_with_noise, that_fit, without_noise
from ...subjects.codecs.kinds.codecs import codecs_of_kind
from ...subjects.names.backends import backends_here
from ...subjects.names.storages import roundings_named
from ..charts import having, one_backend
from ..table import NoOutputs, Row, Sheet, Step, Work, each
from ..verdicts import by_bits
from . import measure
from .sets import frame_sets_named
from .table import FramesOptions


def cases(options: FramesOptions) -> list[measure.FrameCase]:
    """Return one case for each frame set, codec and backend.

    Raises:
        UsageError: unknown names, a file that cannot be read, or no codec that fits its storage.
        MissingError: only GLSL is requested and there is no OpenGL device.
    """
    check_seed(options.seed)
    count = checked_count(options.count)
    chosen = codecs(options)
    backends = backends_here(options.backend, measure.BACKENDS)
    sets = frame_sets_named(options.frames, count, options.seed)
    return [
        measure.FrameCase(codec, frames, backend, options.worst_case)
        for frames in sets
        for codec in chosen
        for backend in backends
    ]


def codecs(options: FramesOptions) -> list[FrameCodec]:
    """Return the requested codecs; codecs that do not fit their storage are named on standard error."""
    roundings = roundings_named(options.rounding, ROUNDINGS_AND_DITHERED)
    chosen = codecs_of_kind(FRAME, options.encoding, options.storage, roundings)
    return that_fit(without_noise(chosen, not_with_noise("--worst-case")) if options.worst_case else chosen)


def _steps(options: FramesOptions, _: NoOutputs) -> list[Step]:
    return [Step(_key(case), case, case.name) for case in cases(options)]


def _key(case: measure.FrameCase) -> Row:
    key: Row = {"codec": case.codec.name, "frame_set": case.frame_set.name, "backend": case.backend}
    key |= {"count": case.frame_set.count, "seed": case.frame_set.seed}
    return key | ({"worst_case": True} if case.worst_case else {})


def _failures(rows: Sequence[Row]) -> Iterator[str]:
    for row in rows:
        if row["below_limit"]:
            wrong = f"{row['codes']} codes cannot be that accurate: the measurement is wrong"
            yield f"{row['encoding']}/{row['storage']}: {row['below_limit']}; {wrong}"


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return the rows by set, bits and the codec's smallest RMS angle; codecs without figures come last."""
    sets = list(dict.fromkeys(row["frame_set"] for row in rows))
    best: dict[tuple, float] = {}
    for row in rows:
        rms, codec = row["rotation_rms_deg"], _codec_of(row)
        best[codec] = min(best.get(codec, math.inf), math.inf if rms is None else rms)
    return sorted(rows, key=lambda row: (sets.index(row["frame_set"]), row["bits"], best[_codec_of(row)]))


def _codec_of(row: Row) -> tuple:
    return row["frame_set"], row["encoding"], row["storage"], row["rounding"]


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    measured = one_backend(having(rows, "rotation_rms_deg"))
    for kind, is_handed in {"with handedness": True, "without handedness": False}.items():
        part = [row for row in measured if (row["hands_lost"] is not None) is is_handed]
        if part:
            best = by_bits(part, "rotation_mean_deg", lambda row: f"{row['rotation_mean_deg']:.2g}°")
            yield f"Most accurate {kind}, by mean rotation: {best}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    measured = [row for row in rows if row["rotation_rms_deg"] is not None]
    chosen = [row for row in measured if row["backend"] == measured[0]["backend"]]
    names = ("encoding", "storage", "rounding", "bits", "rotation_mean_deg", "rotation_rms_deg", "rotation_max_deg")
    names += ("effective_bits", "limit_rms_deg", "hands_lost")
    if chosen:
        title = f"tangent frames, degrees between true and decoded, by {chosen[0]['backend']}"
        yield Sheet(title, [{name: row[name] for name in names} for row in chosen])


WORK = Work(
    steps=_steps,
    measure=each(lambda case: [measure.measure(case)]),
    finish=in_order,
    verdict=_verdict,
    summary=_summary,
    failures=_failures,
)
