"""Measurement and display of the roughness table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ....gbuffer.environment.environment import Environment
from ....gbuffer.environment.prefilter import key_of
from ...ground.choose import choose
from ...ground.machine.devices import require_device, require_jax
from ...ground.options.counts import checked_numbers
from ...ground.options.targets import checked_target
from ...ground.options.words import Names
from ...ground.output.errors import UsageError
from ...subjects.codecs.names import codecs_named, fitting
from ...subjects.environments.environment_names import environment_named
from ..table import Measured, Row, Sheet, Step, Work, each
from .charts import charts
from .frames import DITHERS, NONE, Accumulation
from .measure import RoughnessCase, answers, in_order, measure
from .objects import OBJECTS
from .table import RoughnessOptions, RoughnessOutputs

# Frames that temporal antialiasing keeps, more or less; and the most that are held.
TEMPORAL, MOST_FRAMES = 8, 64
CODE, USUAL = ("encoding", "storage", "rounding"), {"dither": NONE, "frames": 1}


def _steps(options: RoughnessOptions, _: RoughnessOutputs) -> list[Step]:
    """Return a step for each object in each environment, with all codecs. Raises UsageError and MissingError."""
    require_jax()
    device = require_device()
    seen = _seen(options)
    # The frames of a code and those of exact normals are held at once.
    size, _samples = checked_target(options.size, 1, 2 * max(accumulation.frames for accumulation in seen), device)
    thresholds = tuple(checked_numbers("--threshold", options.threshold, float, 0.001, 1.0))
    objects = tuple(choose("object", options.object, {name: name for name in OBJECTS}))
    around = _environments(options.environment)
    codecs, _left_out = fitting(codecs_named(options.encoding, options.storage, options.rounding))
    metals = [name for name in objects if OBJECTS[name].is_metal]
    pairs = [(name, environment) for environment in around for name in metals]
    pairs += [(name, None) for name in objects if name not in metals]
    cases = [RoughnessCase(tuple(codecs), *pair, thresholds, size, seen) for pair in pairs]
    return [Step(_key(case), case, case.name) for case in cases]


def _seen(options: RoughnessOptions) -> tuple[Accumulation, ...]:
    """Return every combination of a dither, always including none, and a number of frames. By default there is one
    frame and, if a dither is requested, also as many frames as temporal antialiasing averages."""
    dithers = dict.fromkeys((NONE, *choose("dither", options.dither, {name: name for name in DITHERS})))
    usual = ("1",) if tuple(dithers) == (NONE,) else ("1", str(TEMPORAL))
    frames = checked_numbers("--frames", options.frames or usual, int, 1, MOST_FRAMES)
    return tuple(Accumulation(dither, count) for dither in dithers for count in frames)


def _environments(words: Names) -> tuple[Environment, ...]:
    """Return the named environments. Raises UsageError for an unknown name, or if two have the same name."""
    environments = tuple(environment_named(str(word)) for word in words)
    names = [environment.name for environment in environments]
    if not environments:
        raise UsageError("--environment: no environment given; name at least one, such as studio")
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise UsageError(f"--environment: {twice} is named twice; name it once")
    return environments


def _key(case: RoughnessCase) -> Row:
    key: Row = {"codecs": [codec.name for codec in case.codecs], "object": case.object, "size": list(case.size)}
    key |= {"seen": [[accumulation.dither, accumulation.frames] for accumulation in case.seen]}
    radiance = key_of(case.environment.radiance) if case.environment else None
    return key | {"environment": radiance, "thresholds": list(case.thresholds)}


def _shown(done: Measured) -> Iterator[Sheet]:
    notes = ("Below these roughnesses, bands are visible. With -o FILE the rows have FLIP and PSNR of each image.",)
    yield from (replace(sheet, notes=notes) for sheet in _summary(done.rows))


def _said(rows: Sequence[Row]) -> tuple[str, ...]:
    """Return the names of the columns that identify a codec, and of drawing options that any row changes."""
    return *CODE, *(name for name, usual in USUAL.items() if any(row[name] != usual for row in rows))


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    crossings = list(answers(rows))
    for threshold, word in {0.1: "acceptable", 0.05: "invisible"}.items():
        part = [row for row in crossings if row["threshold"] == threshold]
        for encoding in dict.fromkeys(row["encoding"] for row in part):
            where = ", ".join(_from(row) for row in part if row["encoding"] == encoding)
            yield f"{encoding}: banding is {word} (FLIP {threshold:g}) from roughness: {where}."
    mirrors: dict[str, dict[str, float]] = {}
    for row in rows:
        if row["threshold"] is None and row["roughness"] == 0 and row["flip_p99"] is not None and row["dither"] == NONE:
            by_storage = mirrors.setdefault(row["encoding"], {})
            by_storage[row["storage"]] = max(by_storage.get(row["storage"], 0.0), row["flip_p99"])
    for encoding, by_storage in mirrors.items():
        where = ", ".join(f"{storage} {flip:.2g}" for storage, flip in by_storage.items())
        yield f"{encoding}: FLIP of mirrors (roughness 0): {where}."


def _from(row: Row) -> str:
    known = row["roughness"]
    least = "none" if known is None else f"{known:.2f}" if known else "any"
    dithered = "" if row["dither"] == NONE else f" with {row['dither']} dither"
    return f"{row['storage']}{dithered} {least}"


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a sheet of the lowest roughness at which each codec is within each threshold; nothing if no row decides."""
    lines: dict[tuple[object, ...], Row] = {}
    for row in answers(rows):
        about = {name: row[name] for name in (*_said(rows), "bits")}
        line = lines.setdefault(tuple(about.values()), about)
        threshold = f"{row['threshold']:g}"
        line[f"from, at {threshold}"] = "none" if row["roughness"] is None else f"{row['roughness']:.2f}"
        line[f"decided by, at {threshold}"] = f"{row['object']} in {row['environment']}"
    if lines:
        yield Sheet(
            "lowest roughness at which each encoding's reflections are acceptable, by FLIP threshold",
            list(lines.values()),
        )


def _measured(case: RoughnessCase) -> list[Row]:
    return measure(require_device(), case)


WORK = Work(
    steps=_steps,
    measure=each(_measured),
    finish=in_order,
    shown=_shown,
    verdict=_verdict,
    summary=_summary,
    charts=charts,
)
