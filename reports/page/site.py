"""The pages of a site other than the laboratory: searchable lists, devices, encodings, and a run's results without
scripts. This module does not depend on how anything is measured."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from .. import tables
from ..sheets import undefined
from .page import Cell, Heading, Line, PageSection, PageTable, base, template

SCRIPTS = ("tables.js", "site.js")
LONGEST = 60


@dataclass(frozen=True)
class Site:
    """The links between a site's pages.

    Attributes:
        pages: titles by path; every page links to these.
        devices: path of the list of devices.
        laboratory: path of the page that measures a device; empty if the site has none.
    """

    pages: Mapping[str, str]
    devices: str
    laboratory: str = ""

    def leads(self, path: str) -> dict[str, Any]:
        """Return the template variables for the links from the page at a path to the other pages."""
        links = [(linked(to, path), title, to == path) for to, title in self.pages.items()]
        about = {"links": links if len(links) > 1 else [link for link in links if not link[2]]}
        return about | {"laboratory": linked(self.laboratory, path) if self.laboratory else ""}


def linked(to: str, path: str) -> str:
    """Return the relative link from the page at `path` to another path of the site, which may have a fragment."""
    file, mark, fragment = to.partition("#")
    return posixpath.relpath(file, posixpath.dirname(path) or ".") + mark + fragment


def plain_names(names: Iterable[str], other: str) -> Iterator[str]:
    """Yield a unique name for each name, with only letters, digits and marks that every file system and URL allows;
    never "index".

    Args:
        names: the names.
        other: replacement for a name without such characters.
    """
    taken = {"index"}
    for name in names:
        plain = re.sub(r"[^a-z0-9_]+", "-", name.lower()).strip("-")[:LONGEST] or other
        numbered = (plain, *(f"{plain}-{number}" for number in range(2, len(taken) + 2)))
        free = next(candidate for candidate in numbered if candidate not in taken)
        taken.add(free)
        yield free


@dataclass(frozen=True)
class Answer:
    """The answer to a question about a device: sentences that begin with the answer itself, and a table."""

    said: Sequence[str]
    table: PageTable


@dataclass(frozen=True)
class DeviceSection:
    """A section on the page of devices.

    Attributes:
        name: the device and its browser.
        key: anchor of the section.
        said: how the device agrees with the run, in a sentence.
        about: what the browser reports about the device, by name.
        answers: the recommended encodings.
        tables: tables of all codecs and of the facts.
    """

    name: str
    key: str
    said: str
    about: Mapping[str, str]
    answers: Sequence[Answer]
    tables: Sequence[PageTable]


@dataclass(frozen=True)
class Searched:
    """A searchable table of the index; each row may have more search terms and a link."""

    key: str
    title: str
    intro: str
    table: PageTable
    words: Sequence[str]
    links: Sequence[str] = field(default_factory=tuple)


def words_table(title: str, rows: Sequence[Mapping[str, str | None]]) -> PageTable:
    """Return rows of text as a page table; columns are kept even if all rows have the same value."""
    heads = [Heading(undefined(name), name, numeric=False) for name in rows[0]]
    lines = [Line([Cell(tables.text_of(row[head.title]), "", "") for head in heads], "") for row in rows]
    return PageTable(title, heads, lines, "")


@dataclass(frozen=True)
class Headed:
    """A page that answers a question.

    Attributes:
        path: path of the page in the site's folder.
        title: subject of the page.
        description: text for search results.
        question: heading of the page.
    """

    path: str
    title: str
    description: str
    question: str


@dataclass(frozen=True)
class Index(Headed):
    """A page of searchable lists.

    Attributes:
        said: the findings from all rows together, in sentences.
        label: label of the search field.
        searched: its tables.
        devices: sections on the devices in its tables.
        measures: whether the page explains how a reader's device is measured and added.
    """

    said: Sequence[str]
    label: str
    searched: Sequence[Searched]
    devices: Sequence[DeviceSection] = ()
    measures: bool = False


@dataclass(frozen=True)
class ViewPage(Headed):
    """A page with the text of a view of the run's page, without scripts.

    Attributes:
        said: the answer in a sentence; empty if there is none.
        view: the link to the view on the run's page, and what a reader can do there.
        parts: its sections.
    """

    said: str
    view: tuple[str, str]
    parts: Sequence[PageSection]


def index_html(index: Index, site: Site) -> str:
    """Return the HTML of an index page with searchable lists."""
    return template("site.html.j2").render(index=index, **_around(index.path, site))


def view_html(shown: ViewPage, site: Site) -> str:
    """Return the HTML of a page with the text of a view."""
    view = linked(shown.view[0], shown.path)
    return template("view.html.j2").render(shown=shown, view=view, choices=None, **_around(shown.path, site))


def _around(path: str, site: Site) -> dict[str, Any]:
    return base(SCRIPTS) | site.leads(path)
