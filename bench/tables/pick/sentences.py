"""The answer in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from ....encodings.catalogue import ENCODINGS
from .answer import (
    BEST,
    CHEAPER,
    ELSEWHERE,
    FEWER_BITS,
    INDISTINGUISHABLE_DB,
    MORE_EXACT,
    MOST_EXACT,
    TEXEL_DEG,
    beats,
    doublings,
    floor,
    images,
    is_enough,
    largest,
    loss_db,
    lost,
    price,
)

Row = dict[str, Any]

AIM_TITLES = {"angle": "mean error", "worst": "largest error", "image": "worst image", "cost": "mean error"}
# The rungs, as a sentence begins with each.
RUNGS = {MORE_EXACT: "More exact", MOST_EXACT: "Most exact", CHEAPER: "Cheaper", FEWER_BITS: "Fewer bits"}
# Reasons for which more codes are left out than this are counted instead of named.
MOST_NAMED = 6
UPSAMPLE = "upsample"
# How far the mirror's image is, in metres.
FAR = 10.0


def sentences(group: Sequence[Row]) -> list[str]:
    """What the rows of one question say, as `answered` gives them: the answer, then paragraphs of a few sentences."""
    best = next((row for row in group if BEST in _places(row)), None)
    where = f"{group[0]['asked']}, on {group[0]['normals']}"
    if best is None:
        return [f"{where}: no code qualifies{_constraints(group[0])}.", *left_out(group)]
    others = [_elsewhere(row, best) for row in group if ELSEWHERE in _places(row)]
    made = [" ".join([f"{where}: take {_called(best)}.", *others])]
    made += [f"{_figures(best)} {_seen(best)}", f"{_price(best)} {_bits(best)}{_reservation(best)}"]
    made += list(filter(None, [_images(best), _mixing(best)]))
    made += rungs(group, best)
    made += [_against(row, best) for row in group if row["against"] and row is not best]
    return [*made, *left_out(group)]


def rungs(group: Sequence[Row], best: Row) -> Iterator[str]:
    """A sentence for each rung of the ladder."""
    for place, title in RUNGS.items():
        yield from (f"{title}: {_rung(row, best)}" for row in group if place in _places(row))


def _places(row: Row) -> list[str]:
    return str(row.get("place") or "").split(", ")


def _called(row: Row) -> str:
    """A code's name, with its storage where several were asked for."""
    return row["encoding"] if row["asked"] == row["storage"] else f"{row['encoding']} in {row['storage']}"


def _constraints(row: Row) -> str:
    said = [f"at most {row['most_instructions']} issue slots"] if row["most_instructions"] is not None else []
    said += [f"for {row['needs']}"] if row["needs"] else []
    said += [f"that survives {row['mixing'].replace(',', ', ')}"] if row["mixing"] else []
    return f" ({', '.join(said)})" if said else ""


def degrees(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3g}°"


def decibels(value: float | None) -> str:
    return "no figure" if value is None else "no difference" if math.isinf(value) else f"{value:.1f} dB"


def _figures(row: Row) -> str:
    return f"Its mean error is {degrees(row['angle_mean_deg'])}, {_largest(row)}."


def _largest(row: Row) -> str:
    """The supremum where it was searched, else what was met, which may be less."""
    return f"its largest {degrees(largest(row))}" + (" of those met" if row["angle_sup_deg"] is None else "")


def _seen(row: Row) -> str:
    """How far reflections move. A mirror turns a ray by twice the angle that its normal is turned."""
    moved = [2 * value for value in (row["angle_mean_deg"], largest(row)) if value is not None]
    if len(moved) < 2:
        return ""
    texel = f"a texel of a 1k environment map ({TEXEL_DEG:.2f}°)"
    if is_enough(row):
        return f"That is enough: a reflection moves by at most {degrees(moved[1])}, and {texel} is more."
    texels = " and ".join(f"{value / TEXEL_DEG:.1f}" for value in moved)
    far = " and ".join(_length(100 * FAR * math.tan(math.radians(min(value, 89.0)))) for value in moved)
    said = f"A mirror shows it: a reflection moves by {degrees(moved[0])} in the mean and up to {degrees(moved[1])}"
    return f"{said}, which is {texels} texels of a 1k environment map, or {far} cm at {FAR:g} m."


def _length(value: float) -> str:
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}"


def _price(row: Row) -> str:
    if row["slots"] is None:
        return "What it costs is not known on this machine."
    parts = f"{row['encode_slots']:g} issue slots to encode and {row['decode_slots']:g} to decode"
    parts += f" on {row['dearest_family']}"
    readers = f"{row['readers']} reader{'s' * (row['readers'] != 1)}"
    whole = f"{row['slots']:g} with {readers}"
    if doublings(row):
        more = f"{price(row) / floor(row):.2g} times what hides behind the traffic of the target"
        return f"It takes {parts}: {whole}, {more}{_table(row)}."
    return f"It takes {parts}: {whole}, all of which hide behind the traffic of the target{_table(row)}."


def _table(row: Row) -> str:
    return ", and it reads a table" if row["table"] else ""


def _bits(row: Row) -> str:
    free = f"{row['free_bits']} stay free" if row["free_bits"] else "none stays free"
    return f"It occupies {_of_bits(row)}; {free}."


def _of_bits(row: Row) -> str:
    has_sign = row["encoding"] in ENCODINGS and ENCODINGS[row["encoding"]].sign_bits
    return f"{row['bits']} bits" + (", one of them in the sign of the depth" if has_sign else "")


def _images(row: Row) -> str:
    """The worst of a row's images; empty where there is none."""
    found = images(row)
    if not found:
        return ""
    (scene, power), worst = min(found.items(), key=lambda item: item[1])
    scenes = " and ".join(dict.fromkeys(name for name, _ in found))
    effects = f" with {row['effects']}" if row.get("effects") else ""
    if worst > INDISTINGUISHABLE_DB:
        return f"Images of {scenes}{effects} show no difference: the worst has {decibels(worst)}."
    return f"Of images of {scenes}{effects} the worst is {scene} at power {power}: {decibels(worst)}."


def _mixing(row: Row) -> str:
    """What mixing does to a code that survives it inside a surface; empty where it was not asked for."""
    if not row["mixing"]:
        return ""
    upsampled = "Upsampling decodes each texel before it weighs it, which no code minds. "
    said = upsampled if UPSAMPLE in row["mixing"].split(",") else ""
    across = row.get("mixed_across")
    return said + (
        f"Inside a surface it survives {_uses(row)}, but across an edge not: {across}."
        if across
        else f"It survives {_uses(row)}, inside a surface and across an edge."
    )


def _uses(row: Row) -> str:
    return " and ".join(row["mixing"].split(","))


def _reservation(row: Row) -> str:
    return f" Note the {lost(row)}." if row["lost_percent"] else ""


def _gain(row: Row, best: Row) -> str:
    """How much better or worse a code is than the answer."""
    gain = loss_db(best) - loss_db(row)
    if math.isnan(gain) or abs(gain) < 0.05:
        return "as exact"
    return f"{abs(gain):.1f} dB {'better' if gain > 0 else 'worse'} by the {AIM_TITLES[row['aim']]}"


def _rung(row: Row, best: Row) -> str:
    """A rung of the ladder: what it gains, and for what price."""
    said = f"{_called(row)}, {_gain(row, best)} (mean {degrees(row['angle_mean_deg'])}, {_largest(row)})"
    return f"{said}, {_priced(row, best)}{_spared(row, best)}."


def _priced(row: Row, best: Row) -> str:
    if row["slots"] is None:
        return "for an unknown price"
    ratio, table = price(row) / price(best), " and a table" if row["table"] and not best["table"] else ""
    if ratio == 1:
        return f"for the same price{table}"
    slots = f"for {row['slots']:g} issue slots{table}, {ratio:.2g} times the price"
    gain = loss_db(best) - loss_db(row)
    return f"{slots}: {gain / math.log2(ratio):.1f} dB a doubling" if ratio > 1 and gain > 0 else slots


def _spared(row: Row, best: Row) -> str:
    if row["bits"] == best["bits"]:
        return ""
    return f", in {_of_bits(row)}: {row['free_bits']} stay free" if row["free_bits"] else f", in {_of_bits(row)}"


def _elsewhere(row: Row, best: Row) -> str:
    """Another storage of the same bytes that is much better."""
    count = best["bytes"]
    gain = loss_db(best) - loss_db(row)
    free = f"{row['free_bits']} bits stay free" if row["free_bits"] else "no bit stays free"
    where = "packed into the same texel" if row["same_target"] else f"of the same {count} bytes"
    said = f"In {row['storage']}, {where}, {row['encoding']} is {gain:.0f} dB better"
    return f"{said} (mean {degrees(row['angle_mean_deg'])}), and {free}."


def _against(row: Row, best: Row) -> str:
    if row["left_out"]:
        hole = f" ({row['hole']})" if row.get("hole") else ""
        return f"{row['encoding']} does not qualify: {row['left_out']}{hole}."
    said = f"{row['encoding']}: {_rung(row, best).removesuffix('.')}; {_images(row) or 'no image.'}"
    if row["front"]:
        return f"{said} No other code beats it in every figure."
    return f"{said} {best['encoding']} beats it in every figure." if beats(best, row) else said


def left_out(group: Sequence[Row]) -> Iterator[str]:
    """Which codes do not qualify, and why."""
    reasons: dict[str, list[Row]] = {}
    for row in group:
        if row["left_out"] and not row["against"]:
            reasons.setdefault(row["left_out"], []).append(row)
    if reasons:
        yield "Left out: " + "; ".join(_with_reason(rows, why) for why, rows in reasons.items()) + "."


def _with_reason(rows: Sequence[Row], why: str) -> str:
    """The codes that are left out for a reason; where its details differ, those of the first."""
    names = [f"{_called(row)} {row['hole']}" if row.get("hole") else _called(row) for row in rows]
    detail = str(rows[0].get("cannot_mix") or "").partition(":")[2]
    if not detail:
        return f"{_named(names)} ({why})"
    return f"{_named(names)} ({why}:{detail})" if len(rows) == 1 else f"{_named(names)} ({why}; {names[0]}:{detail})"


def _named(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) <= MOST_NAMED else f"{len(names)} codes"
