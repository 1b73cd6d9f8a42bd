"""The answer in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from ....encodings.catalogue import ENCODINGS
from .answer import AIMS, BEST, CHEAPER, IMAGE, PICTURE, RUNNER_UP, beats, image_db, largest, lost

Row = dict[str, Any]

AIM_TITLES = {"angle": "mean error", "worst": "largest error", "image": "image"}
# Reasons for which more codes are left out than this are counted instead of named.
MOST_NAMED = 6


def sentences(group: Sequence[Row]) -> list[str]:
    """What the rows of one question say, as `answered` gives them: the answer, then paragraphs of a few sentences."""
    places = {place: row for row in group for place in (row["place"] or "").split(", ") if place}
    where = f"{group[0]['storage']}, on {group[0]['normals']}"
    if BEST not in places:
        return [f"{where}: no code qualifies{_constraints(group[0])}.", *left_out(group)]
    best = places[BEST]
    made = [f"{where}: take {best['encoding']}.", f"{_figures(best)} {_price(best)}{_loops(best)}{_reservation(best)}"]
    if RUNNER_UP in places:
        other = places[RUNNER_UP]
        made.append(f"Runner-up: {other['encoding']}, {_next(other, best)}.")
    made += _cheaper(places, best)
    made += _picture(places, best)
    made += [_against(row, best) for row in group if row["against"] and row is not best]
    return [*made, *left_out(group)]


def _constraints(row: Row) -> str:
    said = [f"at most {row['most_instructions']} instructions"] if row["most_instructions"] is not None else []
    said += [f"for {row['needs']}"] if row["needs"] else []
    return f" ({', '.join(said)})" if said else ""


def degrees(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3g}°"


def decibels(value: float | None) -> str:
    return "no figure" if value is None else "no difference" if math.isinf(value) else f"{value:.1f} dB"


def images(row: Row) -> str:
    """The image's PSNR at each power; empty where there is none."""
    found = [(name.removeprefix(IMAGE), value) for name, value in row.items() if name.startswith(IMAGE)]
    said = [f"{decibels(value)} at power {power}" for power, value in found if value is not None]
    return " and ".join(said)


def _figures(row: Row) -> str:
    met = " (of those measured)" if row["angle_sup_deg"] is None else ""
    angles = f"Its mean error is {degrees(row['angle_mean_deg'])}, its largest {degrees(largest(row))}{met}."
    scene = row["scene"] + (f" with {row['effects']}" if row.get("effects") else "")
    return angles + (f" The image of {scene} has {images(row)}." if images(row) else "")


def _price(row: Row) -> str:
    if row["instructions"] is None:
        return "What it costs is not known on this machine."
    parts = f"{row['encode_instructions']:g} to encode and {row['decode_instructions']:g} to decode"
    return f"It costs {row['instructions']:g} instructions on {row['family']}: {parts}."


def _reservation(row: Row) -> str:
    return f" Note the {lost(row)}." if row["lost_percent"] else ""


def _loops(row: Row) -> str:
    return " A loop's body counts once, so it runs more than that." if row["loops"] else ""


def _next(row: Row, best: Row) -> str:
    aim = best["aim"]
    one, other = AIMS[aim](row), AIMS[aim](best)
    by = f" ({more(one / other)})" if aim in ("angle", "worst") and other else ""
    count = "" if row["instructions"] is None else f", {row['instructions']:g} instructions"
    if aim == "cost":
        return f"{_aimed(row, aim)} instructions"
    worst = "" if aim == "worst" else f", {_largest(row)}"
    return f"{AIM_TITLES[aim]} {_aimed(row, aim)}{by}{worst}{count}"


def _largest(row: Row) -> str:
    """The supremum where it was searched, else what was met, which may be less."""
    return f"largest {'met ' if row['angle_sup_deg'] is None else ''}{degrees(largest(row))}"


def more(ratio: float) -> str:
    """How much larger a figure is than another one."""
    percent = f"{100 * (ratio - 1):.1f}"
    return "equal" if float(percent) == 0 else f"{percent} % more"


def _aimed(row: Row, aim: str) -> str:
    if aim == "image":
        return decibels(image_db(row))
    if aim == "cost":
        return f"{row['instructions']:g}"
    return degrees(row["angle_mean_deg"] if aim == "angle" else largest(row))


def _bits(row: Row, best: Row) -> str:
    if row["bits"] == best["bits"]:
        return ""
    has_sign = row["encoding"] in ENCODINGS and ENCODINGS[row["encoding"]].sign_bits
    return f" in {row['bits']} bits" + (", one of them in the sign of the depth" if has_sign else "")


def _cheaper(places: dict[str, Row], best: Row) -> Iterator[str]:
    if CHEAPER not in places:
        return
    row = places[CHEAPER]
    again = row is places.get(RUNNER_UP)
    figures = f"mean error {degrees(row['angle_mean_deg'])}, {_largest(row)}"
    pictured = f", {images(row)}" if images(row) else ""
    yield f"Cheaper: {row['encoding']}" + (
        ", too." if again else f" for {row['instructions']:g} instructions{_bits(row, best)}, {figures}{pictured}."
    )


def _picture(places: dict[str, Row], best: Row) -> Iterator[str]:
    if PICTURE not in places:
        return
    row = places[PICTURE]
    if row is best or row is places.get(CHEAPER):
        yield from [] if best["aim"] == "image" else [f"{row['encoding']} also has the best image of those rendered."]
        return
    count = "" if row["instructions"] is None else f" for {row['instructions']:g} instructions"
    price = f"{count}{_bits(row, best)}; mean error {degrees(row['angle_mean_deg'])}."
    yield f"Best image of those rendered: {row['encoding']}, {images(row)}{price}"


def _against(row: Row, best: Row) -> str:
    if row["left_out"]:
        return f"{row['encoding']} does not qualify: {row['left_out']}."
    said = f"{row['encoding']}: {_next(row, best)}; {images(row) or 'no image'}"
    if row["front"]:
        return f"{said}. No other code beats it in every figure."
    return f"{said}. {best['encoding']} beats it in every figure." if beats(best, row) else f"{said}."


def left_out(group: Sequence[Row]) -> Iterator[str]:
    """Which codes do not qualify, and why."""
    reasons: dict[str, list[str]] = {}
    for row in group:
        if row["left_out"] and not row["against"]:
            reasons.setdefault(row["left_out"], []).append(row["encoding"])
    if reasons:
        yield "Left out: " + "; ".join(f"{_named(names)} ({why})" for why, names in reasons.items()) + "."


def _named(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) <= MOST_NAMED else f"{len(names)} codes"
