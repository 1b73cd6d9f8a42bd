"""A site of devices: an index that is searched, and a page for each. Nothing here knows how a device is measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .. import tables
from ..sheets import undefined
from .page import Cell, Heading, Line, Table, base, template

SCRIPTS = ("tables.js", "site.js")


@dataclass(frozen=True)
class Answer:
    """A question about a device, answered: sentences, the first of which is the answer, and a table."""

    said: Sequence[str]
    table: Table


@dataclass(frozen=True)
class DevicePage:
    """A device's page.

    Attributes:
        name: the device and its browser.
        path: of the page, from the site's folder.
        said: how it agrees with the run, in a sentence.
        about: what the browser says of it, by name.
        answers: which code to take.
        tables: every codec, and the facts.
    """

    name: str
    path: str
    said: str
    about: Mapping[str, str]
    answers: Sequence[Answer]
    tables: Sequence[Table]


@dataclass(frozen=True)
class Searched:
    """A table of the index: for each row words that it is found by besides its cells, and the page that it leads to,
    empty for none."""

    key: str
    title: str
    intro: str
    table: Table
    words: Sequence[str]
    links: Sequence[str] = field(default_factory=tuple)


def words_table(title: str, rows: Sequence[Mapping[str, str | None]]) -> Table:
    """Rows of words as a table to show; every column stays, also one that says the same in each row."""
    heads = [Heading(undefined(name), name, numeric=False) for name in rows[0]]
    lines = [Line([Cell(tables.text_of(row[head.title]), "", "") for head in heads], "") for row in rows]
    return Table(title, heads, lines, "")


def index_html(said: Sequence[str], searched: Sequence[Searched]) -> str:
    """The index.

    Args:
        said: what all devices together show, in sentences.
        searched: its tables.
    """
    return template("site.html.j2").render(said=said, searched=searched, **base(SCRIPTS))


def device_html(device: DevicePage) -> str:
    """A device's page."""
    return template("device.html.j2").render(device=device, **base(SCRIPTS))
