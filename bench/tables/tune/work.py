"""Tuning of an encoding: fitting to one half of a set of normals, and measurement on the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.catalogue import NAMES
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ...ground.choose import choose, choose_one
from ...ground.machine.devices import require_jax
from ...ground.machine.systems.people import command_line
from ...ground.options.counts import check_seed, checked_count
from ...ground.options.words import Names, text_of
from ...ground.output.errors import UsageError, tell
from ...ground.output.replacing import ARRAY
from ...ground.output.writing import check_writable, whole_file
from ...subjects.codecs.encoding_names import encodings_named
from ...subjects.codecs.names import check_twin
from ...subjects.codecs.tuned_names import MARK
from ...subjects.codecs.tuned_names import TABLE as LOOK_UP
from ...subjects.names.storages import storages_named
from ...subjects.normals.normal_names import check_rays, normal_sets_named
from ...subjects.normals.normal_sets import NormalSet
from ..quality import measure as quality
from ..table import Measured, Row, Sheet, Step, Tick, Work, each
from .halves import Halves, halves_of
from .table import TABLE, TuneOptions, TuneOutputs
from .tuning import Values, fitted, fitted_table

# Held-out figures by the goal that each is.
FIGURES = {"psnr": "psnr_db", "mean": "angle_mean_deg", "rms": "angle_rms_deg", "max": "angle_max_deg"}
# Of that a gain is less than what another half would say.
NOTHING_DB = 0.005


@dataclass(frozen=True)
class Chosen:
    """The target of tuning: a codec, the names of the parameters to tune, and whether to tune its lookup table."""

    codec: Codec
    names: list[str]
    has_table: bool


@dataclass(frozen=True)
class Side:
    """A codec, as published or tuned, and its row on the held-out half."""

    codec: Codec
    row: Row


@dataclass(eq=False)
class Tuning:
    """A tuning task: its target and normals and, once done, the codec before and after, and the lookup table."""

    chosen: Chosen
    halves: Halves
    options: TuneOptions
    table: Path | None
    sides: tuple[Side, Side] | None = None
    scales: np.ndarray | None = None

    def measured(self) -> list[Row]:
        """Fit the codec to one half of the normals, and return rows on both codecs over the other half."""
        chosen, halves, goal = self.chosen, self.halves, self.options.error
        self.scales = fitted_table(chosen.codec, halves.fitting, goal) if chosen.has_table else None
        parameters = fitted(chosen.codec, halves.fitting, goal, chosen.names)
        codec = tuned_codec(chosen.codec, parameters, self.scales, self.table)
        before, after = (Side(c, _measured(c, halves)) for c in (chosen.codec, codec))
        self.sides = before, after
        about = {"normals": halves.held_out.name, "error": goal, "seed": self.options.seed}
        about |= {"code_space": halves.held_out.code_space}
        about |= {"fitted_to": len(halves.fitting), "held_out": halves.held_out.count}
        return list(rows(before, after, chosen, parameters, about))


def _steps(options: TuneOptions, outputs: TuneOutputs) -> list[Step]:
    """Return a list of one step. Raises UsageError for a target that cannot be tuned."""
    encoding, table = options.encoding, outputs.table
    if MARK in encoding and encoding.partition(MARK)[0] in NAMES:
        raise UsageError(f"{encoding}: tune starts from the published encoding; name {encoding.partition(MARK)[0]}")
    chosen = chosen_of(encoding, options)
    options = replace(options, error=choose_one("error", options.error, FIGURES))
    if table and not chosen.has_table:
        raise UsageError(f"--table: {chosen.codec.name} has no lookup table to tune; leave --table out")
    if table and set(str(table)) & {MARK, ","}:
        raise UsageError(f"--table: {table} cannot be used in best_fit:table=FILE; use a name without {MARK} and comma")
    if table:
        check_writable(table, mark=ARRAY)
    require_jax()
    tuning = Tuning(chosen, _halves(chosen, options), options, table)
    key: Row = {"codec": chosen.codec.name, "normals": tuning.halves.held_out.name, "error": options.error}
    key |= {"parameter": options.parameter, "count": options.count, "seed": options.seed}
    return [Step(key, tuning, chosen.codec.name)]


def _write(done: Measured, _: Tick) -> None:
    """Write the lookup table, if one was tuned and requested, and print how to use the result."""
    for tuning in (step.case for step in done.steps):
        if tuning.sides:
            if tuning.table and tuning.scales is not None:
                _write_table(tuning.table, tuning.scales)
            before, after = tuning.sides
            _say_use(before, after, FIGURES[tuning.options.error], tuning.table, tuning.options.normals)


def chosen_of(name: str, options: TuneOptions) -> Chosen:
    """Return the target that an encoding's name, `--storage` and `--parameter` select. Raises UsageError if nothing
    can be tuned."""
    encoding = _one("encoding", encodings_named, (name,))
    storage = _one("storage", storages_named, options.storage)
    codec = Codec(encoding, storage)
    if not codec.fits:
        raise UsageError(f"{codec.name}: {codec.misfit}")
    check_twin(encoding)
    known = {p: p for p in (*encoding.published, *([LOOK_UP] if _has_table(codec) else []))}
    if not known:
        raise UsageError(f"{codec.name}: nothing to tune; it has no parameter and no lookup table")
    chosen = choose("parameter", options.parameter, known)
    numbers = [name for name in chosen if name in encoding.published]
    return Chosen(codec, numbers, LOOK_UP in chosen)


def _has_table(codec: Codec) -> bool:
    """Whether a codec has a lookup table that can be tuned in its storage."""
    look_up, storage = codec.encoding.look_up, codec.storage
    counts = {storage.count(i) for i in range(codec.encoding.components)}
    return bool(look_up) and storage.kind != "float" and len(counts) == 1 and counts <= set(look_up.levels)


def _one(what: str, named: Callable[[Names], list[Any]], words: Names) -> Any:
    """Return the single item that words name. Raises UsageError for an unknown name or several items.

    Args:
        what: kind of item, for messages.
        named: function that returns the items that words name.
        words: the words."""
    try:
        choices = named(words)
    except UsageError as error:
        raise UsageError(str(error).replace("known: all, ", "known: ")) from None
    if len(choices) != 1:
        raise UsageError(f"tune takes one {what}, not {len(choices)}; name one")
    return choices[0]


def _halves(chosen: Chosen, options: TuneOptions) -> Halves:
    check_seed(options.seed)
    needs_rays = chosen.codec.encoding.domain == "view"
    count = checked_count(options.count)

    def named(words: Names) -> list[NormalSet]:
        normal_sets = normal_sets_named(words, count, options.seed, options.reading, needs_rays)
        check_rays(normal_sets, needs_rays)
        return normal_sets

    return halves_of(_one("normal set", named, options.normals), options.seed, by_tiles=chosen.has_table)


def tuned_codec(codec: Codec, tuned_values: Values, scales: np.ndarray | None, table: Path | None) -> Codec:
    """Return the codec with the tuned values and lookup table, under a name that states them."""
    encoding: Encoding = codec.encoding
    changed = {name: value for name, value in tuned_values.items() if value != encoding.published[name]}
    if changed:
        encoding = encoding.with_parameters(changed)
    if scales is not None:
        encoding = encoding.with_table(scales, str(table or "FILE"))
    return replace(codec, encoding=encoding)


def _measured(codec: Codec, halves: Halves) -> Row:
    return quality.measure(quality.QualityCase(codec, halves.held_out, "jax"))


def _write_table(path: Path, scales: np.ndarray) -> None:
    with whole_file(path) as partial, partial.open("wb") as file:
        np.save(file, scales)


def rows(before: Side, after: Side, chosen: Chosen, tuned_values: Values, about: Row) -> Iterator[Row]:
    """Yield a row for each tuned parameter and for a tuned table, then a row for each figure on the held-out half."""
    codecs = {"encoding": before.codec.encoding.name, "storage": before.codec.storage.name}
    codecs |= {"tuned_encoding": after.codec.encoding.name}
    empty = TABLE.empty() | codecs | about
    for parameter in before.codec.encoding.parameters:
        if parameter.name in chosen.names:
            published, tuned = before.codec.encoding.published[parameter.name], tuned_values[parameter.name]
            yield empty | _row(parameter.name, published, tuned) | {"glsl": parameter.constant}
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
    """Return the columns `gain` and `unit`: the increase of a PSNR in dB, or the reduction of an angle in percent."""
    if figure == FIGURES["psnr"]:
        return {"gain": tuned - published if tuned != published else 0.0, "unit": "dB"}
    return {"gain": 100 * (1 - tuned / published) if published else 0.0, "unit": "%"}


def _say_use(before: Side, after: Side, figure: str, table: Path | None, normals: Names) -> None:
    gain = _gain(figure, *(side.row[figure] for side in (before, after)))
    if gain["gain"] <= NOTHING_DB:
        advice = f"no gain on the held-out half ({gain['gain']:.2g} {gain['unit']}); keep the published encoding"
    elif after.codec.encoding.look_up and not table and after.codec.encoding.tables != before.codec.encoding.tables:
        advice = "save the lookup table with --table FILE.npy to measure it elsewhere"
    else:
        names = ["--encoding", after.codec.encoding.name, "--storage", after.codec.storage.name]
        advice = (
            f"to measure it elsewhere, run: normalbench quality {command_line([*names, '--normals', text_of(normals)])}"
        )
    tell(f"{advice}")


def _summary(tuned_rows: Sequence[Row]) -> Iterator[Sheet]:
    names = (
        "encoding",
        "storage",
        "normals",
        "tuned_encoding",
        "quantity",
        "published",
        "tuned",
        "gain",
    )
    yield Sheet("tuned to one half, measured on the other", [{name: row[name] for name in names} for row in tuned_rows])


WORK = Work(steps=_steps, measure=each(lambda tuning: tuning.measured()), summary=_summary, write=_write, stays=True)
