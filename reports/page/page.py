"""A run's report: one HTML page that holds everything it shows, or a text for a pull request."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .. import tables
from ..charts import spheres
from ..charts.drawings import Drawing, inline
from ..charts.pictures import CAPTIONS
from . import embedded
from .found import Found, Row
from .sections import Section, whole
from .verdict import Contest, contests, is_number

HERE = Path(__file__).parent
# What a contest's cheapest codec is counted by.
STAGE = "fragment"
# Text of more letters than this may break into lines.
WRAPPED = 24
KINDS = {"normals": "the normals as they are"} | CAPTIONS


# What the navigation calls a section's extras that have a heading of their own.
EXTRAS = {"pictures": "Pictures", "angles": "Angles", "sphere": "Sphere"}
# The columns of a contest.
CONTEST = {
    "by": "The measure.",
    "first": "Who leads by it; several are a tie, within 0.05 dB or half a percent of an angle.",
    "figure": "The leader's figure.",
    "next": "Who comes next.",
    "ahead": "By how much the leader is ahead.",
    "unit": "Of figure and distance.",
}


@dataclass(frozen=True)
class Cell:
    """A table's cell: what is read, what it is sorted by, and its class in page.css."""

    text: str
    value: str
    style: str


@dataclass(frozen=True)
class Column:
    """A table's column."""

    name: str
    title: str
    definition: str
    numeric: bool


@dataclass(frozen=True)
class Table:
    """A table as the template shows it; `constants` says what is the same in every row."""

    title: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    constants: str
    folded: bool = False
    said: Sequence[str] = ()


def table(title: str, rows: Sequence[Row], says: Callable[[str], str], folded: bool = False) -> Table:
    """Rows as a table to show; columns that say the same in each row are said once."""
    shown, constants = tables.without_constants(whole(rows))
    columns = [Column(name, name.replace("_", " "), says(name), tables.is_numeric(shown, name)) for name in shown[0]]
    cells = [[_cell(row[c.name], c.numeric) for c in columns] for row in shown]
    return Table(title, columns, cells, constants.replace("_", " "), folded)


def _cell(value: Any, numeric: bool) -> Cell:
    text = tables.text_of(value)
    if numeric:
        return Cell(text, repr(float(value)) if text else "", "n")
    return Cell(text, text, "long" if len(text) > WRAPPED else "")


def instructions(rows: Sequence[Row]) -> tuple[dict[str, float], str]:
    """Instructions to encode and decode, together, by encoding: of the last GPU family in fragment shaders; and which
    family that is."""
    usable = [r for r in rows if r.get("stage") == STAGE and r.get("encoding") and is_number(r.get("instructions"))]
    family = usable[-1].get("family") if usable else ""
    both: dict[str, list[float]] = {}
    for row in usable:
        if row.get("family") == family:
            both.setdefault(row["encoding"], []).append(row["instructions"])
    return {name: sum(counts) for name, counts in both.items() if len(counts) == 2}, str(family)


def judged(found: Found) -> list[Contest]:
    """The questions that the run answers."""
    costs, _ = instructions(found.tables.get("cost", ()))
    return contests(found.tables.get("quality", ()), found.tables.get("render", ()), costs, found.domains)


def remarks(found: Found) -> list[str]:
    """What a reader must know of the run before its figures."""
    said = list(found.remarks)
    if not found.facts.get("finished"):
        said.insert(
            0, f"This run is not finished: {found.steps} steps have their rows, and what others would say is open."
        )
    return said


@dataclass(frozen=True)
class Chart:
    """A drawing in the page."""

    drawing: Drawing
    svg: str


@dataclass(frozen=True)
class Part:
    """A section as the template shows it."""

    section: Section
    charts: Sequence[Chart]
    tables: Sequence[Table]
    measured: Sequence[tuple[str, str]]

    @property
    def is_there(self) -> bool:
        """Whether the run has anything of it."""
        return bool(self.tables)


def navigation(found: Found) -> list[tuple[str, str]]:
    """Anchors and their names, in the order of the page; what leads is on top of it."""
    made = []
    for section in found.sections:
        if section.leads:
            continue
        made.append((section.key, section.short))
        made += [(extra, EXTRAS[extra]) for extra in section.extras if extra in EXTRAS]
    return [*made, ("measured", "Measured")]


def drawings(found: Found) -> list[Drawing]:
    """Every chart of a run."""
    return [drawing for section in found.sections for drawing in section.drawings] + spheres.drawings(found.maps)


def _template() -> Any:
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(HERE),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("page.html.j2")


def html(found: Found, svgs: Mapping[str, str], gallery: embedded.Gallery) -> str:
    """The page.

    Args:
        found: the run.
        svgs: the drawings' SVG files, by name; one that is missing is not shown.
        gallery: its pictures.
    """
    script, style = ((HERE / name).read_text(encoding="utf-8") for name in ("page.js", "page.css"))
    parts = [_part(found, section, svgs) for section in found.sections]
    titled = [(c, f"Who leads by what, in {c.bits} bits on {c.normals}") for c in judged(found)]
    return _template().render(
        found=found,
        remarks=remarks(found),
        nav=navigation(found),
        contests=[(contest, table(title, contest.rows, lambda name: CONTEST[name])) for contest, title in titled],
        family=instructions(found.tables.get("cost", ()))[1],
        parts=parts,
        leading=[part for part in parts if part.section.leads and part.is_there],
        spheres=spheres.globes(found.maps),
        directions=found.maps[0].directions if found.maps else 0,
        cells=found.maps[0].mean_deg.shape[-1] if found.maps else 0,
        strip=spheres.colour_strip(),
        gallery=gallery,
        kinds=KINDS,
        script=script,
        style=style,
        digest=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii"),
    )


def _charts(made: Sequence[Drawing], svgs: Mapping[str, str]) -> list[Chart]:
    return [Chart(d, inline(svgs[d.name], d)) for d in made if d.name in svgs]


def _part(found: Found, section: Section, svgs: Mapping[str, str]) -> Part:
    sheets = section.sheets(found.domains)
    shown = [replace(table(s.title, s.rows, section.says, s.folded), said=s.said) for s in sheets]
    return Part(section, _charts(section.drawings, svgs), shown, section.measured())
