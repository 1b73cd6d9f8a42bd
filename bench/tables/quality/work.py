"""Measurement and display of the quality table."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from ....encodings.codecs.codec import Codec
from ....encodings.storages.storage import DITHERED, ROUNDINGS_AND_DITHERED
from ....reports.page.verdict import counted_set
from ....reports.tables import text_of
from ...ground.machine.devices import require_device, require_jax
from ...ground.machine.systems.people import LAST_OPENGL
from ...ground.options.counts import check_seed, checked_count
from ...ground.options.targets import not_with_noise, what_is_left, without_noise
from ...ground.output.errors import UsageError, lacks_twin, leave_out, names_by_reason, tell
from ...ground.output.writing import check_folder, without
from ...measures.metrics import published
from ...subjects.codecs.names import check_twin, codecs_named, fitting
from ...subjects.names.backends import backends_named
from ...subjects.normals.normal_names import lacking_rays, normal_sets_named
from ..charts import backends_of, having, one_backend
from ..table import BACKENDS_NEED, C_COMPILER, PART, Measured, Row, Sheet, Step, Tick, Work
from ..verdicts import by_bits
from . import measure
from .charts import charts
from .extras import extras
from .half import survivors, with_half_loss
from .order import ONCE, in_order, with_limits
from .packed import best_columns
from .sphere_maps import write_maps
from .table import TABLE, QualityOptions, QualityOutputs

# A largest angle this much above the supremum is float32's doing.
BY_ARITHMETIC = 1.05
# What a short summary leaves out first.
SUMMARY_DROPS = ("p99", "psnr_db_glsl", "mean")
# The figures that a summary shows of every back end.
BY_BACKEND = ("psnr_article_db", "psnr_db")
# Of their names, what marks the article's: it rounds to 8 bits, so what is more exact has none.
ARTICLE = "psnr_article"
# How many rows without figures a line names.
MOST_NAMED = 4
AGREED = "dB, the same with JAX and GLSL"
# The word among normal sets that stands for those of a code's domain.
DOMAIN = "domain"
EXACT = ("--worst-case", "--codes")
OF_SPHERE, OF_HALF = ("sphere", "axes"), ("hemisphere",)


def cases(options: QualityOptions) -> list[measure.QualityCase]:
    """Return a case for each row; codecs that do not fit their storage are named on standard error.

    Raises:
        UsageError: unknown names, or no codec that fits.
        MissingError: only GLSL is requested and there is no OpenGL device.
    """
    count = checked_count(options.count)
    check_seed(options.seed)
    codecs = codecs_named(
        options.encoding, options.storage, options.rounding, options.arithmetic, ROUNDINGS_AND_DITHERED
    )
    backends = backends_named(options.backend, measure.BACKENDS)
    codecs, left_out = fitting(codecs)
    if LAST_OPENGL and not any(codec.is_dithered for codec in codecs):
        backends = _as_wgsl(backends)
    if reason := _not_of_noise(options, backends):
        codecs = without_noise(codecs, reason)
    require_jax()
    if backends == ["glsl"]:
        require_device()
    for encoding in dict.fromkeys(codec.encoding for codec in codecs):
        check_twin(encoding)
    for line in left_out:
        leave_out(line)
    needs_rays = any(codec.encoding.domain == "view" for codec in codecs)
    words = [*map(str, options.normals)]
    names = options.normals
    if DOMAIN in words:
        names = tuple(dict.fromkeys(name for codec in codecs for name in _set_names(words, codec)))
    normal_sets = normal_sets_named(names, count, options.seed, options.reading, needs_rays)
    all_cases = measure.cases(codecs, normal_sets, backends, options.worst_case, options.codes)
    asked = [case for case in all_cases if _is_asked(case, words)]
    lacking = lacking_rays((case.codec.encoding, case.normal_set) for case in asked)
    return what_is_left([case for case in asked if case.normal_set.serves(case.codec.encoding)], lacking)


def _as_wgsl(backends: Sequence[str]) -> list[str]:
    """Return the backends with "wgsl" in place of "glsl", and print the reason: the system's OpenGL is too old."""
    if "glsl" in backends:
        tell(f"shaders run as WGSL instead of GLSL, because this system supports OpenGL only up to {LAST_OPENGL}")
    return list(dict.fromkeys("wgsl" if name == "glsl" else name for name in backends))


def _not_of_noise(options: QualityOptions, backends: Sequence[str]) -> str:
    """Return the reason why dithered codecs cannot be measured as requested; empty if they can."""
    exact = [option for option, is_asked in zip(EXACT, (options.worst_case, options.codes), strict=True) if is_asked]
    if exact:
        return not_with_noise(exact[0])
    return f"--rounding {DITHERED} cannot be used with WGSL; use --backend jax,glsl" if "wgsl" in backends else ""


def _set_names(words: Sequence[str], codec: Codec) -> Iterator[str]:
    """Yield the normal sets that words name for a codec: `domain` stands for the sets of the encoding's domain."""
    for word in words:
        yield from (OF_SPHERE if codec.encoding.domain == "sphere" else OF_HALF) if word == DOMAIN else (word,)


def _is_asked(case: measure.QualityCase, words: Sequence[str]) -> bool:
    """Whether words request the set of a case: the word `domain` requests it only for encodings of that domain."""
    name = case.normal_set.name
    return DOMAIN not in words or name not in OF_SPHERE + OF_HALF or name in _set_names(words, case.codec)


def steps(options: QualityOptions, outputs: QualityOutputs) -> list[Step]:
    """Return a step for each row. Raises UsageError, also if an output folder cannot be written to."""
    row_steps = [_step(case, _key(case, options)) for case in cases(options)]
    for folder in filter(None, (outputs.images, outputs.maps, outputs.live)):
        check_folder(folder)
    return row_steps


def _step(case: measure.QualityCase, key: Row) -> Step:
    own = case.parts()
    parts = [_step(part, key | {PART: f"{number} of {len(own)}"}) for number, part in enumerate(own, 1)]
    return Step(key, case, case.name, len(case.normal_set.starts), parts)


def _check(outputs: QualityOutputs, all_steps: Sequence[Step]) -> None:
    if outputs.images and not any(step.case.normal_set.shape for step in all_steps):
        raise UsageError(f"--images requires a normal set that is an image; use {published.NORMALS} or an image file")


def _key(case: measure.QualityCase, options: QualityOptions) -> Row:
    codec, chosen = case.codec, case.normal_set
    key: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "rounding": codec.rounding}
    key |= {"normals": chosen.name, "backend": case.backend, "count": chosen.count, "seed": chosen.seed}
    asked = {name: getattr(options, name) for name in ("worst_case", "codes")}
    return key | {name: True for name, is_asked in asked.items() if is_asked}


def _measure(chosen: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
    cases_chosen = [step.case for step in chosen]
    for case, row in zip(cases_chosen, measure.rows(cases_chosen, lambda case: tick(case.name)), strict=True):
        yield [row | best_columns(case.codec)]
    measure.tell_by_xla(cases_chosen)


def _finished(rows: Sequence[Row]) -> list[Row]:
    return in_order(with_half_loss(rows))


def _warnings(rows: Sequence[Row]) -> Iterator[str]:
    for row in rows:
        if row["angle_sup_deg"] is not None and row["angle_max_deg"] > BY_ARITHMETIC * row["angle_sup_deg"]:
            comparison = (
                f"{row['angle_max_deg']:.3g} degrees sampled; the supremum is {row['angle_sup_deg']:.3g} in exact"
            )
            yield f"{_named(row)}: {comparison} arithmetic; the rest is the error of float32, at {row['worst_normal']}"


def _failures(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a line for each row whose errors are below the limit for its number of codes, which is impossible."""
    for row in rows:
        if row["below_limit"]:
            wrong = f"{row['codes']} codes cannot be that accurate: the measurement is wrong, or the set is not uniform"
            yield f"{_named(row)}: {row['below_limit']}; {wrong}"


def _named(row: Row, reason: str = "") -> str:
    where = "" if lacks_twin(reason) else f" by {row['backend']}"
    return f"{row['encoding']}/{row['storage']} on {row['normals']}{where}"


def _shown(done: Measured) -> Iterator[Sheet]:
    measured = [row for row in done.rows if not row["skipped"]]
    notes = _not_shown(done.rows) if measured else ()
    rows = TABLE.without_hidden(without(with_limits(measured or done.rows), ONCE))
    yield Sheet("", rows, TABLE.drops(rows), notes=(*survivors(done.rows), *notes))


def _not_shown(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a line for each reason why rows have no figures, with the names or the number of the rows."""
    skipped = ((_named(row, row["skipped"]), row["skipped"]) for row in rows if row["skipped"])
    for reason, names in names_by_reason(skipped).items():
        listed = ", ".join(names) if len(names) <= MOST_NAMED else f"{len(names)} rows"
        what = "by OpenGL alone" if lacks_twin(reason) else "not shown, because they have no figures"
        yield f"{what}: {listed} ({reason})"


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    measured = one_backend(having(rows, "bits", "angle_rms_deg"))
    for normals in dict.fromkeys(row["normals"] for row in measured):
        part = [row for row in measured if row["normals"] == normals]
        best = by_bits(part, "angle_mean_deg", lambda row: f"{row['angle_mean_deg']:.2g}°")
        yield f"Most accurate on {normals}, by mean error: {best}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    measured = [row for row in rows if not row.get("skipped")]
    # A row without figures has no count; it stands with the others of its set, and makes no sheet.
    groups: dict[tuple[str, str], list[Row]] = {_sheet_of(row, measured): [] for row in measured}
    for row in rows:
        groups.get(_sheet_of(row, measured), []).append(row)
    for (normals, storage), part in groups.items():
        lines = beside(part)
        agreement = "dB by backend" if any(f"psnr_db_{part[0]['backend']}" in line for line in lines) else AGREED
        measured = backends_of(one_backend([row for row in part if row["angle_mean_deg"] is not None]))
        title = f"{normals}, {storage}: {agreement}; angles in degrees" + (f", by {measured}" if measured else "")
        yield Sheet(title, lines, SUMMARY_DROPS, keys={"storage": storage, "normals": normals})


def _sheet_of(row: Row, measured: Sequence[Row]) -> tuple[str, str]:
    return counted_set(row, measured), row["storage"]


def beside(rows: Iterable[Row]) -> list[Row]:
    """Return one row for each encoding: the article's figure if there is one, and a column for each backend, or a
    single column if the backends agree in every digit shown. The article's PSNR is left out if it is infinite for any
    encoding."""
    lines: dict[str, Row] = {}
    for row in rows:
        name = row["encoding"] + ("" if row["rounding"] == "nearest" else f" {row['rounding']}")
        line = lines.setdefault(name, {"encoding": name, "bits": row["bits"]})
        if row["normals"] == published.NORMALS and row["storage"] == published.STORAGE:
            line["article_db"] = published.PSNR_DB.get(row["encoding"])
        line |= {f"{column}_{row['backend']}": row[column] for column in BY_BACKEND}
        if row["angle_mean_deg"] is not None and "mean" not in line:
            chosen = ("angle_mean_deg", "angle_p99_deg", "angle_max_deg", "effective_bits")
            line |= {column.removeprefix("angle_").removesuffix("_deg"): row[column] for column in chosen}
    for column in BY_BACKEND:
        _merge(column, list(lines.values()))
    first = ("encoding", "bits", "article_db")
    columns = dict.fromkeys(column for line in lines.values() for column in line)
    order = [c for c in first if c in columns] + sorted((c for c in columns if c.startswith("psnr")), key=_psnr_order)
    order += [column for column in columns if column not in order]
    kept = [column for column in order if not (ARTICLE in column and _is_beyond(column, lines.values()))]
    return [{column: line.get(column) for column in kept} for line in lines.values()]


def _is_beyond(column: str, lines: Iterable[Row]) -> bool:
    """Whether a column is infinite for any encoding, so that it cannot compare them."""
    return any(line.get(column) == math.inf for line in lines)


def _merge(column: str, lines: Sequence[Row]) -> None:
    """Merge a column's figures from several backends into one column if they agree in every digit shown."""
    names = list(dict.fromkeys(name for line in lines for name in line if name.startswith(f"{column}_")))
    known = all(line.get(name) is not None for line in lines for name in names)
    if len(names) > 1 and known and all(len({text_of(line[name]) for name in names}) == 1 for line in lines):
        for line in lines:
            same = [line.pop(name) for name in names]
            line[column] = same[0]


def _psnr_order(column: str) -> tuple[bool, bool]:
    """Return the sort key of a PSNR column: the article's measure before the plain PSNR, JAX before GLSL."""
    return ARTICLE not in column, "glsl" in column


def _write(done: Measured, _: Tick) -> None:
    # Pictures, and what writes GLSL ES, are imported where they are asked for.
    if done.outputs.images:
        from . import pictures

        pictures.write([step.case for step in done.steps], done.outputs.images)
    if done.outputs.maps:
        write_maps((step.case.codec for step in done.steps), done.outputs.maps)
    if done.outputs.live:
        from ...measures.live.kept import write_live
        from . import pictures

        write_live((step.case.codec for step in done.steps), done.outputs.live)
        pictures.write_scenes([step.case for step in done.steps], done.outputs.live)


def _subjects(folder: Path, rows: Sequence[Row]) -> Iterator[Any]:
    from . import pictures

    return pictures.subjects(folder, rows)


def _worst(step: Step) -> Any:
    return measure.worst(step.case)


def _needs(step: Step) -> frozenset[str]:
    backend = step.key["backend"]
    return BACKENDS_NEED[backend] | ({C_COMPILER} if backend == "jax" else set())


WORK = Work(
    extras=extras,
    steps=steps,
    check=_check,
    measure=_measure,
    merge=lambda step, rows: [measure.merged(step.case, rows) | best_columns(step.case.codec)],
    finish=_finished,
    shown=_shown,
    verdict=_verdict,
    summary=_summary,
    warnings=_warnings,
    failures=_failures,
    charts=charts,
    write=_write,
    subjects=_subjects,
    worst=_worst,
    needs=_needs,
)
