"""The `report` command: a run's page, its charts as files, or a text for a pull request."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...encodings.catalogue import ENCODINGS
from ...reports.charts import drawings, wire
from ...reports.page import embedded, markdown, page
from ...reports.page.found import Found, plain_text
from ...reports.page.live import Live
from ...reports.page.pixels import Subject, film_uri
from ...reports.page.sections import TableSection, answered_first, whole
from ...reports.page.verdict import is_count
from ...reports.sheets import Sheet
from ...reports.tables import LARGEST_WHOLE
from ..ground.machine.systems.people import command_line
from ..ground.output.errors import UsageError
from ..ground.output.replacing import PAGE as MARK
from ..ground.output.sources import sources
from ..ground.output.writing import check_folder, check_page, check_writable, files_of, say, whole_file, write_text
from ..keep.runs import Done, Row, read_to_show
from ..measures.live import checks
from ..measures.live.kept import read_live
from ..measures.live.programs import helpers, storage_functions
from ..measures.live.scenes import read_scenes, unpacking
from ..tables.registry import TABLES
from ..tables.shared_columns import ENCODING
from ..tables.table import UNEXPECTED, Table
from .cards import about_codecs
from .kept_code import read_code
from .showing import summary

PAGE, CHARTS, PICTURES = "report.html", "charts", "pictures"
LIVE = "live"
# How many charts a run keeps as files; `report --charts` writes all of them.
CHARTS_OF_A_RUN = 3


def report_command(
    folder: Path, as_markdown: bool, pictures_beside: bool, charts_beside: bool, output: Path | None
) -> None:
    """Write a run's page and print its path, or write a Markdown text for a pull request; the run is not changed.

    Args:
        pictures_beside, charts_beside: whether the page's pictures, and its charts as files, go into folders next to
            it.
        output: the file to write; None for the page in the run's folder, and for the text on standard output.

    Raises:
        UsageError: the folder is not a run's, or the output cannot be written.
    """
    if output:
        _check_output(output, as_markdown)
    done = read_to_show(folder)
    if as_markdown:
        write_text(lambda: markdown.markdown(gathered(folder, done)), output)
    else:
        charts = "" if not charts_beside else f"{output.stem}-{CHARTS}" if output else CHARTS
        say(f"{write_report(folder, done, output or folder / PAGE, charts, pictures_beside)}\n")


def _check_output(output: Path, as_markdown: bool) -> None:
    """Raise UsageError if a file cannot be written, or if its name or contents do not match the kind of output."""
    check_writable(output, mark=b"" if as_markdown else MARK)
    if not as_markdown:
        check_page(output)
    elif output.suffix.lower() in (".html", ".htm"):
        raise UsageError(f"{output}: --markdown writes text; name it {output.with_suffix('.md')}")


def _cleaned(done: Done) -> Done:
    """Return a copy of a run in which all facts and rows are plain text and numbers, whatever its files hold."""
    steps = [{"table": plain_text(step["table"]), "key": {}, "rows": _clean(step["rows"])} for step in done.steps]
    whole = {name: _clean(rows) for name, rows in done.whole.items()}
    return Done(plain_text(done.facts), steps, done.damage, whole=whole)


def write_report(
    folder: Path,
    done: Done,
    target: Path,
    charts: str = "",
    pictures_beside: bool = False,
    most_charts: int | None = None,
    name: str = "",
) -> Path:
    """Write a run's page and, if requested, a folder of its charts and a folder of its pictures next to the page.

    Args:
        charts: the name of the folder of charts; empty for no such folder.
        pictures_beside: whether to write a folder of pictures, rather than pictures in the page.
        most_charts: the maximum number of charts to write, the page's first; None for all.
        name: the run's name on the page; empty for the name of the folder.

    Returns:
        the page's path.

    Raises:
        UsageError: the page cannot be written.
    """
    check_writable(target)
    pictures = f"{target.stem}-{PICTURES}" if pictures_beside else ""
    beside = target.parent / charts if charts else None
    for side_folder in (beside, target.parent / pictures):
        if side_folder:
            check_folder(side_folder)
    run, gallery, specs = drawn_page(gathered(folder, done, name), beside, pictures, most_charts)
    _write_beside(target.parent / pictures, gallery.files)
    with whole_file(target) as partial:
        files = {path.name for path in folder.iterdir()} if target.parent.resolve() == folder.resolve() else set()
        partial.write_text(page.html(run, gallery, specs, library_of(specs), files), encoding="utf-8", newline="\n")
    return target


def drawn_page(
    run: Found, charts: Path | None = None, pictures: str = "", most_charts: int | None = None
) -> tuple[Found, embedded.Gallery, dict[str, wire.Spec]]:
    """Draw a run's charts, and return the run, with remarks on what could not be drawn, its pictures, and its charts
    by name.

    Args:
        run: the run, as `gathered` returns it.
        charts: the folder for the charts as files; None for no files.
        pictures: the folder of pictures, relative to the page's folder; empty for pictures in the page.
        most_charts: the maximum number of charts to write as files; None for all.
    """
    # Pictures are packed while charts are drawn; either takes a core for seconds.
    with ThreadPoolExecutor(1) as pool:
        is_answered = any(section.about.leads and section.rows for section in run.sections)
        budget = embedded.BUDGET_OF_A_RUN if is_answered else embedded.BUDGET
        packing = pool.submit(embedded.gallery, run.subjects, pictures, budget)
        specs, failed = _drawn(run, charts, most_charts)
        gallery = packing.result()
    if gallery.damaged:
        failed.append(f"These pictures cannot be read: {'; '.join(gallery.damaged)}.")
    return run.with_remarks(failed), gallery, specs


def library_of(specs: Mapping[str, wire.Spec]) -> str:
    """Return the text of the script that draws charts; empty if there are no charts."""
    return wire.library() if specs else ""


def _write_beside(folder: Path, files: Mapping[str, str]) -> None:
    """Write the scripts that contain pictures, as text by file name, to a folder, and delete an earlier page's
    scripts. Do nothing if there are no scripts."""
    if not files:
        return
    for name, path in files_of(folder).items():
        if path.suffix == ".js" and path.stem.isdecimal() and name not in files:
            path.unlink()
    for name, text in files.items():
        with whole_file(folder / name) as partial:
            partial.write_text(text, encoding="utf-8", newline="\n")


def _drawn(run: Found, folder: Path | None, most: int | None) -> tuple[dict[str, wire.Spec], list[str]]:
    """Write the first `most` charts to a folder, if it is given. Return the page's charts by name, and a sentence for
    each chart that cannot be drawn."""
    specs, failed = {}, []
    for number, drawing in enumerate(page.drawings(run)):
        try:
            if folder and (most is None or number < most):
                _write_chart(drawing, folder)
            if drawing.spec:
                spec = drawing.spec()
                # A browser reads no infinity.
                json.dumps(spec, allow_nan=False)
                specs[drawing.name] = spec
        except UNEXPECTED as error:
            failed.append(f"The chart {drawing.name!r} cannot be drawn from these rows: {type(error).__name__}.")
    return specs, failed


def _write_chart(drawing: drawings.Drawing, folder: Path) -> None:
    """Write a chart to a folder, as an SVG file and as a PNG file."""
    svg, png = (folder / f"{drawing.name}.{ending}" for ending in ("svg", "png"))
    with whole_file(svg) as vectors, whole_file(png) as pixels:
        drawings.write(drawing, (vectors, "svg"), (pixels, "png"))


def gathered(folder: Path, done: Done, name: str = "") -> Found:
    """Return everything that a page shows of a run, without measuring anything. The run is named after its folder
    unless `name` is given. Problems become remarks."""
    done = _cleaned(done)
    # In the order of the page, whichever was measured first.
    tables = {name: done.tables[name] for name in TABLES if name in done.tables}
    facts = done.facts
    remarks = [f"{plain_text(remark)}." for remark in (done.damage, done.left_out) if remark]
    if facts.get("sources") != sources():
        remarks.append(f"{_other_version(facts)} Measure it again: {_command(facts)}.")
    run = Found(
        name=str(plain_text(name or folder.resolve().name)),
        facts=facts,
        tables=tables,
        steps=len(done.steps),
        finished=done.finished,
        encodings=_encodings(tables),
        subjects=list(_subjects(folder, done, tables, remarks)),
        **_extras(folder, tables, remarks),
        live=_live(folder / LIVE),
        remarks=remarks,
    )
    asked = _asked(facts)
    shown = [table for table in TABLES.values() if table.name in tables or table.name in asked]
    sections = answered_first([_section(folder, run, done, table, remarks) for table in shown])
    return replace(run, sections=sections, cards=about_codecs(sections), code=_clean_code(read_code(folder)))


def _other_version(facts: Row) -> str:
    """Return a sentence that names the version that measured a run, and the version that makes this page."""
    machine = facts.get("machine")
    version = plain_text(str(machine.get("normalbench") or "")) if isinstance(machine, dict) else ""
    there = plain_text(str(facts.get("sources") or "unknown"))
    program = f"normalbench {version}".strip()
    return f"This run was measured by {program} (sources {there}); this page was generated with sources {sources()}."


def _clean_code(kept: dict[str, Any]) -> dict[str, Any]:
    """Return kept code in which the control characters of all pieces, except newlines, are replaced by spaces."""
    pieces = ["\n".join(map(str, map(plain_text, piece.split("\n")))) for piece in kept.get("pieces", ())]
    return kept | {"pieces": pieces} if kept else {}


def _encodings(tables: Mapping[str, Sequence[Row]]) -> frozenset[str]:
    """Return the names of encodings of normals: those in the catalogue, and those of users' files in a run's rows."""
    of_normals = (rows for name, rows in tables.items() if ENCODING in TABLES[name].columns)
    names = {str(row["encoding"]) for rows in of_normals for row in rows if row.get("encoding")}
    return frozenset(names | ENCODINGS.keys())


def _section(folder: Path, run: Found, done: Done, table: Table, remarks: list[str]) -> TableSection:
    """Return the page's section for a table; problems with the table's rows are added to the remarks."""
    rows = _finished(done, table) if table.name in run.tables else ()
    return TableSection(
        key=table.name,
        about=table.section,
        columns=table.columns,
        also=table.also,
        rows=rows,
        summary=_summary(done, table, remarks),
        drawings=_drawings(run, done, table, remarks),
        asked=table.name in _asked(done.facts),
        films=_films(folder, table, rows, remarks),
    )


def _summary(done: Done, table: Table, remarks: list[str]) -> list[Sheet]:
    """Return the sheets that summarise a table. If its rows do not match, add a remark and return no sheets."""
    try:
        return summary(table, done.finished_rows(table.name))
    except UNEXPECTED:
        remedy = done.remedy(table.name)
        remarks.append(f"The rows of {table.name} do not match this version and are shown as they are; {remedy}.")
        return []


def _drawings(run: Found, done: Done, table: Table, remarks: list[str]) -> list[drawings.Drawing]:
    try:
        charts = [*table.work.charts(whole(_finished(done, table))), *table.work.joined(run)]
        return list(map(drawings.of, charts))
    except UNEXPECTED as error:
        remarks.append(f"The charts of {table.name} cannot be drawn from these rows: {type(error).__name__}.")
        return []


def _finished(done: Done, table: Table) -> Sequence[Row]:
    """Return a table's finished rows; if a different version's rows cannot be finished, the rows unchanged."""
    try:
        return done.finished_rows(table.name)
    except UNEXPECTED:
        return done.tables[table.name]


def _films(folder: Path, table: Table, rows: Sequence[Row], remarks: list[str]) -> list[tuple[str, str]]:
    """Return the caption and the data URI of each of a table's animations whose file exists. If the rows do not match
    this version, add a remark and return an empty list."""
    try:
        films = list(table.work.films(folder / table.files["images"], rows)) if "images" in table.files else []
    except UNEXPECTED as error:
        remarks.append(f"The animations of {table.name} cannot be determined from these rows: {type(error).__name__}.")
        return []
    return [(film.said, uri) for film in films if (uri := film_uri(film.path))]


def _clean(rows: Sequence[Row]) -> list[Row]:
    """Return rows of plain text and numbers, whatever they hold: lists, dictionaries and huge numbers become text."""
    return [{column: _flat(value) for column, value in plain_text(row).items()} for row in rows]


def _flat(value: Any) -> Any:
    is_odd = isinstance(value, list | dict) or (is_count(value) and abs(value) >= LARGEST_WHOLE)
    return str(value) if is_odd else value


def _command(facts: Row) -> str:
    """Return the command line that measured a run, without its output folder."""
    words = [str(word) for word in facts.get("command") or ("run",)]
    output_index = next((i for i, word in enumerate(words) if word in ("-o", "--output")), len(words))
    return command_line(["normalbench", *words[:output_index], *words[output_index + 2 :]])


def _asked(facts: Row) -> set[str]:
    """Return the names of the tables that were requested for a run, in its last command or an earlier command."""
    before = facts.get("before")
    requests = [
        facts.get("request"),
        *(earlier.get("request") for earlier in before or () if isinstance(earlier, dict)),
    ]
    asked: set[str] = set()
    for request in (request for request in requests if isinstance(request, dict)):
        words = {*(request.get("tables") or ())}
        asked |= words & TABLES.keys()
        asked |= {table.name for table in TABLES.values() if "all" in words and table.is_in_all(request)}
    return asked


def _subjects(folder: Path, done: Done, names: Iterable[str], remarks: list[str]) -> Iterator[Subject]:
    """Yield the subjects of these tables' pictures; if a table's rows do not match, add a remark instead."""
    for name in names:
        if "images" in TABLES[name].files:
            try:
                pictures = folder / TABLES[name].files["images"]
                yield from TABLES[name].work.subjects(pictures, done.finished_rows(name))
            except UNEXPECTED as error:
                remarks.append(f"The pictures of {name} cannot be determined from these rows: {type(error).__name__}.")


def _extras(folder: Path, tables: Mapping[str, Sequence[Row]], remarks: list[str]) -> dict[str, Any]:
    """Return the data that tables show besides their rows, by attribute of `found.Found`. Problems become remarks."""
    extras: dict[str, Any] = {}
    for name in tables:
        try:
            extras |= TABLES[name].work.extras(folder, tables, remarks)
        except UNEXPECTED as error:
            remarks.append(f"Additional data of {name} cannot be determined from these rows: {type(error).__name__}.")
    return extras


def _live(folder: Path) -> Live | None:
    """Return the contents of the page's laboratory; None if the run has no data for it."""
    codecs, left_out = read_live(folder)
    if not codecs:
        return None
    cleaned = {str(plain_text(name)): str(plain_text(reason)) for name, reason in left_out.items()}
    storages = storage_functions([codec["storage"] for codec in codecs])
    scenes = [(str(plain_text(name)), pixels, slope) for name, pixels, slope in read_scenes(folder)]
    return Live(codecs, storages, cleaned, helpers(), scenes, unpacking(), checks.common())
