"""Measurement and display of the lights table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ....encodings.codecs.light_codec import LightCodec
from ....gbuffer.display import displayed
from ....gbuffer.gl.device import Device
from ....reports.charts import pictures
from ...ground.choose import choose
from ...ground.machine.devices import found_device, require_jax
from ...ground.options.counts import check_seed, checked_numbers
from ...ground.output.errors import UsageError
from ...ground.output.writing import check_folder, whole_file
from ...subjects.codecs.kinds.named import light_codecs_named
from ...subjects.names.light_buffers import MOST_LIGHT
from ..charts import having
from ..table import Row, Sheet, Step, Work, each
from . import measure
from .charts import charts, way_of
from .sums import ORDERS
from .table import LightsOptions, LightsOutputs

# How many of the best light buffers a verdict names, next to the worst.
NAMED = 4

# Lights in one sum.
MOST_LIGHTS = 4096
PLOTTED = {"equal", "random"}


def experiments(options: LightsOptions) -> list[str]:
    """Return the names of the requested experiments. Raises UsageError for an unknown name."""
    return choose("experiment", options.experiment, {name: name for name in measure.EXPERIMENTS})


def encodings(options: LightsOptions) -> list[LightCodec]:
    """Return the requested light buffers. Raises UsageError for an unknown name or faulty Python code."""
    chosen = light_codecs_named(options.light_buffer)
    for encoding in chosen:
        measure.check_light_twin(encoding)
    return chosen


def added(options: LightsOptions) -> measure.Sums:
    """Return the sums, counts, peaks and seed from the options. Raises UsageError if a value is out of range."""
    check_seed(options.seed)
    return measure.Sums(
        checked_numbers("--sum", options.sums, float, 1e-6, MOST_LIGHT),
        checked_numbers("--counts", options.counts, int, 1, MOST_LIGHTS),
        checked_numbers("--peak", options.peaks, float, 1e-6, MOST_LIGHT),
        options.seed,
    )


def _check(outputs: LightsOutputs, names: Sequence[str]) -> None:
    """Raise UsageError if the image folder cannot be written to, or an output requires another experiment."""
    if outputs.plot and not PLOTTED & set(names):
        raise UsageError("--plot: plots only the experiments equal and random; add one of them to --experiment")
    if outputs.images:
        check_folder(outputs.images)
        if "banding" not in names:
            raise UsageError("--images: shows only the experiment banding; add banding to --experiment")


def _steps(options: LightsOptions, outputs: LightsOutputs) -> list[Step]:
    require_jax()
    gl, missing = found_device()
    names, chosen, sums = experiments(options), encodings(options), added(options)
    _check(outputs, names)
    return [_sum_step(names, encoding, sums, gl, missing, outputs.images) for encoding in chosen]


def _sum_step(
    names: list[str], encoding: LightCodec, sums: measure.Sums, gl: Device | None, missing: str, images: Path | None
) -> Step:
    def rows() -> list[Row]:
        if images:
            with whole_file(images / f"banding-{encoding.name}.png") as partial:
                pictures.write_png(partial, _bands(encoding, sums.peaks, gl))
        sum_rows = list(measure.sum_rows(names, encoding, sums, gl))
        return sum_rows if gl else [row | {"skipped": missing} for row in sum_rows]

    key: Row = {"experiments": names, "light_buffer": encoding.name, "seed": sums.seed}
    key |= {"sums": list(sums.sums), "counts": list(sums.counts), "peaks": list(sums.peaks)}
    return Step(key | {"device": gl.renderer if gl else None}, rows, encoding.name)


def _bands(encoding: LightCodec, peaks: tuple[float, ...], gl: Device | None) -> np.ndarray:
    """Return an image of a lamp's falloff as displayed, with a strip for each peak."""
    strips = [displayed(measure.banded(encoding, peak, gl) / max(peak, 1.0)) for peak in peaks]
    return pictures.strips([strip[::2] for strip in strips], 64)


def _finish(rows: Sequence[Row]) -> list[Row]:
    if not rows:
        raise UsageError("nothing to measure: chromaticity requires an encoding with a fourth component")
    return measure.sorted_rows(list(rows))


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence on the errors of summing the most random lights, for buffers that blend and for buffers that
    are read first; nothing without such rows."""
    sums = _random(rows)
    most = max((row["lights"] for row in sums), default=0)
    errors: dict[str, list[str]] = {}
    # Software drivers truncate where GPUs round, so the model answers.
    for row in sorted(having(sums, "model_rms"), key=lambda row: row["model_rms"]):
        if row["lights"] == most:
            error = f"{row['model_rms']:.1%} in {row['light_buffer']}"
            errors.setdefault(way_of(row["light_buffer"]), []).append(error)
    if errors:
        parts = "; ".join(f"{', '.join([*some[:NAMED], *some[NAMED:][-1:]])} ({way})" for way, some in errors.items())
        yield f"After {most} random lights, the RMS error of the model is {parts}."


def _random(rows: Sequence[Row]) -> list[Row]:
    """Return the rows on random lights with the smallest sum, with the lights added up in the order as drawn."""
    known = (row for row in rows if row["model_rms"] is not None or row["gl_rms"] is not None)
    drawn = [row for row in known if row["experiment"] == "random" and row["order"] == ORDERS[0]]
    darkest = min((row["sum"] for row in drawn), default=None)
    return [row for row in drawn if row["sum"] == darkest]


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    equal: dict[tuple[str, str], Row] = {}
    for row in rows:
        if row["experiment"] == "equal" and row["sum"] == 1:
            line = {"light_buffer": row["light_buffer"], "channel": row["channel"]}
            equal.setdefault((row["light_buffer"], row["channel"]), line)[f"{row['lights']}_lights"] = row["model"]
    if equal:
        yield Sheet("lights that sum to 1: sum in the light buffer, by the model", list(equal.values()))
    names = ("light_buffer", "sum", "lights", "model_rms", "gl_rms", "model_max", "gl_max", "rounds")
    if sums := [{name: row[name] for name in names} for row in _random(rows)]:
        yield Sheet("random lights in drawing order, relative errors", sums)


WORK = Work(
    steps=_steps,
    measure=each(lambda rows: rows()),
    finish=_finish,
    verdict=_verdict,
    summary=_summary,
    charts=charts,
)
