"""The answer, from rows alone: which encodings qualify, how they rank, and which to use.

The ranking of two encodings depends only on those two. Adding or removing a third encoding does not change it.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

from ....reports.page.verdict import MADE_FOR
from ...measures.images.turns import INDISTINGUISHABLE_DB, gap_db
from ..table import Row
from .table import HOLE

IMAGE = "image_db_"
BEST, MORE_EXACT, MOST_EXACT, CHEAPER, FEWER_BITS = "best", "more accurate", "most accurate", "cheaper", "fewer bits"
TIE = "tie"
INSIDE, PLAIN, AGAINST, ELSEWHERE = "inside a surface", "plain channels", "against", "elsewhere"
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
# Issue slots of an encoder, or of a reader, that take no longer than the write or the read of the target.
HIDDEN_SLOTS = 16
# How many times the price that takes no time anybody pays for what is not seen.
AFFORDABLE = 2.0
# The share of the angle that the error of a decode's length has, from which on it must be normalised before it is lit.
# `xyz` has 0.7, of the other codes none has over 0.16 but for a rounding at the edge of its domain, 0.03.
LENGTH = 0.1
# Nobody chooses by less than half a decibel.
STEP = 0.5
# Prices that are apart by less of a doubling are one.
SAME_PRICE = 0.1
# Rungs of a ladder that differ by less are one.
LEAST_DB = 0.25
MOST_RUNGS = 2
# Another storage of the same bytes is named where it is better by a bit of each component.
MUCH_BETTER_DB = 6.0
# How many times more exact than what is asked for an answer is, before nothing else is worth a word.
NEEDLESS = 10.0
NO_FIGURE = "no figure for --aim"
# Why codes are left out that an option may take.
# An error from which on a direction is lost, even where no other encoding was measured.
LOST_DEG = 90.0
HOLE_SAID = f"a hole: the largest error is over {HOLE:g} times the smallest, or {LOST_DEG:g}°; --accept-holes allows it"
LENGTH_SAID = "decodes are not unit length, and lighting needs a normalise; --accept-lengths allows them"
TABLE_SAID = "reads a lookup table; --look-ups allows it"
LOOPS_SAID = "how often its loops run is not known"
EDGE_SAID = "does not survive an edge"
# A code has no use for a storage that has so many more bits than it has codes for.
WASTED_BITS = 8
# How many figures behind the loss decide where codes are equal.
TIES = 3
# By how many of its standard errors two images must differ.
ERRORS = 2


def places_of(row: Row) -> list[str]:
    """Return the names of the places that a row has in the answer; `[""]` if it has none."""
    return str(row.get("place") or "").split(", ")


def largest(row: Row) -> float | None:
    """Return the supremum of the angle, or the largest sampled angle if larger, because float32 may lose more than
    exact arithmetic. None if neither is known."""
    return _largest_angle(row["angle_max_deg"], row["angle_sup_deg"])


def mean(row: Row) -> float | None:
    """Return the mean angle, or the mean error after the requested mixing if larger; None if neither is known."""
    return _largest_angle(row["angle_mean_deg"], row.get("mixed_mean_deg"))


def largest_mixed(row: Row) -> float | None:
    """Return the largest angle, or the largest error after the requested mixing; None if neither is known."""
    return _largest_angle(largest(row), row.get("mixed_max_deg"))


def _largest_angle(*angles: float | None) -> float | None:
    return max((angle for angle in angles if angle is not None), default=None)


def images(row: Row) -> dict[tuple[str, str], float]:
    """Return the PSNRs of a row's images by scene and specular power; the power is empty if the materials have none.
    An empty dict if no image was rendered."""
    figures = {name.removeprefix(IMAGE): value for name, value in row.items() if name.startswith(IMAGE)}
    return {_scene_and_power(name): value for name, value in figures.items() if value is not None}


def image_name(scene: str, power: float | None) -> str:
    """Return the name of an image: `gloss_47`, or only the scene, `studio`, if materials have no specular power."""
    return scene if power is None else f"{scene}_{power:g}"


def _scene_and_power(name: str) -> tuple[str, str]:
    scene, _, power = name.rpartition("_")
    return (scene, power) if scene and power.replace(".", "", 1).isdigit() else (name, "")


def image_db(row: Row) -> float | None:
    """Return the lowest PSNR of a row's images; None if no image was rendered."""
    return min(images(row).values(), default=None)


def decibels(angle: float | None) -> float:
    """Return 20 log10 of an angle in degrees, in decibels: lower is better; infinite if the angle is None."""
    return math.inf if angle is None else 20 * math.log10(max(angle, 1e-12))


def image_loss(row: Row) -> float:
    psnr = image_db(row)
    return math.inf if psnr is None else -min(psnr, INDISTINGUISHABLE_DB)


# By aim: what a code loses, in decibels; less is better.
AIMS: Mapping[str, Callable[[Row], float]] = MappingProxyType(
    {
        "angle": lambda row: decibels(mean(row)),
        "worst": lambda row: decibels(largest_mixed(row)),
        "image": image_loss,
        "cost": lambda row: decibels(mean(row)),
    }
)


def loss_db(row: Row) -> float:
    """Return an encoding's loss by the row's aim, in decibels: lower is better; infinite if not known."""
    return AIMS[row["aim"]](row)


def floor(row: Row) -> float:
    """Return the issue slots that memory traffic hides over all passes, which is the lowest possible cost."""
    return _hidden(row) * (1 + row["readers"])


def _hidden(row: Row) -> float:
    """Return the issue slots per pass that take no extra time: the row's own number, otherwise HIDDEN_SLOTS."""
    return row.get("hidden_slots") or HIDDEN_SLOTS


def price(row: Row) -> float:
    """Return the issue slots to encode once and to decode in each decoding pass, counting at least the hidden slots
    in each pass. Operations of unknown cost count as the hidden slots."""
    encode, decode = (max(row[name] or 0.0, _hidden(row)) for name in ("encode_slots", "decode_slots"))
    return encode + row["readers"] * decode


def doublings(row: Row) -> float:
    """Return log2 of the ratio between the cost of a row's encoding and the lowest possible cost, `floor`."""
    return math.log2(price(row) / floor(row))


def is_enough(row: Row) -> bool:
    """Whether an encoding is accurate enough for reflections of an environment map: twice its largest angle is within
    the row's limit."""
    angle = largest_mixed(row)
    return angle is not None and 2 * angle <= row["enough"]


def order(row: Row) -> tuple[float, ...]:
    """Return the sort key of a row; lower is better.

    Encodings that are accurate enough and cheap come first, by fewest bits and then by cost, rounded to doublings.
    The others follow by loss + worth log2(price / floor), rounded to half a decibel, and then by cost. Image scores
    are not rounded, because pairs decide whether images are equal. Nor are largest angles, because no choice of
    normals changes them.
    """
    ties = (price(row), _bits(row), row["slots"] or 0.0)
    if row["aim"] == "cost":
        return (price(row), not is_enough(row), loss_db(row), *ties)
    if is_enough(row) and price(row) <= AFFORDABLE * floor(row):
        return (0, bool(row["table"]), _bits(row), round(doublings(row)), _to_a_tenth(loss_db(row)), *ties)
    first = score(row) if row["aim"] in ("image", "worst") else to_a_step(score(row))
    return (1, first, price(row), loss_db(row), *ties)


def score(row: Row) -> float:
    """Return the loss of an encoding plus its weighted cost, in decibels; lower is better."""
    return loss_db(row) + row["worth"] * doublings(row)


def clear_gap_db(candidate: Row, other: Row) -> float:
    """Return the smallest difference in decibels that makes one of two encodings better.

    An encoding's images depend on how its axes are oriented in the scene: a difference counts only if it is at least
    twice its standard error.
    """
    if candidate["aim"] != "image":
        return LEAST_DB
    errors = [json.loads(row["image_errors"]) for row in (candidate, other) if row.get("image_errors")]
    return max(STEP, ERRORS * gap_db(*errors)[1]) if len(errors) > 1 else STEP


def is_clearly_better(candidate: Row, other: Row) -> bool:
    """Whether an encoding's loss is lower than another's by at least `clear_gap_db`, which excludes chance."""
    return loss_db(other) - loss_db(candidate) >= clear_gap_db(candidate, other)


def to_a_step(figure: float) -> float:
    """Return a score rounded to half a decibel, because smaller differences do not matter."""
    return round(figure / STEP) * STEP if math.isfinite(figure) else figure


def _to_a_tenth(loss: float) -> float:
    """Return a loss rounded to 0.1 dB, so that equally good encodings keep their order."""
    return round(loss, 1) if math.isfinite(loss) else loss


def figures(row: Row) -> tuple[float, float, float]:
    """Return the figures that the Pareto front compares: loss, cost and bits; lower is better."""
    return _to_a_tenth(loss_db(row)), price(row), _bits(row)


def beats(candidate: Row, other: Row) -> bool:
    """Whether an encoding is better than another in at least one of `figures`, and worse in no figure."""
    pairs = list(zip(figures(candidate), figures(other), strict=True))
    return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)


def why_unfit(row: Row) -> str:
    """Return the reason why an encoding can never be the answer, whatever its cost; empty if it can."""
    if row["skipped"]:
        return row["skipped"]
    if row["invalid"]:
        return f"{row['invalid']} decodes are NaN or infinite"
    if row["needs"] and row["domain"] not in HOLDS[row["needs"]]:
        return f"only for {MADE_FOR[row['domain']]}"
    if not row["needs"] and row["lost_percent"]:
        return lost(row)
    if (row["length_share"] or 0) > LENGTH and not row["accept_lengths"]:
        return LENGTH_SAID
    if row["bits"] and row["code_bits"] and row["bits"] - row["code_bits"] > WASTED_BITS:
        return f"uses only {row['code_bits']:.0f} bits in any storage"
    return ""


def why_left_out(row: Row) -> str:
    """Return why an encoding does not qualify, regardless of the other encodings; empty if it qualifies."""
    if why := why_unfit(row):
        return why
    if row["table"] and not row.get("look_ups", True):
        return TABLE_SAID
    if row.get("cannot_mix"):
        return str(row["cannot_mix"]).partition(":")[0]
    if row.get("mixed_across") and edges_decide(row["needs"]):
        return EDGE_SAID
    most, once = row["most_instructions"], row["slots_once"]
    if most is not None and once is None:
        return "issue slots not known"
    if most is not None and once > most:
        return f"more than {most} issue slots"
    if loss_db(row) == math.inf:
        return f"{NO_FIGURE} {row['aim']}"
    return ""


def edges_decide(needs: str | None) -> bool:
    """Whether neighbouring pixels may belong to different surfaces: true unless only a hemisphere is needed, as for a
    normal map, whose texels belong to one surface."""
    return needs != "hemisphere"


def lost(row: Row) -> str:
    """Return a phrase on the share of normals outside an encoding's domain; empty if all are inside."""
    share = row["lost_percent"]
    return f"cannot represent normals that {BEYOND[row['domain']]}: {shown_share(share)} of the set" if share else ""


def shown_share(percent: float) -> str:
    """Return a percentage above 0 as text that never reads as 0: `1.2%` or "less than 0.01%"."""
    return f"{percent:.2g}%" if percent >= 0.01 else "less than 0.01%"


def groups(rows: Sequence[Row]) -> dict[tuple[str, str, str], list[Row]]:
    """Return the rows grouped by the question that they answer: the requested storage or bytes with the rounding, the
    set of normals, and the scenes."""
    by_question: dict[tuple[str, str, str], list[Row]] = {}
    for row in rows:
        by_question.setdefault((asked_of(row), row["normals"], row["scene"]), []).append(row)
    return by_question


def asked_of(row: Row) -> str:
    """Return the requested storage or bytes and the rounding, in words; rounding to nearest is not mentioned."""
    rounding = row.get("rounding") or "nearest"
    return row["asked"] if rounding == "nearest" else f"{row['asked']} with {rounding} rounding"


def answered(rows: Sequence[Row]) -> list[Row]:
    """Return the rows of each question with `left_out`, `front` and `place`: first the rows that qualify, in order,
    then the others. From other storages of the same bytes, only a row that is much better is kept."""
    return [row for group in groups(rows).values() for row in _answered_rows(group)]


def _answered_rows(group: Sequence[Row]) -> list[Row]:
    judged = [row | {"left_out": why_left_out(row) or None} for row in group]
    judged = _unpriced(_rows_with_holes(judged))
    fit, tied = _with_ties(sorted((row for row in judged if not row["left_out"] and not row["beside"]), key=order))
    places = _places(fit)
    for index in tied:
        places[index].append(TIE)
    ranked = [
        row | {"front": not any(beats(other, row) for other in fit), "place": _place_text(row, places[i])}
        for i, row in enumerate(fit)
    ]
    inside = _only_inside(judged, ranked[:1])
    others = [
        row | {"front": False, "place": _place_text(row, [INSIDE] if row is inside else [])}
        for row in judged
        if row["left_out"] and not row["beside"]
    ]
    return [*ranked, *_elsewhere_rows(judged, fit), *others]


def _with_ties(fit: list[Row]) -> tuple[list[Row], list[int]]:
    """Return the qualifying rows in order, except that the cheapest row whose images tie with the best comes first;
    and the indices of the other tied rows."""
    if not fit or fit[0]["aim"] != "image" or order(fit[0])[0] != 1:
        return fit, []
    tied = [row for row in fit[1:] if score(row) - score(fit[0]) < clear_gap_db(fit[0], row)]
    first = min([fit[0], *tied], key=lambda row: (price(row), _bits(row), score(row)))
    rows = [first, *(row for row in fit if row is not first)]
    return rows, [i for i, row in enumerate(rows) if i and (row is fit[0] or any(row is other for other in tied))]


def _only_inside(judged: Sequence[Row], best: Sequence[Row]) -> Row | None:
    """Return the best encoding that survives mixing inside a surface but not across an edge; None unless it is
    clearly better than the answer."""
    codes = [row for row in judged if row["left_out"] == EDGE_SAID and not row["hole"] and not row["beside"]]
    first = min(codes, key=order, default=None)
    return first if first and all(is_clearly_better(first, row) for row in best) else None


def _place_text(row: Row, places: Sequence[str]) -> str | None:
    return ", ".join([*places, *([AGAINST] if row["against"] else [])]) or None


def _rows_with_holes(rows: Sequence[Row]) -> list[Row]:
    """Return the rows with a description of their hole; rows with a hole are excluded. A hole is relative to the
    smallest error in the storage, over all encodings that could be the answer, whatever their cost and whether they
    survive mixing."""
    least: dict[str, float] = {}
    for row in rows:
        if not why_unfit(row) and (angle := largest(row)) is not None:
            least[row["storage"]] = min(angle, least.get(row["storage"], math.inf))
    judged: list[Row] = []
    for row in rows:
        hole = _hole_text(row, least.get(row["storage"], math.inf))
        is_why = hole and (not row["left_out"] or str(row["left_out"]).startswith(NO_FIGURE))
        judged.append(row | {"hole": hole or None, "left_out": HOLE_SAID if is_why else row["left_out"]})
    return judged


def _hole_text(row: Row, least: float) -> str:
    """Return the error of an encoding's hole and the normal at which it occurs, as text; empty if it has no hole."""
    angle = largest(row)
    if why_unfit(row) or row["accept_holes"] or angle is None or angle <= min(HOLE * least, LOST_DEG):
        return ""
    worst = [f"{float(x):.2f}" for x in re.findall(r"[-+.\de]+", str(row.get("worst_normal") or ""))]
    return f"{angle:.3g}°" + (f" at {' '.join(worst)}" if worst else "")


def _unpriced(rows: Sequence[Row]) -> list[Row]:
    """Return the rows; qualifying rows of unknown cost are excluded if others have a known cost."""
    is_priced = any(row["slots"] is not None for row in rows if not row["left_out"])
    return [row | {"left_out": LOOPS_SAID} if is_priced and _lacks_price(row) else row for row in rows]


def _lacks_price(row: Row) -> bool:
    return row["slots"] is None and not row["left_out"]


def _places(fit: Sequence[Row]) -> list[list[str]]:
    """Return the names of the places of each qualifying encoding, in the given order: best, cheaper, more accurate
    and so on."""
    places: list[list[str]] = [[] for _ in fit]
    if not fit:
        return places
    for index in [i for i, row in enumerate(fit) if not row.get("packed")][: bool(fit[0].get("packed"))]:
        places[index].append(PLAIN)
    best, rungs = fit[0], [i for i, row in enumerate(fit) if i and not any(beats(other, row) for other in fit)]
    places[0].append(BEST)
    exact = min(range(len(fit)), key=lambda rank: (figures(fit[rank]), rank))
    if exact and is_clearly_better(fit[exact], best):
        places[exact].append(MOST_EXACT)
    above = [i for i in rungs if is_clearly_better(fit[i], best) and i != exact]
    below = [i for i in rungs if loss_db(fit[i]) >= loss_db(best)]
    for place, chosen in (
        (MORE_EXACT, _rungs_apart(sorted(above, key=lambda rank: -loss_db(fit[rank])), fit)[:MOST_RUNGS]),
        (CHEAPER, [i for i in below if _is_cheaper(fit[i], best) and fit[i]["bits"] == best["bits"]][:1]),
        (FEWER_BITS, _first_of_each_size([i for i in below if _is_smaller(fit[i], best)], fit)[:MOST_RUNGS]),
    ):
        for index in chosen:
            places[index].append(place)
    return places


def is_same_price(candidate: Row, other: Row) -> bool:
    """Whether two costs differ by less than a tenth of a doubling."""
    return abs(math.log2(price(candidate) / price(other))) < SAME_PRICE


def _is_cheaper(row: Row, best: Row) -> bool:
    return price(row) < price(best) and not is_same_price(row, best)


def _is_smaller(row: Row, best: Row) -> bool:
    """Whether an encoding takes fewer bits than the best at about the same cost or less."""
    return _bits(row) < _bits(best) and (price(row) <= price(best) or is_same_price(row, best))


def _bits(row: Row) -> float:
    return row["bits"] or math.inf


def _first_of_each_size(chosen: Sequence[int], fit: Sequence[Row]) -> list[int]:
    """Return the index of the first alternative for each number of bits, with the most bits first."""
    first = {_bits(fit[i]): i for i in reversed(chosen)}
    return [first[size] for size in sorted(first, reverse=True)]


def _rungs_apart(chosen: Sequence[int], fit: Sequence[Row]) -> list[int]:
    """Return the indices to keep: each alternative must be clearly better than the previous one that is kept."""
    kept: list[int] = []
    for index in chosen:
        if not kept or is_clearly_better(fit[index], fit[kept[-1]]):
            kept.append(index)
    return kept


def is_much_better(row: Row, best: Row) -> bool:
    """Whether an encoding in another storage is worth mentioning: it is better by a bit per component, its largest
    error is no larger, and the best encoding is not already far more accurate than required."""
    worst = largest_mixed(best) or math.inf
    is_worse, is_needless = (largest_mixed(row) or math.inf) > worst, 2 * worst * NEEDLESS <= best["enough"]
    return loss_db(best) - loss_db(row) >= MUCH_BETTER_DB and not is_worse and not is_needless


def _elsewhere_rows(judged: Sequence[Row], fit: Sequence[Row]) -> list[Row]:
    """Return a list with the best encoding in another storage of the same bytes, if it is much better than the
    answer; otherwise an empty list."""
    others = [row for row in judged if row["beside"] and not row["left_out"]]
    better = [row for row in others if fit and is_much_better(row, fit[0])]
    kept = sorted(better, key=lambda row: order(row)[:-TIES])[:1]
    return [row | {"front": False, "place": ELSEWHERE} for row in kept]
