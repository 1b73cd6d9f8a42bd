"""What the measuring commands do."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....encodings.codecs.codec import Codec
from ....reports.charts import pictures
from ...metrics import published as seeds
from ...normals.normal_names import normal_sets_named
from ...options.counts import check_seed, checked_count
from ...options.option import AS_USUAL, QualityOptions, Reading
from ...output.errors import UsageError, pick
from ...output.progress import progress
from ...output.writing import check_folder, check_writable, say_skipped, whole_file, without, write
from . import measure as quality
from .order import ONCE, in_order, with_limits

# What a narrow terminal goes without, the first first.
EXPENDABLE = (
    *("device", "rounded_by", "background", "not_finite", "reached_mean_percent", "reached_max_percent", "domain"),
    *("mse", "sup_z", "sup_y", "sup_x", "angle_rms_deg", "count", "angle_p99_deg"),
)
# What the one sheet of a run shows: the seeds' methods, and the one that most people use today.
SHEET = (*seeds.PSNR_DB, "octahedral")

Pictures = dict[tuple[str, Codec], dict[str, np.ndarray]]


@dataclass(frozen=True, kw_only=True)
class Request(QualityOptions):
    """What to measure, as typed: comma-separated names."""

    reading: Reading = AS_USUAL
    worst_case: bool = False
    codes: bool = False

    def cases(self) -> list[quality.Case]:
        """One case for each row. Raises UsageError for unknown names, and MissingError where only GLSL is asked for
        and there is no GL device. Codecs that do not fit are named on standard error."""
        count = checked_count(self.count)
        check_seed(self.seed)
        codecs = quality.codecs_named(self.encoding, self.storage, self.rounding)
        backends = pick("back end", self.backend, {name: name for name in quality.BACKENDS})
        codecs, left_out = quality.fitting(codecs)
        quality.require_jax()
        if backends == ["glsl"]:
            quality.require_device()
        for encoding in {codec.encoding for codec in codecs}:
            quality.check_twin(encoding)
        for line in left_out:
            print(f"normalbench: left out: {line}", file=sys.stderr)
        needs_rays = any(codec.encoding.domain == "view" for codec in codecs)
        normal_sets = normal_sets_named(self.normals, count, self.seed, self.reading, needs_rays)
        return quality.cases(codecs, normal_sets, backends, self.worst_case, self.codes)


def _measured(cases: Sequence[quality.Case]) -> list[quality.Row]:
    with progress(sum(len(case.normal_set.starts) for case in cases)) as tick:
        rows = list(quality.rows(cases, lambda case: tick(case.name)))
    say_skipped(rows)
    for row in rows:
        if row["invalid"]:
            what = f"{row['encoding']}/{row['storage']} on {row['normals']} by {row['backend']}"
            print(f"normalbench: {what}: {row['invalid']} decodes are no number", file=sys.stderr)
    return rows


def quality_command(request: Request, images: Path | None, format: str, output: Path | None) -> int:
    """Measure, write the pictures if asked for, then the rows. Exit status 1 where one is below its limit."""
    cases = request.cases()
    if images and not any(case.normal_set.shape for case in cases):
        raise UsageError(f"--images needs a normal set that is an image: {seeds.NORMALS}, or a file of one")
    if images:
        check_folder(images)
    if output:
        check_writable(output)
    rows = in_order(_measured(cases))
    below = say_below_limit(rows)
    if images:
        write_pictures(cases, images)
    if format in ("table", "markdown"):
        rows = without(with_limits(rows), ONCE)
    if format == "table":
        # Infinity is shown as such, and why a row is empty or has odd figures has been said.
        rows = without(rows, ("exact", "skipped", "invalid"))
    if format in ("table", "markdown"):
        rows = without(rows, quality.FOR_PROGRAMS)
    write(rows, format, output, EXPENDABLE)
    return 1 if below else 0


def say_below_limit(rows: Iterable[quality.Row]) -> bool:
    """Whether errors are smaller than so many codes can have, which is said of each row: then the measure is wrong."""
    below = [row for row in rows if row["below_limit"]]
    for row in below:
        what = f"{row['encoding']}/{row['storage']} on {row['normals']} by {row['backend']}"
        wrong = f"{row['codes']} codes cannot do that: the measure is wrong, or the set not uniform"
        print(f"normalbench: {what}: {row['below_limit']}; {wrong}", file=sys.stderr)
    return bool(below)


def _round_trip(case: quality.Case) -> quality.RoundTrip | None:
    """By the case's back end, or by JAX; None where neither can."""
    for backend in dict.fromkeys((case.backend, "jax")):
        with suppress(*quality.UNMEASURABLE):
            return quality.image_round_trip(replace(case, backend=backend))
    return None


def write_pictures(cases: Iterable[quality.Case], folder: Path) -> Pictures:
    """Four PNG files for each codec on each image set, drawn by GLSL where that was asked for and can be had.

    Returns:
        the pictures, by normal set and codec.
    """
    chosen = {(c.normal_set.name, c.codec): c for c in sorted(cases, key=lambda c: c.backend, reverse=True)}
    drawn: Pictures = {}
    for (normals, codec), case in chosen.items():
        if not case.normal_set.shape:
            continue
        trip = _round_trip(case)
        if not trip:
            continue
        four = pictures.codec_pictures(trip.normals, trip.encoded, trip.decoded, trip.covered)
        for kind, pixels in four.items():
            path = folder / f"{normals}-{codec.name.replace('/', '-')}-{kind}.png"
            with whole_file(path) as partial:
                pictures.write_png(partial, pixels)
        drawn[(normals, codec)] = four
    return drawn
