"""What `tune` does: parameters fitted to one half of a set, and what they gain on the other."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.catalogue import NAMES
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ...codecs.tuned_names import MARK, TABLE
from ...codecs.user_encodings import encodings_named
from ...normals.normal_names import normal_sets_named
from ...options.command_options import TuneOptions
from ...options.counts import check_seed, checked_count
from ...options.option import Reading
from ...output.errors import UsageError, pick
from ...output.writing import check_writable, whole_file, write
from ..quality import measure as quality
from .expected_errors import POWERS
from .halves import Halves, halves_of
from .tuning import Tuned, fitted, fitted_table, free_components

BITS = "bits"
# Held-out figures by the goal that each is.
FIGURES = {"psnr": "psnr_db", "mean": "angle_mean_deg", "rms": "angle_rms_deg", "max": "angle_max_deg"}
COLUMNS = (
    *("encoding", "storage", "normals", "error", "fitted_to", "held_out", "seed", "tuned_encoding", "tuned_storage"),
    *("quantity", "published", "tuned", "gain", "unit", "glsl"),
)
# Of that a gain is less than what another half would say.
NOTHING_DB = 0.005
Row = dict[str, Any]


@dataclass(frozen=True)
class Chosen:
    """What is tuned: a codec, the names of its parameters that are, and whether its bits or its look-up are."""

    codec: Codec
    names: list[str]
    has_bits: bool
    has_table: bool


@dataclass(frozen=True)
class Side:
    """A codec, as published or tuned, and its row on the held-out half."""

    codec: Codec
    row: Row


def tune_command(
    encoding: str, options: TuneOptions, reading: Reading, table: Path | None, format: str, output: Path | None
) -> None:
    """Fit, measure what was held out, and write both. Raises UsageError for what cannot be tuned."""
    if MARK in encoding and encoding.partition(MARK)[0] in NAMES:
        raise UsageError(f"{encoding}: tune begins with what was published; name {encoding.partition(MARK)[0]}")
    chosen = chosen_of(encoding, options)
    goal = _one("error", pick("error", options.error, {name: name for name in POWERS}))
    if table and not chosen.has_table:
        raise UsageError(f"--table: no look-up of {chosen.codec.name} is tuned")
    if table and set(str(table)) & {MARK, ","}:
        raise UsageError(f"--table: {table} could not be named after best_fit:table=; a name without {MARK} and comma")
    for path in filter(None, (table, output)):
        check_writable(path)
    quality.require_jax()
    halves = _halves(chosen, options, reading)
    scales = fitted_table(chosen.codec, halves.fitting, goal) if chosen.has_table else None
    found = fitted(chosen.codec, halves.fitting, goal, chosen.names, chosen.has_bits)
    codec = tuned_codec(chosen.codec, found, scales, table)
    before, after = (Side(c, _measured(c, halves)) for c in (chosen.codec, codec))
    if table and scales is not None:
        _write_table(table, scales)
    about = {"normals": halves.held_out.name, "error": goal, "seed": options.seed}
    about |= {"fitted_to": len(halves.fitting), "held_out": halves.held_out.count}
    write(list(rows(before, after, chosen, found, about)), format, output, ("seed", "glsl"))
    _say_use(before, after, FIGURES[goal], table, options.normals)


def chosen_of(name: str, options: TuneOptions) -> Chosen:
    """What an encoding's name and `--parameter` ask for. Raises UsageError where there is nothing of it."""
    encoding = _one("encoding", encodings_named(name))
    storage = _one("storage", quality.storages_named(options.storage))
    codec = Codec(encoding, storage)
    if not codec.fits:
        raise UsageError(f"{codec.name}: {codec.misfit}")
    quality.check_twin(encoding)
    known = {p: p for p in (*encoding.published, *_others(codec))}
    if not known:
        raise UsageError(f"{codec.name}: nothing to tune: no parameter, look-up, or two numbers that share bits")
    names = pick("parameter", options.parameter, known)
    numbers = [name for name in names if name in encoding.published]
    return Chosen(codec, numbers, BITS in names, TABLE in names)


def _others(codec: Codec) -> Iterator[str]:
    """What else than numbers can be tuned."""
    if free_components(codec):
        yield BITS
    look_up, storage = codec.encoding.look_up, codec.storage
    counts = {storage.count(i) for i in range(codec.encoding.components)}
    if look_up and storage.kind != "float" and len(counts) == 1 and counts <= set(look_up.levels):
        yield TABLE


def _one(what: str, found: list[Any]) -> Any:
    if len(found) != 1:
        raise UsageError(f"one {what} at a time is tuned, not {len(found)}")
    return found[0]


def _halves(chosen: Chosen, options: TuneOptions, reading: Reading) -> Halves:
    check_seed(options.seed)
    needs_rays = chosen.codec.encoding.domain == "view"
    sets = normal_sets_named(options.normals, checked_count(options.count), options.seed, reading, needs_rays)
    return halves_of(_one("normal set", sets), options.seed, by_tiles=chosen.has_table)


def tuned_codec(codec: Codec, found: Tuned, scales: np.ndarray | None, table: Path | None) -> Codec:
    """The codec with what was found, under the name that says it."""
    encoding: Encoding = codec.encoding
    changed = {name: value for name, value in found.values.items() if value != encoding.published[name]}
    if changed:
        encoding = encoding.with_parameters(changed)
    if scales is not None:
        encoding = encoding.with_table(scales, str(table or "FILE"))
    return replace(codec, encoding=encoding, storage=found.codec.storage)


def _measured(codec: Codec, halves: Halves) -> Row:
    return quality.measure(quality.Case(codec, halves.held_out, "jax"))


def _write_table(path: Path, scales: np.ndarray) -> None:
    with whole_file(path) as partial, partial.open("wb") as file:
        np.save(file, scales)


def rows(before: Side, after: Side, chosen: Chosen, found: Tuned, about: Row) -> Iterator[Row]:
    """A row for each parameter that was tuned, then one for each figure of the held-out half."""
    codecs = {"encoding": before.codec.encoding.name, "storage": before.codec.storage.name}
    codecs |= {"tuned_encoding": after.codec.encoding.name, "tuned_storage": after.codec.storage.name}
    empty = dict.fromkeys(COLUMNS) | codecs | about
    for parameter in before.codec.encoding.parameters:
        if parameter.name in chosen.names:
            published, tuned = before.codec.encoding.published[parameter.name], found.values[parameter.name]
            yield empty | _row(parameter.name, published, tuned) | {"glsl": parameter.constant}
    if chosen.has_bits:
        for i in free_components(before.codec):
            published, tuned = (codec.storage.bits[i] for codec in (before.codec, after.codec))
            yield empty | _row(f"{BITS}_{'xyz'[i]}", published, tuned)
    if chosen.has_table:
        yield empty | _row("texels_changed", 0, _changed(before.codec.encoding, after.codec.encoding))
    for figure in FIGURES.values():
        published, tuned = (side.row[figure] for side in (before, after))
        yield empty | _row(figure, published, tuned) | _gain(figure, published, tuned)


def _changed(before: Encoding, after: Encoding) -> int:
    assert before.look_up
    published, tuned = (encoding.tables()[before.look_up.sampler] for encoding in (before, after))
    return int(np.count_nonzero(published != tuned))


def _row(quantity: str, published: float, tuned: float) -> Row:
    return {"quantity": quantity, "published": published, "tuned": tuned}


def _gain(figure: str, published: float, tuned: float) -> Row:
    """Decibels more, or by how many percent an angle is smaller."""
    if figure == FIGURES["psnr"]:
        return {"gain": tuned - published if tuned != published else 0.0, "unit": "dB"}
    return {"gain": 100 * (1 - tuned / published) if published else 0.0, "unit": "%"}


def _say_use(before: Side, after: Side, figure: str, table: Path | None, normals: str) -> None:
    gain = _gain(figure, *(side.row[figure] for side in (before, after)))
    if gain["gain"] <= NOTHING_DB:
        said = (
            f"nothing is gained on the held-out half ({gain['gain']:.2g} {gain['unit']}): stay with what is published"
        )
    elif after.codec.encoding.look_up and not table and after.codec.encoding.tables != before.codec.encoding.tables:
        said = "keep the look-up with --table FILE.npy to measure it elsewhere"
    else:
        names = ["--encoding", after.codec.encoding.name, "--storage", after.codec.storage.name, "--normals", normals]
        said = f"elsewhere: normalbench quality {shlex.join(names)}"
    print(f"normalbench: {said}", file=sys.stderr)
