"""A page for each encoding in a run, readable without scripts, and an index of these pages."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from ..sheets import Role, Row, Sheet
from . import cards
from .found import Found
from .page import PageTable, base, sheet_table, table, template
from .sections import TableSection, whole
from .site import SCRIPTS, Index, Searched, Site, index_html, linked, plain_names

FOLDER, INDEX = "codecs", "codecs/index.html"
# The columns of the lists, and what they say.
LISTED = {
    "angle_mean_deg": "Mean angle between a normal and its decoded value. Unit: degrees.",
    "angle_max_deg": "Largest known angle. Unit: degrees.",
    "slots": "Issue slots to encode and decode once.",
    "normals": "Set of normals used for the angles.",
    "bits": "Bits that the codec uses.",
}
FIGURES = {"bits": "bits", "angle_mean_deg": "mean", "angle_max_deg": "largest", "slots": "slots", "normals": "of"}
OWN = "A user's encoding; the formulas are in its file."
# Lines of a fact: whether it is code, and its text.
Lines = Sequence[tuple[bool, str]]


@dataclass(frozen=True)
class CodecPage:
    """An encoding's page: its description, storages, rows in each table, and code by storage and language."""

    name: str
    title: str
    description: str
    question: str
    says: str
    facts: Sequence[tuple[str, Lines]]
    storages: PageTable
    tables: Sequence[tuple[str, str, PageTable]]
    code: Sequence[tuple[str, Sequence[tuple[str, str]]]]
    look_ups: bool


def codec_pages(run: Found, names: Sequence[str], site: Site, run_page: str) -> dict[str, str]:
    """Return the HTML of a page for each encoding and of an index, by their paths in the site's folder; empty if the
    run has no codecs.

    Args:
        run: the run.
        names: names of the codecs that the run's page shows.
        site: the site to which the pages belong.
        run_page: path of the run's page.
    """
    codecs = cards.codecs_of(run, names)
    groups = {name: list(labels) for name, labels in groupby(names, cards.of_encoding)}
    named = zip(groups, plain_names(groups, "encoding"), strict=True)
    files = {group: f"{FOLDER}/{name}.html" for group, name in named}
    pages = {}
    for name, path in files.items():
        about, card = _page(run, name, {label: codecs[label] for label in groups[name]}), _card(groups[name][0])
        around = base(SCRIPTS) | site.leads(path)
        pages[path] = template("codec.html.j2").render(codec=about, card=linked(run_page + card, path), **around)
    return pages | ({INDEX: _index_page(run, codecs, files, site)} if groups else {})


def _card(label: str) -> str:
    return f"#v1/codecs?a={label.replace(' ', '%20')}"


def _page(run: Found, name: str, codecs: Mapping[str, Row]) -> CodecPage:
    known = run.cards["encodings"].get(name, {})
    code = list(_code(run, codecs))
    return CodecPage(
        name=name,
        title=f"{name}, an encoding of normals: formula, error, cost and code",
        description=_description(name, known, codecs),
        question=f"How accurate is {name}, and what does it cost?",
        says=known.get("says") or OWN,
        facts=list(_facts(known)),
        storages=_codec_table(f"{name} by storage", codecs),
        tables=[section_table for section in cards.sections_of(run) if (section_table := _rows(section, name))],
        code=code,
        look_ups=bool(known.get("tables")),
    )


def _description(name: str, known: Mapping[str, Any], codecs: Mapping[str, Row]) -> str:
    """Return the text for search results: a description of the encoding, and its figures at the lowest bit count."""
    says = known.get("says") or f"{name}, an encoding of normals."
    measured = [(label, row) for label, row in codecs.items() if "mean" in row]
    if not measured:
        return says
    label, figures = min(measured, key=lambda pair: pair[1].get("bits") or math.inf)
    slots = f", {figures['slots']:g} issue slots to encode and decode" if "slots" in figures else ""
    return f"{says} {label}: mean error {figures['mean']:.3g} degrees on {figures['of']}{slots}."


def _facts(known: Mapping[str, Any]) -> Iterator[tuple[str, Lines]]:
    """Yield titles and lines with facts about an encoding in the catalogue; nothing for any other encoding."""
    for what in ("encode", "decode"):
        if known.get(what):
            says, *formulas = known[what]
            yield what, [(False, says), *((True, line) for line in formulas)]
    for title, name in (("source", "source"), ("made for", "domain")):
        if known.get(name):
            yield title, [(False, str(known[name]))]
    if known:
        yield "used by", [(False, _users(known["used"]) or "No known engine.")]


def _users(used: Sequence[tuple[str, int, str]]) -> str:
    """Return text on the engines that use an encoding, with the storages of their normals."""
    storages: dict[str, dict[str, None]] = {}
    for engine, _, storage in used:
        storages.setdefault(engine, {})[storage] = None
    return "; ".join(f"{engine} in {', '.join(kept)}" for engine, kept in storages.items())


def _codec_table(title: str, codecs: Mapping[str, Row]) -> PageTable:
    """Return the table of figures for codecs; codecs without figures are left out unless all lack figures."""
    rows = [
        {"codec": label, "storage": row.get("storage"), **{name: row.get(key) for name, key in FIGURES.items()}}
        for label, row in _measured(codecs).items()
    ]
    return table(title, rows, lambda name: LISTED.get(name, ""))


def _measured(codecs: Mapping[str, Row]) -> Mapping[str, Row]:
    return {label: row for label, row in codecs.items() if "mean" in row} or codecs


def _rows(section: TableSection, name: str) -> tuple[str, str, PageTable] | None:
    """Return a table's key, its title and its rows on an encoding; None if these have no figures."""
    rows = [row for row in whole(section.rows) if row.get("encoding") == name]
    known = {column for row in rows for column, value in row.items() if value is not None and column != "encoding"}
    columns = [section.column(column) for column in (rows[0] if rows else ()) if column in known]
    keys = [column.name for column in columns if column.role in (Role.KEY, Role.REASON)]
    figures = [column.name for column in columns if cards.is_figure(column)]
    if not figures:
        return None
    shown = [{column: row[column] for column in (*keys, *figures)} for row in rows]
    page_table = sheet_table(Sheet(f"{name} in the table {section.key}", shown), section.column)
    return section.key, section.about.title, page_table


def _code(run: Found, codecs: Mapping[str, Row]) -> Iterator[tuple[str, Sequence[tuple[str, str]]]]:
    """Yield each codec of an encoding with the run's shader code for it, as pairs of a language and a text; codecs
    without code are left out."""
    kept = run.code or {"codecs": {}}
    for label in codecs:
        if label in kept["codecs"]:
            texts = kept["codecs"][label]["texts"].items()
            yield (
                label,
                [(kept["languages"][word], "".join(kept["pieces"][piece] for piece in text)) for word, text in texts],
            )


def _index_page(run: Found, codecs: Mapping[str, Row], files: Mapping[str, str], site: Site) -> str:
    links = {name: linked(path, INDEX) for name, path in files.items()}
    index = Index(
        path=INDEX,
        title="encodings of normals",
        description=f"{len(files)} encodings of normals: formula, source, error, cost and code of each.",
        question="Encodings of normals",
        said=(f"{len(files)} encodings, {len(_measured(codecs))} codecs.",),
        label="Search by encoding, storage or source",
        searched=[_encoding_list(run, codecs, links), _codec_list(codecs, links)],
    )
    return index_html(index, site)


def _encoding_list(run: Found, codecs: Mapping[str, Row], links: Mapping[str, str]) -> Searched:
    known = run.cards["encodings"]
    rows = [
        {
            "encoding": name,
            "what it does": known.get(name, {}).get("says") or OWN,
            "source": known.get(name, {}).get("source"),
        }
        for name in links
    ]
    words = [" ".join(label for label in codecs if cards.of_encoding(label) == name) for name in links]
    shown = table("Encodings and their sources", rows, lambda _: "")
    return Searched(
        "encodings",
        "Encodings",
        "One row per encoding. Click a name for its page.",
        shown,
        words,
        list(links.values()),
    )


def _codec_list(codecs: Mapping[str, Row], links: Mapping[str, str]) -> Searched:
    shown = _codec_table("Codecs: an encoding in a storage", codecs)
    labels, intro = list(_measured(codecs)), "One row per encoding in a storage, with its error and cost."
    to = [links[cards.of_encoding(label)] for label in labels]
    return Searched("codecs", "Codecs", intro, shown, labels, to)
