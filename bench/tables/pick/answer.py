"""The answer: which codes qualify, which of them no other beats, and which one the aim takes. From rows alone."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from ....reports.page.verdict import MADE_FOR

Row = dict[str, Any]

IMAGE = "image_db_"
BEST, RUNNER_UP, CHEAPER, PICTURE, AGAINST = "best", "runner-up", "cheaper", "picture", "against"
# What codes of a domain hold, by the domain that is needed.
HOLDS: Mapping[str, frozenset[str]] = MappingProxyType(
    {
        "sphere": frozenset({"sphere"}),
        "hemisphere": frozenset({"sphere", "hemisphere"}),
        "view": frozenset({"sphere", "view"}),
    }
)
# What normals outside an encoding's domain do.
BEYOND = {"hemisphere": "point away (z < 0)", "view": "face away from the viewer"}
# Images are compared of codes whose angles are this close.
CLOSE = 0.95
# Of `cheaper`: its instructions' share of the best's.
CHEAP = 0.5


def largest(row: Row) -> float | None:
    """The supremum, or the largest angle that was met: float32 may lose what exact arithmetic does not."""
    return max((row[name] for name in ("angle_max_deg", "angle_sup_deg") if row[name] is not None), default=None)


def image_db(row: Row) -> float | None:
    """The lowest PSNR of a row's images; None where none was rendered."""
    found = [value for name, value in row.items() if name.startswith(IMAGE) and value is not None]
    return min(found, default=None)


def cost(row: Row) -> float | None:
    """What a code costs: a device's milliseconds where the row has a place for them, else instructions."""
    return row["ms"] if "ms" in row else row["instructions"]


# By aim: a row's figure, less is better; None where it is not known.
AIMS: Mapping[str, Any] = MappingProxyType(
    {
        "angle": lambda row: row["angle_mean_deg"],
        "worst": lambda row: largest(row) if row["aim"] == "worst" else row["angle_max_deg"],
        "image": lambda row: None if (found := image_db(row)) is None else -found,
        "cost": cost,
    }
)
# What decides where the aim does not tell two codes apart.
THEN = ("cost", "angle", "worst", "image")


def figure(row: Row, aim: str) -> float:
    """What an aim makes as small as it can; infinite where it is not known."""
    found = AIMS[aim](row)
    return math.inf if found is None else float(found)


def order(row: Row) -> tuple[float, ...]:
    """By what rows are sorted: the aim, then the other figures."""
    return tuple(figure(row, aim) for aim in (row["aim"], *THEN))


def beats(one: Row, other: Row) -> bool:
    """Whether a code is nowhere worse than another one and somewhere better."""
    pairs = [(figure(one, aim), figure(other, aim)) for aim in AIMS]
    return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)


def clearly_beats(one: Row, other: Row) -> bool:
    """Whether a code has so much smaller angles than another, at no higher cost, that no image needs to be drawn."""
    angles = all(figure(one, aim) < CLOSE * figure(other, aim) for aim in ("angle", "worst"))
    return angles and figure(one, "cost") <= figure(other, "cost")


def why_left_out(row: Row) -> str:
    """Why a code does not qualify; empty where it does."""
    if row["skipped"]:
        return row["skipped"]
    if row["invalid"]:
        return f"{row['invalid']} decodes that are NaN or infinite"
    if row["needs"] and row["domain"] not in HOLDS[row["needs"]]:
        return f"made for {MADE_FOR[row['domain']]} alone"
    if not row["needs"] and row["lost_percent"]:
        return lost(row)
    if row.get("cannot_mix"):
        return row["cannot_mix"]
    most, count = row["most_instructions"], row["instructions"]
    if most is not None and count is None:
        return "instructions not known"
    if most is not None and count > most:
        return f"more than {most} instructions"
    if figure(row, row["aim"]) == math.inf:
        return f"no figure for --aim {row['aim']}"
    return ""


def lost(row: Row) -> str:
    """What a code loses of the normals because its encoding is not made for them; empty where it loses none."""
    share = row["lost_percent"]
    return f"loss of normals that {BEYOND[row['domain']]}: {shown_share(share)} of these" if share else ""


def shown_share(percent: float) -> str:
    """A share that is not 0, as a sentence has it."""
    return f"{percent:.2g} %" if percent >= 0.01 else "less than 0.01 %"


def groups(rows: Sequence[Row]) -> dict[tuple[str, str, str], list[Row]]:
    """Rows by the question that they answer: storage, normals and scene."""
    found: dict[tuple[str, str, str], list[Row]] = {}
    for row in rows:
        found.setdefault((row["storage"], row["normals"], row["scene"]), []).append(row)
    return found


def answered(rows: Sequence[Row]) -> list[Row]:
    """The rows with `left_out`, `front` and `place`: those that qualify by the aim, then others, for each question."""
    return [row for group in groups(rows).values() for row in _answered(group)]


def _answered(group: Sequence[Row]) -> list[Row]:
    judged = [row | {"left_out": why_left_out(row) or None} for row in group]
    fit = sorted((row for row in judged if not row["left_out"]), key=order)
    places = _places(fit)
    made = [
        row
        | {
            "front": not any(beats(other, row) for other in fit),
            "place": ", ".join(_said(row, places, at)) or None,
        }
        for at, row in enumerate(fit)
    ]
    others = [row | {"front": False, "place": AGAINST if row["against"] else None} for row in judged if row["left_out"]]
    return made + others


def _places(fit: Sequence[Row]) -> dict[str, int]:
    """Which of the codes that qualify, sorted by the aim, is what."""
    if not fit:
        return {}
    found = {BEST: 0}
    if len(fit) > 1:
        found[RUNNER_UP] = 1
    limit = CHEAP * figure(fit[0], "cost")
    cheap = [at for at, row in enumerate(fit) if figure(row, "cost") <= limit < math.inf and at]
    if cheap:
        found[CHEAPER] = cheap[0]
    pictured = [at for at, row in enumerate(fit) if figure(row, "image") < math.inf]
    if pictured:
        found[PICTURE] = min(pictured, key=lambda at: (figure(fit[at], "image"), at))
    return found


def _said(row: Row, places: Mapping[str, int], at: int) -> Iterator[str]:
    yield from (name for name, place in places.items() if place == at)
    if row["against"]:
        yield AGAINST
