"""What the measuring commands do."""

from __future__ import annotations

import itertools
import json
import sys
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..encodings.catalogue import ENCODINGS
from ..encodings.codec import Codec
from ..encodings.storage import ROUNDINGS, STORAGES
from ..reports import pictures, tables
from . import quality, seeds
from .counts import checked_count
from .doctor import machine
from .errors import UsageError, pick
from .normal_sets import NORMAL_SETS
from .output import check_folder, check_writable, say, whole_file, whole_folder, write
from .progress import progress

# What a narrow terminal goes without, the first first.
EXPENDABLE = ("device", "rounded_by", "mse", "angle_rms_deg", "count", "angle_p99_deg")
# What the one sheet of a run shows: the seeds' methods, and the one that most people use today.
SHEET = (*seeds.PSNR_DB, "octahedral")

Pictures = dict[tuple[str, Codec], dict[str, np.ndarray]]


@dataclass(frozen=True)
class Request:
    """What to measure, as typed: comma-separated names."""

    encoding: str
    storage: str
    rounding: str
    normals: str
    backend: str
    count: int
    seed: int

    def cases(self) -> list[quality.Case]:
        """One case for each row. Raises UsageError for unknown names, and MissingError where only GLSL is asked for
        and there is no GL device. Codecs that do not fit are named on standard error."""
        count = checked_count(self.count)
        if self.seed < 0:
            raise UsageError(f"--seed {self.seed}: a seed is 0 or more")
        codecs = [
            Codec(encoding, storage, rounding)
            for storage in pick("storage", self.storage, STORAGES)
            for rounding in pick("rounding", self.rounding, dict(zip(ROUNDINGS, ROUNDINGS, strict=True)))
            for encoding in pick("encoding", self.encoding, ENCODINGS)
        ]
        makers = pick("normal set", self.normals, NORMAL_SETS)
        backends = pick("back end", self.backend, {name: name for name in quality.BACKENDS})
        codecs, left_out = quality.fitting(codecs)
        quality.require_jax()
        if backends == ["glsl"]:
            quality.require_device()
        for encoding in {codec.encoding for codec in codecs}:
            quality.check_twin(encoding)
        for line in left_out:
            print(f"normalbench: left out: {line}", file=sys.stderr)
        return quality.cases(codecs, [make(count, self.seed) for make in makers], backends)


def _measured(cases: Sequence[quality.Case]) -> list[quality.Row]:
    with progress(sum(len(case.normal_set.starts) for case in cases)) as tick:
        rows = list(quality.rows(cases, lambda case: tick(case.name)))
    for reason in dict.fromkeys(row["skipped"] for row in rows if row["skipped"]):
        if all(row["skipped"] for row in rows):
            raise UsageError(reason)
        print(f"normalbench: rows without figures: {' '.join(reason.split())}", file=sys.stderr)
    for row in rows:
        if row["invalid"]:
            what = f"{row['encoding']}/{row['storage']} on {row['normals']} by {row['backend']}"
            print(f"normalbench: {what}: {row['invalid']} decodes are no number", file=sys.stderr)
    return rows


def quality_command(request: Request, images: Path | None, format: str, output: Path | None) -> None:
    """Measure, write the pictures if asked for, then the rows."""
    cases = request.cases()
    if images and not any(case.normal_set.shape for case in cases):
        raise UsageError(f"--images needs a normal set that is an image: {seeds.NORMALS}")
    if images:
        check_folder(images)
    if output:
        check_writable(output)
    rows = _measured(cases)
    if images:
        write_pictures(cases, images)
    if format == "table":
        # Infinity is shown as such, and why a row is empty or has odd figures has been said.
        hidden = ("exact", "skipped", "invalid")
        rows = [{column: value for column, value in row.items() if column not in hidden} for row in rows]
    write(rows, format, output, EXPENDABLE)


def _round_trip(case: quality.Case) -> quality.RoundTrip:
    try:
        return quality.image_round_trip(case)
    except quality.UNMEASURABLE:
        return quality.image_round_trip(replace(case, backend="jax"))


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
        four = pictures.codec_pictures(trip.normals, trip.encoded, trip.decoded, trip.covered)
        for kind, pixels in four.items():
            path = folder / f"{normals}-{codec.name.replace('/', '-')}-{kind}.png"
            with whole_file(path) as partial:
                pictures.write_png(partial, pixels)
        drawn[(normals, codec)] = four
    return drawn


def run_command(count: int, seed: int, output: Path | None) -> None:
    """The default suite into a results folder, its table to standard output."""
    folder = output or _new_folder()
    wide = Request("all", "rgba8", "nearest", "playground,hemisphere", "jax,glsl", count, seed)
    two = ",".join(name for name, encoding in ENCODINGS.items() if encoding.components == 2)
    half = replace(wide, encoding=two, storage="rg16f")
    with whole_folder(folder) as partial:
        cases = [*wide.cases(), *half.cases()]
        rows = _measured(cases)
        _write_results(partial, cases, rows)
    for (normals, storage), part in _grouped(rows):
        say(f"\n{normals}, {storage}: dB by back end; angles in degrees, by {part[0]['backend']}\n")
        write(beside(part), "table", None, ("p99", "psnr_db_glsl", "mean"))
    say(f"\nEvery figure, the pictures and the machine they come from: {folder}\n")


def _new_folder() -> Path:
    named = Path("results") / time.strftime("%Y%m%d-%H%M%S")
    others = (named.with_name(f"{named.name}-{number}") for number in itertools.count(2))
    return next(folder for folder in itertools.chain([named], others) if not folder.exists())


def _grouped(rows: Iterable[quality.Row]) -> Iterator[tuple[tuple[str, str], list[quality.Row]]]:
    parts: dict[tuple[str, str], list[quality.Row]] = {}
    for row in rows:
        parts.setdefault((row["normals"], row["storage"]), []).append(row)
    yield from parts.items()


def beside(rows: Iterable[quality.Row]) -> list[quality.Row]:
    """One line for each codec, its back ends beside each other, and the seeds' own figure where they have one."""
    lines: dict[str, quality.Row] = {}
    for row in rows:
        line = lines.setdefault(row["encoding"], {"encoding": row["encoding"], "bits": row["bits"]})
        if row["normals"] == seeds.NORMALS and row["storage"] == seeds.STORAGE:
            line["article_db"] = seeds.PSNR_DB.get(row["encoding"])
        line |= {f"{column}_{row['backend']}": row[column] for column in ("psnr_seed_db", "psnr_db")}
        if row["angle_mean_deg"] is not None and "mean" not in line:
            shown = ("angle_mean_deg", "angle_p99_deg", "angle_max_deg", "effective_bits")
            line |= {column.removeprefix("angle_").removesuffix("_deg"): row[column] for column in shown}
    first = ("encoding", "bits", "article_db")
    found = dict.fromkeys(column for line in lines.values() for column in line)
    order = [column for column in first if column in found] + sorted(c for c in found if c.startswith("psnr"))[::-1]
    order += [column for column in found if column not in order]
    return [{column: line.get(column) for column in order} for line in lines.values()]


def _write_results(folder: Path, cases: Sequence[quality.Case], rows: list[quality.Row]) -> None:
    (folder / "quality.json").write_text(tables.to_json(rows), encoding="utf-8")
    (folder / "quality.csv").write_text(tables.to_csv(rows), encoding="utf-8")
    facts = {**machine(), "command": sys.argv[1:], "time": time.strftime("%Y-%m-%dT%H:%M:%S%z")}
    (folder / "machine.json").write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
    (folder / "images").mkdir()
    drawn = write_pictures(cases, folder / "images")
    sheet = {
        codec.encoding.name: four
        for (normals, codec), four in drawn.items()
        if (normals, codec.storage.name) == (seeds.NORMALS, seeds.STORAGE) and codec.encoding.name in SHEET
    }
    pictures.write_png(folder / f"{seeds.NORMALS}-{seeds.STORAGE}.png", pictures.contact_sheet(sheet))
