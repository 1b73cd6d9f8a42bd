"""How published figures are measured and shown."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ...ground.machine.devices import require_jax
from ...ground.output.errors import UsageError
from ..table import Measured, NoOutputs, Row, Sheet, Step, Work, each
from .figure import DIFFERENT, UNEXPLAINED, Figure, Source
from .table import TABLE, PublishedOptions


def _steps(options: PublishedOptions, _: NoOutputs) -> list[Step]:
    require_jax()
    return [
        Step({"source": source.name, "figure": figure.what}, (source, figure), figure.what)
        for source in chosen(options.source)
        for figure in source.figures
    ]


def chosen(words: str) -> list[Source]:
    """The sources whose names hold one of the comma-separated words. Raises UsageError where none does."""
    # They are made of measures, which import what measures.
    from .sources import SOURCES

    asked = [word.strip().lower() for word in words.split(",") if word.strip()]
    unknown = [word for word in asked if word != "all" and not any(word in source.name.lower() for source in SOURCES)]
    if unknown or not asked:
        known = "; ".join(source.name for source in SOURCES)
        raise UsageError(f"--source {words}: a word of one of these names: {known}")
    return [source for source in SOURCES if "all" in asked or any(word in source.name.lower() for word in asked)]


def measured(case: tuple[Source, Figure]) -> list[Row]:
    """The row of a figure."""
    source, figure = case
    ours = figure.ours.figure()
    row = {
        "source": source.name,
        "figure": figure.what,
        "place": figure.place,
        "published": figure.printed,
        "ours": ours,
        "unit": figure.unit,
        "difference": None if ours is None else ours - figure.value,
        "verdict": figure.verdict(ours),
        "why": figure.why or None,
        "command": figure.ours.command,
    }
    return [TABLE.empty() | row]


def _failures(rows: Sequence[Row]) -> Iterator[str]:
    for row in rows:
        if row["verdict"] == UNEXPLAINED:
            said = f"{row['published']} {row['unit']} is published and {row['ours']:.6g} measured"
            yield f"{row['source']}: {row['figure']}: {said}; {row['command']}"


def _shown(done: Measured) -> Iterator[Sheet]:
    """A sheet for each source, and below it why figures differ."""
    for source in dict.fromkeys(row["source"] for row in done.rows):
        rows = [row for row in done.rows if row["source"] == source]
        lines = TABLE.without_hidden(rows)
        for line in lines:
            del line["source"]
            line["ours"] = _as_printed(line["ours"], line["published"])
        yield Sheet(source, lines, notes=tuple(dict.fromkeys(_reasons(rows))))


def _as_printed(ours: float | None, published: str) -> str | None:
    """Ours with a digit more than the published figure, and at least three."""
    if ours is None or ours == round(ours):
        return None if ours is None else f"{ours:.0f}"
    first = math.floor(math.log10(abs(ours)))
    return f"{ours:.{max(len(published.partition('.')[2]) + 1, 2 - first)}f}"


def _reasons(rows: Sequence[Row]) -> Iterator[str]:
    """Why figures differ, each reason once with the figures that it is of, and one command that shows it."""
    by_reason: dict[str, list[Row]] = {}
    for row in rows:
        if row["verdict"] == DIFFERENT:
            by_reason.setdefault(row["why"], []).append(row)
    for why, part in by_reason.items():
        first, more = part[0], len(part) - 1
        of = f"{first['figure']}, and {more} more" if more else first["figure"]
        yield f"{of}: {why} ({first['command']})"


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    verdicts = dict.fromkeys(row["verdict"] for row in rows)
    sources = dict.fromkeys(row["source"] for row in rows)
    counts = {
        source: {name: sum((row["source"], row["verdict"]) == (source, name) for row in rows) for name in verdicts}
        for source in sources
    }
    yield Sheet("published figures, by verdict", [{"source": source} | counts[source] for source in sources])


WORK = Work(steps=_steps, measure=each(measured), shown=_shown, summary=_summary, failures=_failures)
