"""How the quality table is measured and shown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.codecs.codec import Codec
from ....reports.charts import charts, pictures
from ....reports.charts.drawings import Drawing
from ...codecs.names import check_twin, codecs_named, fitting
from ...machine.devices import require_device, require_jax
from ...metrics import published
from ...normals.normal_names import normal_sets_named
from ...options.counts import check_seed, checked_count
from ...output.errors import UsageError, leave_out, pick
from ...output.writing import check_folder, whole_file, without
from ..charts import having, one_backend
from ..table import Measured, Row, Sheet, Step, Tick, Work
from . import measure
from .order import ONCE, in_order, with_limits
from .sphere_maps import write_maps
from .table import TABLE, QualityOptions, QualityOutputs

# A largest angle this much above the supremum is float32's doing.
BY_ARITHMETIC = 1.05
# What a short summary leaves out first.
SUMMARY_DROPS = ("p99", "psnr_db_glsl", "mean")


def cases(options: QualityOptions) -> list[measure.Case]:
    """One case for each row. Codecs that do not fit are named on standard error.

    Raises:
        UsageError: unknown names, or nothing that fits.
        MissingError: only GLSL is asked for and there is no GL device.
    """
    count = checked_count(options.count)
    check_seed(options.seed)
    codecs = codecs_named(options.encoding, options.storage, options.rounding)
    backends = pick("back end", options.backend, {name: name for name in measure.BACKENDS})
    codecs, left_out = fitting(codecs)
    require_jax()
    if backends == ["glsl"]:
        require_device()
    for encoding in dict.fromkeys(codec.encoding for codec in codecs):
        check_twin(encoding)
    for line in left_out:
        leave_out(line)
    needs_rays = any(codec.encoding.domain == "view" for codec in codecs)
    normal_sets = normal_sets_named(options.normals, count, options.seed, options.reading, needs_rays)
    return measure.cases(codecs, normal_sets, backends, options.worst_case, options.codes)


def steps(options: QualityOptions, outputs: QualityOutputs) -> list[Step]:
    """A step for each row."""
    made = [Step(_key(case, options), case, case.name, len(case.normal_set.starts)) for case in cases(options)]
    for folder in filter(None, (outputs.images, outputs.maps)):
        check_folder(folder)
    return made


def _check(outputs: QualityOutputs, made: Sequence[Step]) -> None:
    if outputs.images and not any(step.case.normal_set.shape for step in made):
        raise UsageError(f"--images needs a normal set that is an image: {published.NORMALS}, or a file of one")


def _key(case: measure.Case, options: QualityOptions) -> Row:
    codec, chosen = case.codec, case.normal_set
    key: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "rounding": codec.rounding}
    key |= {"normals": chosen.name, "backend": case.backend, "count": chosen.count, "seed": chosen.seed}
    asked = {name: getattr(options, name) for name in ("worst_case", "codes")}
    return key | {name: True for name, is_asked in asked.items() if is_asked}


def _measure(chosen: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
    for row in measure.rows((step.case for step in chosen), lambda case: tick(case.name)):
        yield [row]


def _warnings(rows: Sequence[Row]) -> Iterator[str]:
    for row in rows:
        if row["invalid"]:
            yield f"{_named(row)}: {row['invalid']} decodes are NaN or infinite"
        if row["angle_sup_deg"] is not None and row["angle_max_deg"] > BY_ARITHMETIC * row["angle_sup_deg"]:
            said = f"{row['angle_max_deg']:.3g} degrees were met, {row['angle_sup_deg']:.3g} are the supremum of exact"
            yield f"{_named(row)}: {said} arithmetic; float32 loses the rest, at {row['worst_normal']}"


def _failures(rows: Sequence[Row]) -> Iterator[str]:
    """Rows whose errors are smaller than this many codes can have: then the measurement is wrong."""
    for row in rows:
        if row["below_limit"]:
            wrong = f"{row['codes']} codes cannot do that: the measurement is wrong, or the set is not uniform"
            yield f"{_named(row)}: {row['below_limit']}; {wrong}"


def _named(row: Row) -> str:
    return f"{row['encoding']}/{row['storage']} on {row['normals']} by {row['backend']}"


def _shown(done: Measured) -> Iterator[Sheet]:
    rows = TABLE.without_hidden(without(with_limits(done.rows), ONCE))
    yield Sheet("", rows, TABLE.drops(rows))


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        groups.setdefault((row["normals"], row["storage"]), []).append(row)
    for (normals, storage), part in groups.items():
        title = f"{normals}, {storage}: dB by back end; angles in degrees, by {part[0]['backend']}"
        yield Sheet(title, beside(part), SUMMARY_DROPS)


def beside(rows: Iterable[Row]) -> list[Row]:
    """One line for each encoding: its back ends beside each other, and the article's figure where it has one."""
    lines: dict[str, Row] = {}
    for row in rows:
        name = row["encoding"] + ("" if row["rounding"] == "nearest" else f" {row['rounding']}")
        line = lines.setdefault(name, {"encoding": name, "bits": row["bits"]})
        if row["normals"] == published.NORMALS and row["storage"] == published.STORAGE:
            line["article_db"] = published.PSNR_DB.get(row["encoding"])
        line |= {f"{column}_{row['backend']}": row[column] for column in ("psnr_article_db", "psnr_db")}
        if row["angle_mean_deg"] is not None and "mean" not in line:
            chosen = ("angle_mean_deg", "angle_p99_deg", "angle_max_deg", "effective_bits")
            line |= {column.removeprefix("angle_").removesuffix("_deg"): row[column] for column in chosen}
    first = ("encoding", "bits", "article_db")
    found = dict.fromkeys(column for line in lines.values() for column in line)
    order = [c for c in first if c in found] + sorted((c for c in found if c.startswith("psnr")), key=_psnr_order)
    order += [column for column in found if column not in order]
    return [{column: line.get(column) for column in order} for line in lines.values()]


def _psnr_order(column: str) -> tuple[bool, bool]:
    """The article's measure before the plain one, JAX before GLSL."""
    return "article" not in column, "glsl" in column


def _round_trip(case: measure.Case) -> measure.RoundTrip | None:
    """By the case's back end, or by JAX; None where neither can."""
    for backend in dict.fromkeys((case.backend, "jax")):
        with suppress(*measure.UNMEASURABLE):
            return measure.image_round_trip(replace(case, backend=backend))
    return None


Pictures = dict[tuple[str, Codec], dict[str, np.ndarray]]


def _write(done: Measured, _: Tick) -> None:
    if done.outputs.images:
        chosen = [step.case for step in done.steps]
        drawn = write_pictures(chosen, done.outputs.images)
        _write_originals(chosen, done.outputs.images)
        _write_sheet(drawn, done.outputs.images)
    if done.outputs.maps:
        write_maps((step.case.codec for step in done.steps), done.outputs.maps)


def write_pictures(chosen: Iterable[measure.Case], folder: Path) -> Pictures:
    """Four PNG files for each codec on each image set, drawn by GLSL where that was asked for and can be had.

    Returns:
        the pictures, by normal set and codec.
    """
    wanted = {(c.normal_set.name, c.codec): c for c in sorted(chosen, key=lambda c: c.backend, reverse=True)}
    drawn: Pictures = {}
    for (normals, codec), case in wanted.items():
        if not case.normal_set.shape:
            continue
        trip = _round_trip(case)
        if not trip:
            continue
        four = pictures.codec_pictures(trip.normals, trip.encoded, trip.decoded, trip.covered)
        for kind, pixels in four.items():
            _write_png(folder / f"{normals}-{codec.name.replace('/', '-')}-{kind}.png", pixels)
        drawn[(normals, codec)] = four
    return drawn


def _write_png(path: Path, pixels: np.ndarray) -> None:
    with whole_file(path) as partial:
        pictures.write_png(partial, pixels)


def _write_originals(chosen: Sequence[measure.Case], folder: Path) -> None:
    """The normals as they are, of each set that is an image."""
    for case in {case.normal_set.name: case for case in chosen if case.normal_set.shape}.values():
        n, covered = measure.image_of(case.normal_set)
        _write_png(folder / f"{case.normal_set.name}-normals.png", pictures.normals_picture(n, covered))


def _write_sheet(drawn: Pictures, folder: Path) -> None:
    """One picture of the article's methods, where they were measured as the article did."""
    sheet = {
        codec.encoding.name: four
        for (normals, codec), four in drawn.items()
        if (normals, codec.storage.name) == (published.NORMALS, published.STORAGE)
        and codec.encoding.name in published.PICTURED
    }
    if len(sheet) == len(published.PICTURED):
        _write_png(folder / f"{published.NORMALS}-{published.STORAGE}.png", pictures.contact_sheet(sheet))


def histograms(_: Any, rows: Sequence[Row]) -> Iterator[Drawing]:
    """A chart for each set of normals; none where rows keep no histogram."""
    usable = [r for r in having(rows, "bits", "angle_mean_deg") if charts.bins(r.get("angle_counts"))]
    for at, normals in enumerate(dict.fromkeys(str(row.get("normals")) for row in usable)):
        part = one_backend([row for row in usable if str(row.get("normals")) == normals])
        title = f"Angles on {normals}, by {part[0].get('backend')}"
        said = "The share of normals over their angle in degrees, on a logarithmic scale, each codec as high as the "
        said += "others; the best mean on top. The figures are in the tables of what normals lose."
        yield Drawing(f"angles-{at}", title, said, partial(charts.histogram_chart, part))


def _worst(step: Step) -> Any:
    return measure.worst(step.case)


WORK = Work(
    steps=steps,
    check=_check,
    measure=_measure,
    finish=in_order,
    shown=_shown,
    summary=_summary,
    warnings=_warnings,
    failures=_failures,
    drawings=histograms,
    write=_write,
    worst=_worst,
)
