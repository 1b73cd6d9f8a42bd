"""A run's report as one HTML page, self-contained unless its pictures are stored next to it."""

from __future__ import annotations

import base64
import hashlib
import itertools
import json
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any

from .. import tables
from ..charts import spheres
from ..charts.drawings import Drawing
from ..charts.wire import Spec
from ..sheets import Column, Row, Sheet, View
from . import cards, embedded, live
from .codec_key import CodecKey
from .data import block
from .found import Found
from .packing import packed
from .sections import TableSection, whole
from .verdict import is_number

WEB = Path(__file__).parent / "web"
# The view Choose may begin before the last script is read, and draws in a chart.
SCRIPTS = ("tables.js", "state.js", "data.js", "charts.js", "choose.js", "zoom.js", "pictures.js", "cards.js")
SCRIPTS += ("compare.js", "figures.js", "opener.js")
# Text of more letters than this may break into lines.
WRAPPED = 24


# What the navigation calls a section's extras that have a heading of their own.
EXTRAS = {"angles": "Angles", "sphere": "Sphere"}
# What the navigation calls the views.
TITLES = {view: view.capitalize() for view in View}
# A section's tables have at most so many cells in the page; those behind them are packed, and built when opened. In a
# page of more codecs than MANY_CODECS the lists of A and B take the room of the larger tables.
MOST_CELLS, CELLS_BESIDE_MANY, MANY_CODECS = 1000, 400, 150
# A legend has at most so many entries.
MOST_KEYS = 40


@dataclass(frozen=True)
class Cell:
    """A cell of a table: its text, the value by which it is sorted if that differs, and its classes in page.css."""

    text: str
    value: str
    style: str


@dataclass(frozen=True)
class Heading:
    """The heading of a column: the column, the heading's text, and whether the cells are numbers."""

    column: Column
    title: str
    numeric: bool


@dataclass(frozen=True)
class Line:
    """A row of a table: its cells, and the name of its codec, empty if it has none."""

    cells: Sequence[Cell]
    codec: str


@dataclass(frozen=True)
class PageTable:
    """A table for the template; `constants` states the values that all rows share, and `data` contains its packed
    rows if the page builds the table only when it is opened."""

    title: str
    columns: Sequence[Heading]
    rows: Sequence[Line]
    constants: str
    said: Sequence[str] = ()
    aside: Sequence[str] = ()
    keys: Mapping[str, Any] = field(default_factory=dict)
    data: str = ""


def definitions(shown: Iterable[PageTable]) -> list[tuple[str, str]]:
    """Return the titles and definitions of the columns in tables, each once."""
    heads = (head for page_table in shown for head in page_table.columns)
    return list(dict.fromkeys((head.title, head.column.definition) for head in heads if head.column.definition))


def table(title: str, rows: Sequence[Row], says: Callable[[str], str]) -> PageTable:
    """Return rows as a page table; a column with the same value in all rows is stated once.

    Args:
        title: title of the table.
        rows: the rows.
        says: function that returns the definition of a column by name."""
    return sheet_table(Sheet(title, rows), lambda name: Column(name, says(name)))


def sheet_table(sheet: Sheet, column: Callable[[str], Column], encodings: Container[str] = ()) -> PageTable:
    """Return a sheet as a page table.

    Args:
        column: function that returns the column for a name.
        encodings: names of encodings whose rows are labelled with their codec.
    """
    rows = whole(sheet.rows)
    shown, constants = tables.without_constants(rows)
    heads = [Heading(column(name), tables.title_of(name), tables.is_numeric(shown, name)) for name in shown[0]]
    numbers = [head.column for head in heads if sheet.is_ranked and head.numeric and head.column.better]
    best = {cell for figure in numbers for cell in _best(shown, rows, figure)}
    lines = [
        Line(
            [_cell(row[head.column.name], head.numeric, (i, head.column.name) in best) for head in heads],
            _codec({**sheet.keys, **whole_row}, encodings),
        )
        for i, (row, whole_row) in enumerate(zip(shown, rows, strict=True))
    ]
    about = {"said": sheet.said, "aside": sheet.aside, "keys": sheet.keys}
    return PageTable(sheet.title, heads, lines, constants.replace("_", " "), **about)


def _best(shown: Sequence[Row], rows: Sequence[Row], column: Column) -> Iterator[tuple[int, str]]:
    """Yield the position, row and column, of a column's best figure among rows with the same bits and operation; none
    if several rows share it."""
    groups: dict[Any, list[int]] = {}
    for index, row in enumerate(rows):
        if is_number(row[column.name]):
            groups.setdefault((row.get("bits"), row.get("operation")), []).append(index)
    for places in groups.values():
        best = (max if column.better == "more" else min)(shown[i][column.name] for i in places)
        winners = [i for i in places if tables.text_of(shown[i][column.name]) == tables.text_of(best)]
        if len(places) > len(winners) == 1:
            yield winners[0], column.name


def _cell(value: Any, numeric: bool, is_best: bool) -> Cell:
    text = tables.text_of(value)
    if not numeric:
        return Cell(text, "", "long" if len(text) > WRAPPED else "")
    exact = "" if not text else f"{value:.9g}" if isinstance(value, float) else str(int(value))
    return Cell(text, exact if exact != text else "", "n best" if is_best else "n")


def _codec(row: Mapping[str, Any], encodings: Container[str]) -> str:
    """Return the label of a row's codec, or only the encoding's name if the row has no storage; empty unless the
    encoding is among `encodings`."""
    encoding = row.get("encoding")
    if not isinstance(encoding, str) or encoding not in encodings:
        return ""
    key = CodecKey.said_by(row)
    return key.label if key else encoding


def remarks(run: Found) -> list[str]:
    """Return sentences that a reader should see before the figures: whether the run is unfinished, remarks, and parts
    that were skipped."""
    sentences = list(run.remarks)
    left_out = run.facts.get("left_out")
    sentences += [f"Skipped in this run: {line}." for line in left_out] if isinstance(left_out, list) else []
    if not run.finished:
        sentences.insert(0, f"This run is not finished. Completed steps: {run.steps}.")
    return sentences


@dataclass(frozen=True)
class Chart:
    """A chart on the page: the drawing, and its data for charts.js."""

    drawing: Drawing
    spec: Spec


@dataclass(frozen=True)
class PageSection:
    """A section for the template: the table's section, its charts and tables, and the conditions of measurement."""

    section: TableSection
    charts: Sequence[Chart]
    tables: Sequence[PageTable]
    measured: Sequence[tuple[str, str]]

    @property
    def is_there(self) -> bool:
        """Whether the run has rows for the section."""
        return bool(self.section.rows)


@dataclass(frozen=True)
class Shown:
    """A view that has contents: the view, its title, and the anchors and names of its parts."""

    view: View
    title: str
    parts: Sequence[tuple[str, str]]


@dataclass(frozen=True)
class Home:
    """The text of the page as the home page of a site: its title, its description in search results, and links to the
    other pages, each a path and a title."""

    title: str
    description: str
    links: Sequence[tuple[str, str]]


def views(run: Found, has_codecs: bool, has_pictures: bool) -> list[Shown]:
    """Return the views that a reader may choose, in the order of the page."""
    parts: dict[View, list[tuple[str, str]]] = {view: [] for view in View}
    for section in run.sections:
        mine = parts[section.about.view]
        mine.append((section.key, section.about.short))
        mine += [(extra, EXTRAS[extra]) for extra in section.about.extras if extra in EXTRAS]
    parts[View.COMPARE] += [("both", "Figures")] if has_codecs else []
    parts[View.COMPARE] += [("pictures", "Images")] if has_pictures else []
    parts[View.SEE] += [("live", "Your GPU")] if run.live else []
    parts[View.DATA] += [("rows", "Every row"), ("measured", "Measured")]
    return [Shown(view, TITLES[view], mine) for view, mine in parts.items() if mine]


def beginning(
    parts: Sequence[PageSection], names: Sequence[str], own: Sequence[str] = (), is_laboratory: bool = False
) -> dict[str, Any]:
    """Return the initial state of the page's script: all codecs, codecs A and B, and the view. A and B are the answer
    and the next codec in its table, or a user's own codec and the answer. The view is the laboratory if the page is a
    laboratory, the comparison if a user's own codec stands against another, and otherwise the view of the first
    measured section, with answers before all others."""
    measured = sorted((part for part in parts if part.is_there), key=lambda part: not part.section.about.leads)
    leading = [part for part in measured if part.section.about.leads]
    answers = (table for part in leading for table in part.tables if table.said)
    shown = dict.fromkeys(line.codec for table in list(answers)[:1] for line in table.rows if line.codec in {*names})
    # A user's own stands against the answer in its storage.
    same = (name for name in own for other in shown if name.split()[1:] == other.split()[1:])
    mine = next(itertools.chain(same, own), None)
    others = [name for name in [*shown, *names] if name != mine] if mine else list(shown)
    first, second = [*([mine] if mine else []), *others, "", ""][:2]
    of_rows = measured[0].section.about.view if measured else View.DATA
    view = View.SEE if is_laboratory else View.COMPARE if mine and second else of_rows
    return {"codecs": list(names), "a": first, "b": second, "view": view}


def _own(run: Found, names: Sequence[str]) -> list[str]:
    """Return the names of codecs whose encoding is not in the catalogue but a user's own."""
    known = run.cards.get("encodings")
    return [name for name in names if known and cards.of_encoding(name) not in known]


def drawings(run: Found) -> list[Drawing]:
    """Return every chart of a run."""
    charts = [drawing for section in run.sections for drawing in section.drawings]
    return charts + spheres.drawings(run.maps)


@cache
def template(name: str) -> Any:
    """Return a Jinja template from the folder `web`, by its file name."""
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(WEB),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["definitions"] = definitions
    environment.globals["most_keys"] = MOST_KEYS
    return environment.get_template(name)


def codecs(run: Found) -> list[str]:
    """Return the names of all codecs that the page shows."""
    named = {pictured.codec for subject in run.subjects for pictured in subject.codecs if pictured.codec}
    encodings = run.encodings
    rows = [row for section in run.sections for row in section.rows]
    return sorted(named | {name for row in rows if " " in (name := _codec(row, encodings))})


def html(
    run: Found,
    gallery: embedded.Gallery,
    specs: Mapping[str, Spec],
    library_script: str,
    files: Container[str] = (),
    home: Home | None = None,
) -> str:
    """Return the page as HTML.

    Args:
        run: the run.
        gallery: the run's pictures.
        specs: charts as data, by the names of their drawings; a chart without data is not shown.
        library_script: the script that draws the charts.
        files: names of the files next to the page.
        home: text for the home page of a site, which begins with the laboratory; None for a page on its own.
    """
    laboratory = live.script() if run.live else ""
    names = codecs(run)
    most_cells = CELLS_BESIDE_MANY if len(names) > MANY_CODECS else MOST_CELLS
    parts = [part_of(run, section, specs, most_cells) for section in run.sections]
    leading = [part for part in parts if part.section.about.leads and part.is_there]
    maps, begins, choices = (
        run.maps,
        beginning(parts, names, _own(run, names), bool(home and run.live)),
        run.choices,
    )
    return template("page.html.j2").render(
        found=run,
        home=home,
        remarks=remarks(run),
        views=views(run, bool(names), bool(gallery.subjects)),
        agreement=run.agreement,
        parts=parts,
        leading=leading,
        spheres=spheres.globes(spheres.shown(maps)),
        more_maps=max(len(maps) - spheres.MOST, 0),
        directions=maps[0].directions if maps else 0,
        cells=maps[0].mean_deg.shape[-1] if maps else 0,
        strip=spheres.colour_strip(),
        gallery=gallery,
        picture_data=data_block(gallery.data) if gallery.subjects else "",
        codecs=names,
        grouped=[(encoding, list(of)) for encoding, of in groupby(names, cards.of_encoding)],
        begins=begins,
        begins_data=data_block(begins),
        choices=choices,
        choices_data=packed(json.dumps(choices)) if choices else "",
        cards=cards.block(run, names),
        listings=packed(_listings(run)) if run.listings else "",
        files=files,
        library=packed(library_script) if specs else "",
        specs=packed(json.dumps(specs)) if specs else "",
        live=run.live,
        live_script=packed(laboratory) if run.live else "",
        live_data=packed(run.live.data(about(run))) if run.live else "",
        **base(SCRIPTS, [library_script, laboratory], is_beside=bool(gallery.files)),
    )


def _listings(run: Found) -> str:
    """Return the run's disassemblies as JSON text for data.js."""
    listings = run.listings
    return json.dumps({name: {"text": listing.text, "source": listing.source} for name, listing in listings.items()})


def base(names: Sequence[str], unpacked: Sequence[str] = (), is_beside: bool = False) -> dict[str, Any]:
    """Return the variables that base.html.j2 needs for every page.

    Args:
        names: file names of the page's scripts in the folder `web`.
        unpacked: texts of scripts that the page unpacks later.
        is_beside: whether pictures are stored in scripts next to the page.
    """
    scripts = [(WEB / name).read_text(encoding="utf-8") for name in names]
    style = (WEB / "page.css").read_text(encoding="utf-8")
    return {"scripts": scripts, "style": style, "script_sources": sources_of([*scripts, *unpacked], is_beside)}


def about(run: Found) -> dict[str, str]:
    """Return the facts about a run that the laboratory needs: its name, fingerprint and program version."""
    return {"run": run.name, "sources": run.sources, "program": str(run.machine.get("normalbench", ""))}


def data_block(data: Any) -> str:
    """Return data as JSON for a script element, with `<` escaped so that no text can end the element."""
    return json.dumps(data).replace("<", "\\u003c")


def sources_of(scripts: Sequence[str], is_beside: bool = False) -> str:
    """Return the script sources that the page allows, for its Content-Security-Policy: hashes of its own scripts and,
    if `is_beside`, files next to it."""
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii") for script in scripts)
    return " ".join([*(f"'sha256-{digest}'" for digest in digests), *(["'self'", "file:"] if is_beside else [])])


def part_of(run: Found, section: TableSection, specs: Mapping[str, Spec], most_cells: float) -> PageSection:
    """Return the page section for a table: its charts, and its sheets as tables. Once the tables exceed `most_cells`
    cells in total, the rest are packed as data."""
    encodings = run.encodings
    sheets = list(section.sheets)
    shown = [sheet_table(sheet, section.column, encodings) for sheet in sheets]
    cells = itertools.accumulate(len(page_table.rows) * len(page_table.columns) for page_table in shown)
    shown = [
        page_table
        if sum_of <= most_cells
        else replace(page_table, data=block(sheet.rows, map(section.column, sheet.rows[0])))
        for page_table, sheet, sum_of in zip(shown, sheets, cells, strict=True)
    ]
    charts = [Chart(drawing, specs[drawing.name]) for drawing in section.drawings if drawing.name in specs]
    return PageSection(section, charts, shown, section.measured())
