"""Which codec wins, by what, computed from rows: a contest for each set of normals and number of bits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..ties import TIE_DB, TIE_SHARE

Row = dict[str, Any]

WHOLE_SPHERE = "sphere"
MADE_FOR = {"hemisphere": "normals with z >= 0", "view": "normals that face the viewer"}
LEADING = "psnr_db"
BACKENDS = {"jax": "JAX", "glsl": "GLSL"}


@dataclass(frozen=True)
class Measure:
    """What codecs are ranked by: a column, what it is called, its unit, and which way is better."""

    column: str
    title: str
    unit: str
    more_is_better: bool

    def ties(self, one: float, other: float) -> bool:
        """Whether two figures are too close to tell a winner."""
        if one == other:
            return True
        return abs(one - other) < (TIE_DB if self.unit == "dB" else TIE_SHARE * abs(other) if self.unit else 0)

    def ahead(self, best: float, next_best: float) -> float | None:
        """By how much; None where one of them is infinite."""
        return abs(best - next_best) if math.isfinite(best) and math.isfinite(next_best) else None


MEASURES = (
    Measure(LEADING, "PSNR", "dB", True),
    Measure("psnr_article_db", "PSNR as the article measures it", "dB", True),
    Measure("angle_mean_deg", "mean angle", "degrees", False),
    Measure("angle_p99_deg", "99 % of angles below", "degrees", False),
    Measure("angle_max_deg", "largest angle", "degrees", False),
)
INSTRUCTIONS = Measure("instructions", "fewest instructions, encode and decode", "", False)


@dataclass(frozen=True)
class Standing:
    """Who leads by one measure, and who comes next; several names are a tie."""

    measure: Measure
    first: tuple[str, ...]
    figure: float
    next: tuple[str, ...]
    next_figure: float | None

    @property
    def ahead(self) -> float | None:
        """The distance to who comes next; None where there is nobody or no number."""
        return None if self.next_figure is None else self.measure.ahead(self.figure, self.next_figure)


@dataclass(frozen=True)
class Contest:
    """One question answered.

    Attributes:
        normals, bits: of which rows.
        codecs: how many take part.
        headline: the answer in a sentence.
        remarks: further sentences, where measures disagree or who leads is made for less than every direction.
        agreement: a sentence on the back ends.
        agrees: whether they agree on who leads.
        standings: by each measure.
    """

    normals: str
    bits: int
    codecs: int
    headline: str
    remarks: tuple[str, ...]
    agreement: str
    agrees: bool
    standings: tuple[Standing, ...]

    @property
    def rows(self) -> list[Row]:
        """The standings as rows."""
        return [
            {
                "by": s.measure.title,
                "first": listed(s.first),
                "figure": s.figure,
                "next": listed(s.next) if s.next else None,
                "ahead": s.ahead,
                "unit": s.measure.unit or None,
            }
            for s in self.standings
        ]


def is_number(value: Any) -> bool:
    """Whether it is a figure: no text, no truth value, not NaN."""
    return isinstance(value, int | float) and not isinstance(value, bool) and value == value


def is_count(value: Any) -> bool:
    """Whether it is a whole number."""
    return isinstance(value, int) and not isinstance(value, bool)


def named(row: Row) -> str:
    """A codec as a sentence names it."""
    rounding = f", {row['rounding']}" if row.get("rounding") not in (None, "nearest") else ""
    return f"{row.get('encoding')} in {row.get('storage')}{rounding}"


def standing(measure: Measure, figures: Mapping[str, float]) -> Standing | None:
    """Who leads; None where nobody has a figure."""
    if not figures:
        return None
    best = (max if measure.more_is_better else min)(figures.values())
    first = tuple(name for name, figure in figures.items() if measure.ties(figure, best))
    rest = {name: figure for name, figure in figures.items() if name not in first}
    after = standing(measure, rest)
    return Standing(measure, first, best, after.first if after else (), after.figure if after else None)


def counted_set(row: Row, rows: Sequence[Row]) -> str:
    """A row's set of normals, with their number where rows have several of that set: they are not compared."""
    name, counts = (
        str(row.get("normals")),
        {one.get("count") for one in rows if one.get("normals") == row.get("normals")},
    )
    return name if len(counts) == 1 else f"{name} of {row.get('count')} normals"


def contests(
    quality: Sequence[Row], images: Sequence[Row], costs: Mapping[str, float], domains: Mapping[str, str]
) -> list[Contest]:
    """Every question that rows answer: sets in their order, of each the number of bits with most encodings first.

    Args:
        quality: rows of the quality table, of any version; what has no figures takes no part.
        images: rows of the render table, `scene`, `encoding`, `storage` and `psnr_db`.
        costs: instructions by encoding, its encoding and decoding together.
        domains: by encoding what it can hold: "sphere", "hemisphere" or "view".
    """
    usable = [row for row in quality if is_number(row.get(LEADING)) and is_count(row.get("bits"))]
    groups: dict[tuple[str, int], list[Row]] = {}
    for row in usable:
        groups.setdefault((counted_set(row, usable), row["bits"]), []).append(row)
    made = [_contest(key, rows, images, costs, domains) for key, rows in groups.items()]
    encodings = {key: len({row.get("encoding") for row in rows}) for key, rows in groups.items()}
    sets = list(dict.fromkeys(normals for normals, _ in groups))
    return sorted(made, key=lambda c: (sets.index(c.normals), -encodings[c.normals, c.bits], c.bits))


def _contest(
    key: tuple[str, int],
    rows: Sequence[Row],
    images: Sequence[Row],
    costs: Mapping[str, float],
    domains: Mapping[str, str],
) -> Contest:
    normals, bits = key
    backends = list(dict.fromkeys(row.get("backend") for row in rows))
    by_backend = {b: {named(r): r for r in rows if r.get("backend") == b} for b in backends}
    first = "jax" if "jax" in by_backend else backends[0]
    # A codec that the first back end has no rows of takes part by another's.
    leading = {name: row for b in (*backends, first) for name, row in by_backend[b].items()}
    found = [standing(m, _figures(leading, m.column)) for m in MEASURES]
    found += [_by_image(scene, leading, images) for scene in dict.fromkeys(row.get("scene") for row in images)]
    known = {name: costs[row["encoding"]] for name, row in leading.items() if row.get("encoding") in costs}
    found.append(standing(INSTRUCTIONS, known))
    standings = tuple(s for s in found if s)
    remarks = (*_holds(leading, domains), *_disagreements(standings))
    return Contest(
        normals, bits, len(leading), _headline(key, standings[0]), remarks, *_backends(by_backend), standings
    )


def _figures(rows: Mapping[str, Row], column: str) -> dict[str, float]:
    return {name: row[column] for name, row in rows.items() if is_number(row.get(column))}


def _by_image(scene: Any, rows: Mapping[str, Row], images: Sequence[Row]) -> Standing | None:
    """By the final image, among codecs that were rendered."""
    measure = Measure(LEADING, f"final image of {scene}", "dB", True)
    figures = {named(r): r[LEADING] for r in images if r.get("scene") == scene and is_number(r.get(LEADING))}
    return standing(measure, {name: figures[name] for name in rows if name in figures})


def figure_text(value: float, unit: str = "") -> str:
    """A figure in a sentence: hundredths of a decibel, three digits of an angle."""
    text = f"{value:.2f}" if unit == "dB" else f"{value:.3g}"
    return f"{text} {unit}".rstrip()


def _headline(key: tuple[str, int], won: Standing) -> str:
    normals, bits = key
    where, figure = f"In {bits} bits on {normals}", figure_text(won.figure, won.measure.unit)
    if len(won.first) > 1:
        return f"{where} {listed(won.first)} are equal: {figure}{_after(won)}."
    if not won.next:
        return f"{where} there is {listed(won.first)} alone: {figure}."
    return f"{where}, {listed(won.first)} wins: {figure}{_after(won)}."


def _after(won: Standing) -> str:
    if won.ahead is None or not won.next:
        return ""
    return f", {figure_text(won.ahead, won.measure.unit)} ahead of {listed(won.next)}"


def listed(names: Sequence[str]) -> str:
    """Names in a sentence; a storage that all of them share is named once."""
    places = {name.partition(" in ")[2] for name in names}
    if len(names) == 1:
        return names[0]
    if len(places) == 1:
        *before, last = (name.partition(" in ")[0] for name in names)
        return f"{', '.join(before)} and {last} in {places.pop()}"
    return f"{', '.join(names[:-1])} and {names[-1]}"


def _holds(rows: Mapping[str, Row], domains: Mapping[str, str]) -> list[str]:
    """Where who leads cannot hold every direction, who leads among those that can."""
    leading = MEASURES[0]
    won = standing(leading, _figures(rows, LEADING))
    narrow = {name: domains.get(str(rows[name].get("encoding"))) for name in (won.first if won else ())}
    said = [f"{name} is made for {MADE_FOR[domain]} alone" for name, domain in narrow.items() if domain in MADE_FOR]
    if not said:
        return []
    whole = {name: row for name, row in rows.items() if domains.get(str(row.get("encoding"))) == WHOLE_SPHERE}
    best = standing(leading, _figures(whole, LEADING))
    if not best:
        return [f"{'; '.join(said)}."]
    is_best = "is best" if len(best.first) == 1 else "are best"
    among = f"of codes for every direction {listed(best.first)} {is_best}: {figure_text(best.figure, 'dB')}"
    return [f"{'; '.join(said)}; {among}."]


def _disagreements(standings: Sequence[Standing]) -> list[str]:
    """Measures by which somebody else leads."""
    won = set(standings[0].first)
    others = [s for s in standings[1:] if s.measure is not INSTRUCTIONS and not won & set(s.first)]
    said = [f"{s.measure.title}, {listed(s.first)} ({figure_text(s.figure, s.measure.unit)})" for s in others]
    return [f"Other measures have other winners: {'; '.join(said)}."] if said else []


def _backends(by_backend: Mapping[Any, Mapping[str, Row]]) -> tuple[str, bool]:
    """How far the implementations' figures are apart, and whether they agree on who leads."""
    if len(by_backend) < 2:
        (only,) = by_backend
        return f"Measured by {BACKENDS.get(only, only)} alone.", True
    # Who leads is asked of codecs that all of them have.
    shared = set.intersection(*(set(_figures(rows, LEADING)) for rows in by_backend.values()))
    of_shared = {b: {n: f for n, f in _figures(rows, LEADING).items() if n in shared} for b, rows in by_backend.items()}
    leaders = {b: standing(MEASURES[0], figures) for b, figures in of_shared.items()}
    firsts: dict[Any, tuple[str, ...]] = {b: s.first for b, s in leaders.items() if s}
    if len(set(firsts.values())) > 1:
        said = "; ".join(f"by {BACKENDS.get(b, b)} {listed(names)} leads" for b, names in firsts.items())
        return f"The back ends disagree: {said}.", False
    one, other = (_figures(rows, LEADING) for rows in list(by_backend.values())[:2])
    apart = [abs(one[name] - other[name]) for name in one if name in other and math.isfinite(one[name] - other[name])]
    names = " and ".join(str(BACKENDS.get(b, b)) for b in by_backend)
    return f"{names} agree within {max([*apart, 0.001]):.1g} dB.", True
