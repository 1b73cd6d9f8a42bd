"""What `run` does."""

from __future__ import annotations

import itertools
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

from ...reports import tables
from ...reports.charts import pictures
from ..machine.doctor import machine
from ..metrics import published as seeds
from ..output.progress import progress
from ..output.writing import say, say_skipped, whole_file, write
from ..results.runs import Row, Run, Step, opened, read_run, sources, unfinished
from ..tables.cost.command import write_listings
from ..tables.quality import measure as quality
from ..tables.quality.command import write_pictures
from ..tables.quality.sphere_maps import write_maps
from ..tables.render.measure import ranked
from .report_command import IMAGES, MAPS, PAGE, write_report
from .short import SHORT
from .suite import SuiteRequest, listed_costs

RESULTS = Path("results")
# What a table needs all its rows for.
IN_ORDER = {"render": ranked}
# What the one sheet of a run shows: the seeds' methods, and the one that most people use today.
SHEET = (*seeds.PSNR_DB, "octahedral")


def run_command(request: SuiteRequest, output: Path | None) -> None:
    """The default suite into a results folder, its tables to standard output. What was stopped goes on."""
    quality.require_jax()
    steps = request.steps()
    facts: Row = {"request": asdict(request), "sources": sources(), "machine": machine()}
    facts |= {"command": sys.argv[1:], "time": time.strftime("%Y-%m-%dT%H:%M:%S%z"), "finished": False}
    folder = output or unfinished(RESULTS, facts) or _new_folder()
    with opened(folder, facts) as run:
        if run.kept:
            print(f"normalbench: {folder} goes on: {run.kept} of {len(steps)} steps are there", file=sys.stderr)
        try:
            for name, part in _by_table(steps).items():
                _show(name, _measure(run, part))
        except (KeyboardInterrupt, SystemExit):
            print(f"normalbench: {run.kept} of {len(steps)} steps are kept; the same command goes on", file=sys.stderr)
            raise
        _complete(run, request)
    done = read_run(folder)
    say(f"\nEvery figure, the pictures and the machine they come from: {folder}\n")
    say(f"All of it on one page: {write_report(folder, done, folder / PAGE)}\n")


def _by_table(steps: Sequence[Step]) -> dict[str, list[Step]]:
    found: dict[str, list[Step]] = {}
    for step in steps:
        found.setdefault(step.table, []).append(step)
    return found


def _measure(run: Run, steps: Sequence[Step]) -> list[Row]:
    """The rows of one table's steps."""
    rows: list[Row] = []
    with progress(len(steps)) as tick:
        for step in steps:
            rows += run.rows(step)
            tick(step.name)
    return rows


def _new_folder() -> Path:
    named = RESULTS / time.strftime("%Y%m%d-%H%M%S")
    others = (named.with_name(f"{named.name}-{number}") for number in itertools.count(2))
    return next(folder for folder in itertools.chain([named], others) if not folder.exists())


def _complete(run: Run, request: SuiteRequest) -> None:
    """Tables for others, and the pictures; then the run is finished."""
    done = read_run(run.folder)
    for name, rows in done.tables.items():
        _write_table(run.folder / name, IN_ORDER.get(name, list)(rows))
    if "quality" in done.tables:
        cases = request.quality_cases()
        _draw(run.folder, cases)
        write_maps((case.codec for case in cases), run.folder / MAPS)
    for family in [step["key"]["family"] for step in done.steps if step["table"] == "cost"]:
        write_listings(run.folder / "disassembly", listed_costs(family))
    run.finish()


def _write_table(path: Path, rows: list[Row]) -> None:
    for suffix, written in ((".json", tables.to_json), (".csv", tables.to_csv)):
        with whole_file(path.with_suffix(suffix)) as partial:
            partial.write_text(written(rows), encoding="utf-8")
    if tables.has_parquet():
        with whole_file(path.with_suffix(".parquet")) as partial:
            tables.write_parquet(rows, partial)


def _draw(folder: Path, cases: Sequence[quality.Case]) -> None:
    drawn = write_pictures(cases, folder / IMAGES)
    for case in {case.normal_set.name: case for case in cases if case.normal_set.shape}.values():
        trip = quality.image_round_trip(replace(case, backend="jax"))
        with whole_file(folder / IMAGES / f"{case.normal_set.name}-normals.png") as partial:
            pictures.write_png(partial, pictures.normals_picture(trip.normals, trip.covered))
    sheet = {
        codec.encoding.name: four
        for (normals, codec), four in drawn.items()
        if (normals, codec.storage.name) == (seeds.NORMALS, seeds.STORAGE) and codec.encoding.name in SHEET
    }
    with whole_file(folder / f"{seeds.NORMALS}-{seeds.STORAGE}.png") as partial:
        pictures.write_png(partial, pictures.contact_sheet(sheet))


def _show(name: str, rows: list[Row]) -> None:
    """A table in short, to standard output, as soon as it is measured."""
    say_skipped(rows)
    for title, part, expendable in SHORT[name](rows):
        say(f"\n{title}\n\n")
        write(part, "table", None, expendable)
