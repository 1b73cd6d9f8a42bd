"""The answer in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import fewer_bits
from ...ground.machine.systems.people import command_line
from ..table import Row
from .answer import (
    BEST,
    CHEAPER,
    ELSEWHERE,
    ERRORS,
    FEWER_BITS,
    HIDDEN_SLOTS,
    INDISTINGUISHABLE_DB,
    INSIDE,
    MORE_EXACT,
    MOST_EXACT,
    PLAIN,
    STEP,
    TIE,
    answered,
    asked_of,
    beats,
    floor,
    images,
    is_enough,
    is_much_better,
    is_same_price,
    largest,
    largest_mixed,
    loss_db,
    lost,
    mean,
    order,
    places_of,
    price,
    why_unfit,
)
from .table import TEXEL_DEG

AIM_TITLES = {"angle": "mean error", "worst": "largest error", "image": "the worst image", "cost": "mean error"}
# Percent of the visible normals of a scene, from which on the first line says that they are not held.
MUCH_LOST = 1.0
# The rungs, as a sentence begins with each.
RUNGS = {
    MORE_EXACT: "More accurate",
    MOST_EXACT: "Most accurate (within 0.1 dB)",
    CHEAPER: "Cheaper",
    FEWER_BITS: "Fewer bits",
    INSIDE: "Inside a surface only",
    PLAIN: "In plain channels",
}
BETTER_IMAGE = {MORE_EXACT: "Better image", MOST_EXACT: "Best image"}
# Reasons for which more codes are left out than this are counted instead of named.
MOST_NAMED = 6
UPSAMPLE = "upsample"
# Axis-aligned normals that come back closer are exact.
EXACT_DEG = 1e-3
# What an encoder and its readers wait for anyway.
TRAFFIC = "memory traffic hides"
# From so far on a reflection is not the same picture moved.
ELSEWHERE_DEG = 30.0
UNKNOWN_COST = "The cost is not known on this machine."
# What else may be supposed of the issue slots of a pass that take no time, and shares of what is enough.
FREE_SLOTS, ENOUGH = (8, 32), (0.5, 1.5)
# How far the mirror's image is, in metres, and the map that it shows.
FAR, MAP = 10.0, "a 1k environment map"
OF_SPACE = {
    "hemisphere": "For tangent space and terrain, where every normal with z >= 0 is equally likely. Normals of a map "
    "are near z: `normalbench maps` measures them in texture formats. In world space a G-buffer must store every "
    "direction.",
    "view": "In view space, an encoding of the directions up to 100° from the line of sight gains at most 2.3 dB over "
    "an encoding of all directions. But its steps crawl when the camera turns: 26.0 dB on a slow mirror panel, 36.6 dB "
    "in world space.",
}


def sentences(group: Sequence[Row]) -> list[str]:
    """Return texts on the rows of one question, as returned by `answered`: the answer, then paragraphs of a few
    sentences, and last the codecs that do not qualify."""
    return [*told(group), *left_out(group)]


def told(group: Sequence[Row]) -> list[str]:
    """Return the same texts as `sentences`, without the codecs that do not qualify."""
    best = next((row for row in group if BEST in places_of(row)), None)
    if best is None:
        return [f"{question(group[0])}: no encoding qualifies{_constraints_text(group[0])}.", *_instead(group)]
    lines = [
        _first_sentences(group, best),
        f"{_error_sentences(best)} {_seen_sentences(best)}",
        f"{_price_sentence(best)} {_bits_sentence(best)}{_reservation_sentence(best)}",
    ]
    lines += list(filter(None, [_images_text(best), _mixing_text(best)]))
    lines += [*filter(None, [_space_sentences(best)]), *rungs(group, best), *_hangs_on(group, best)]
    lines += [f"Images: {best['image_conditions']}."] if best.get("image_conditions") and images(best) else []
    return lines + [_rival_sentence(row, best) for row in group if row["against"] and row is not best]


def _first_sentences(group: Sequence[Row], best: Row) -> str:
    """Return sentences on the recommended encoding, the normals that it cannot represent, and encodings in other
    storages that are much better."""
    others = [*not_held(best), *(_elsewhere_text(row, best) for row in _much_better(group, best))]
    return " ".join([f"{question(best)}: take {called(best)}.", *others])


def in_short(group: Sequence[Row]) -> list[str]:
    """Return texts on the recommended encoding, its errors and its cost, without the alternatives, which a table
    lists; all sentences if no encoding qualifies."""
    best = next((row for row in group if BEST in places_of(row)), None)
    if best is None:
        return [*told(group), *left_out(group)]
    first = " ".join([_first_sentences(group, best), *_of_maps(best)])
    takes = UNKNOWN_COST
    if best["slots"] is not None:
        takes = f"{_slots_text(best)}: {best['slots']:g} with {best['readers']} decoding passes."
    pole = _pole_sentence(best, "").strip() if images(best) else ""
    others = [_mixing_text(best), _reservation_sentence(best).strip(), _space_sentences(best)]
    others += [_rival_sentence(row, best) for row in group if row["against"] and row is not best]
    return [
        f"{first} {_error_sentences(best)}",
        " ".join(filter(None, [takes, _bits_sentence(best), pole])),
        *filter(None, others),
    ]


def conditions(group: Sequence[Row]) -> Iterator[str]:
    """Yield a line on the number of encodings that were left out and, if there are images, a line on how they were
    rendered; nothing if no encoding qualifies."""
    if not any(BEST in places_of(row) for row in group):
        return
    count = sum(bool(row["left_out"]) and not row["against"] for row in group)
    more = f"Left out: {count} of {len(group)} codecs. " if count else ""
    yield f"{more}Use -v for the reasons and for the gain of each alternative."
    shown = next((row["image_conditions"] for row in group if row.get("image_conditions") and images(row)), "")
    if shown:
        yield f"Images: {shown}."


def _of_maps(best: Row) -> Iterator[str]:
    """Yield a note that texture maps are a separate question, if normals with z >= 0 are filtered."""
    if best["needs"] == "hemisphere" and "filter" in (best.get("mixing") or "").split(","):
        yield "Figures are for all normals with z >= 0. Normals of a texture map are near z: use normalbench maps."


def _space_sentences(best: Row) -> str:
    """Return sentences on the requested space of the normals; empty if no such space was requested."""
    if best["needs"] not in OF_SPACE:
        return ""
    angles = best.get("image_view_angles")
    return OF_SPACE[best["needs"]] + (f" {angles}." if angles else "")


def question(row: Row) -> str:
    """Return the question as text: the requested storage or bytes, and the normals that were measured."""
    return f"{asked_of(row)}, on {row['normals']}"


def not_held(best: Row) -> Iterator[str]:
    """Yield a sentence on the share of visible normals that the answer cannot represent, if this share is large."""
    lost = best.get("image_lost_percent") or 0.0
    if lost >= MUCH_LOST:
        yield f"It cannot represent {lost:.2g}% of the visible normals in {best['image_lost_scene']}."


def _much_better(group: Sequence[Row], best: Row) -> list[Row]:
    """Return the rows in other storages that are worth a sentence: rows with the place ELSEWHERE, otherwise at most
    one alternative that is much more accurate."""
    others = [row for row in group if ELSEWHERE in places_of(row)]
    rungs = [row for row in group if {MORE_EXACT, MOST_EXACT} & {*places_of(row)} and row["storage"] != best["storage"]]
    return others or sorted((row for row in rungs if is_much_better(row, best)), key=order)[:1]


def _instead(group: Sequence[Row]) -> Iterator[str]:
    """Yield sentences on alternatives if no encoding qualifies."""
    if not group[0]["needs"] and all(row["lost_percent"] for row in group if not row["beside"]):
        yield "If normals have z >= 0 or face the viewer, name their space: --domain tangent, terrain, map or view."
    if group[0]["mixing"]:
        for row in (row for row in group if INSIDE in places_of(row)):
            code_text = f"{called(row)}, mean error {degrees(mean(row))}"
            yield f"{RUNGS[INSIDE]}: {code_text}. Across an edge: {row['mixed_across']}."
        uses = group[0]["mixing"].split(",")
        if {*uses} & {"blend", "resolve"}:
            yield "Hardware blending and resolving require three numbers: in rgb10a2, xyz_renormalised survives both."
        if "filter" in uses:
            yield f"Decode each texel and mix the normals instead ({UPSAMPLE}). This works with every encoding."
            if group[0]["needs"] not in ("hemisphere", "view"):
                yield "In tangent space (--domain tangent) half of the sphere has no seam."
        return
    priced = [row for row in group if not row["beside"] and not why_unfit(row) and row["slots_once"] is not None]
    if priced and (most := group[0]["most_instructions"]) is not None:
        nearest = min((row for row in priced if not row.get("hole")), key=_slots_once, default=None)
        if nearest:
            phrase = f"{called(nearest)}, with {_slots_once(nearest):g} issue slots"
            yield f"The nearest encoding without a hole is {phrase}."
        holed = min((row for row in priced if row.get("hole")), key=_slots_once, default=None)
        if holed and _slots_once(holed) <= most:
            phrase = f"{called(holed)}, with {_slots_once(holed):g} issue slots and a hole of {holed['hole']}"
            yield f"With --accept-holes, the answer is {phrase}."


def _slots_once(row: Row) -> float:
    return row["slots_once"]


def rungs(group: Sequence[Row], best: Row) -> Iterator[str]:
    """Yield a sentence on encodings whose images tie with the best, if any, and a sentence on each alternative."""
    titles = RUNGS | (BETTER_IMAGE if best["aim"] == "image" else {})
    if tied := [called(row) for row in group if TIE in places_of(row)]:
        yield (
            f"Tied with {', '.join(tied)}: the images differ by less than {STEP:g} dB, or by chance. "
            "The cheapest encoding is recommended."
        )
    for place, title in titles.items():
        yield from (f"{title}: {_rung_text(row, best)}" for row in group if place in places_of(row))


def _hangs_on(group: Sequence[Row], best: Row) -> Iterator[str]:
    """Yield one sentence on the answers under constants near the assumed ones; nothing if they do not differ."""
    worth, enough = best["worth"], best["enough"]
    supposed = [
        ({"worth": worth + change}, f"at {worth + change:g} dB per doubling") for change in (-1, 1) if worth > 1
    ]
    supposed += [({"hidden_slots": slots}, f"if {slots} slots per pass are free") for slots in FREE_SLOTS]
    supposed += [({"enough": share * enough}, f"with --enough {share * enough:.2g}") for share in ENOUGH if enough]
    others: dict[str, list[str]] = {}
    for values, assumption in supposed:
        rows = answered([{**row, **values} for row in group])
        code = next((called(row) for row in rows if BEST in places_of(row)), "")
        if code and code != called(best):
            others.setdefault(code, []).append(assumption)
    if others:
        alternatives = "; ".join(f"{code} {' or '.join(assumptions)}" for code, assumptions in others.items())
        yield f"Under other assumptions: {alternatives}."


def called(row: Row) -> str:
    """Return an encoding's name, followed by its storage unless this storage was requested."""
    return row["encoding"] if row["asked"] == row["storage"] else f"{row['encoding']} in {row['storage']}"


def _constraints_text(row: Row) -> str:
    limits = constraints(row)
    return f" ({', '.join(limits)})" if limits else ""


def constraints(row: Row) -> list[str]:
    """Return the constraints on an encoding, in words."""
    limits = [f"at most {row['most_instructions']} issue slots"] if row["most_instructions"] is not None else []
    limits += [f"for {row['needs']}"] if row["needs"] else []
    return limits + ([f"that survives {row['mixing'].replace(',', ', ')}"] if row["mixing"] else [])


def degrees(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.3g}°"


def decibels(value: float | None) -> str:
    return "no figure" if value is None else "no difference" if math.isinf(value) else f"{value:.1f} dB"


def _error_sentences(row: Row) -> str:
    sentence = f"Mean error {degrees(row['angle_mean_deg'])}, {_largest_text(row)}."
    axes = row.get("angle_axes_deg")
    if axes is None:
        return sentence
    off = "exact" if axes < EXACT_DEG else f"off by up to {degrees(axes)}"
    return f"{sentence} Axis-aligned floors and walls are {off}."


def _largest_text(row: Row) -> str:
    """Return text on the supremum if it is known, otherwise on the largest sampled angle, which may be smaller."""
    return f"largest {'sampled ' * (row['angle_sup_deg'] is None)}{degrees(largest(row))}"


def _moved_deg(row: Row) -> list[float]:
    """Return the mean and the largest angle by which a mirror's reflection moves: twice the error of its normal."""
    return [min(2 * value, 180.0) for value in (mean(row), largest_mixed(row)) if value is not None]


def _seen_sentences(row: Row) -> str:
    moved = _moved_deg(row)
    if len(moved) < 2:
        return ""
    text = f"A mirror's reflection moves by {degrees(moved[0])} on average and by at most {degrees(moved[1])}: "
    if moved[1] >= ELSEWHERE_DEG:
        return f"{text}it shows a different place."
    texels = " and ".join(f"{value / TEXEL_DEG:.2g}" for value in moved)
    far = " and ".join(_length_text(100 * FAR * math.tan(math.radians(value))) for value in moved)
    text += f"{texels} texels of {MAP}, {far} cm at {FAR:g} m."
    enough = f" That is within --enough {row['enough']:.2g}°; banding may be visible." if is_enough(row) else ""
    return f"{text}{enough} To find the roughness above which banding is invisible, run: {_roughness_command(row)}"


def _roughness_command(row: Row) -> str:
    """Return the command line that finds the roughness above which an encoding's banding is invisible."""
    words = ["normalbench", "roughness", "--encoding", row["encoding"], "--storage", row["storage"]]
    rounding = row.get("rounding") or "nearest"
    return command_line(words if rounding == "nearest" else [*words, "--rounding", rounding])


def _length_text(value: float) -> str:
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}"


def _price_sentence(row: Row) -> str:
    if row["slots"] is None:
        return UNKNOWN_COST
    passes = f"{row['readers']} decoding pass{'es' * (row['readers'] != 1)}"
    table = " It reads a lookup table." if row["table"] else ""
    return f"{_slots_text(row)}. With {passes} this counts as {_of_hidden(row)}.{table}"


def _slots_text(row: Row) -> str:
    """Return text on the slots to encode and to decode, the GPU family and the compiler of recorded slots."""
    slots = f"{row['encode_slots']:g} issue slots to encode and {row['decode_slots']:g} to decode"
    elsewhere = f" (recorded with {row['recorded_by']}; no compiler here)" if row["recorded_by"] else ""
    return f"{slots} on {row['dearest_family']}{elsewhere}"


def _of_hidden(row: Row) -> str:
    """Return text on the cost, compared with the slots that memory traffic hides."""
    if price(row) == floor(row):
        return f"{floor(row):g}, the minimum: {TRAFFIC} {HIDDEN_SLOTS} slots per pass"
    return f"{price(row):g}, {price(row) / floor(row):.2g} times the slots that {TRAFFIC}"


def _bits_sentence(row: Row) -> str:
    free = f"; {row['free_bits']} are free" if row["free_bits"] else ""
    return f"Uses {'' if free else 'all '}{_bits_text(row)}{free}."


def _bits_text(row: Row) -> str:
    has_sign = row["encoding"] in ENCODINGS and ENCODINGS[row["encoding"]].sign_bits
    codes = fewer_bits(row["bits"], row.get("code_bits"))
    sign = ", one of them in the sign of the depth" if has_sign else ""
    return f"{row['bits']} bits{sign}" + (f", for codes of {codes}" if codes else "")


def _images_text(row: Row) -> str:
    """Return a sentence on the worst of a row's images; empty if the row has no images."""
    by_scene = images(row)
    if not by_scene:
        return ""
    (scene, power), worst = min(by_scene.items(), key=lambda item: item[1])
    scenes = " and ".join(dict.fromkeys(name for name, _ in by_scene))
    effects = f" with {row['effects']}" if row.get("effects") else ""
    lost = row.get("image_lost_percent")
    beyond = f" Images leave out the normals that it cannot represent, up to {lost:.2g}%." if lost else ""
    if worst > INDISTINGUISHABLE_DB:
        return f"Images of {scenes}{effects} show no difference: the worst has {decibels(worst)}.{beyond}"
    where = f"{scene} at power {power}" if power else scene
    which = f"Image of {scenes}{effects}" if scenes == where else f"Worst image of {scenes}{effects}: {where}"
    return f"{which}, {decibels(worst)}{_spread_text(row)}.{_pole_sentence(row)}{beyond}"


def _spread_text(row: Row) -> str:
    """Return the standard error of a row's images in parentheses, after a space; empty if not known."""
    error = row.get("image_se_db")
    return f" (standard error {error:.1f} dB over orientations)" if error is not None else ""


def _pole_sentence(row: Row, names: str | None = None) -> str:
    """Return a sentence, after a space, on where to point an encoding's z axis; empty if this matters no more than
    chance.

    Args:
        names: text on how to name the orientation; None for the names in the catalogue."""
    pole, cost = row.get("image_pole"), row.get("image_wrong_pole_db") or 0.0
    if not pole or cost < max(STEP, ERRORS * (row.get("image_se_db") or 0.0)):
        return ""
    ups = "yz" if pole == "y" else "zy"
    name, known = row["encoding"], ENCODINGS.get(row["encoding"])
    if names is None and known and known.can_turn:
        names = f": {name}:axis=y if {ups[0]} is up in your world, {name} if {ups[1]} is"
    return f" Point its {axis_text(pole)}{names or ''}; the worst axis costs {cost:.1f} dB."


def axis_text(pole: str) -> str:
    """Return where an encoding's z axis points if it is along an axis of the world, x, y or z."""
    return f"z axis {'up' if pole == 'y' else 'sideways'}"


def _mixing_text(row: Row) -> str:
    """Return text on how mixing affects a codec that survives it; empty if no mixing was requested."""
    if not row.get("mixing"):
        return ""
    upsampled = "Upsampling decodes each texel before weighting it, which works with every encoding. "
    opening = upsampled if UPSAMPLE in row["mixing"].split(",") else ""
    left = f"then mean error {degrees(mean(row))}, largest {degrees(largest_mixed(row))}"
    edges = f". Across an edge: {row['mixed_across']}" if row["mixed_across"] else " and across an edge"
    return f"{opening}It survives {_uses_text(row)}, inside a surface ({left}){edges}."


def _uses_text(row: Row) -> str:
    return " and ".join(row["mixing"].split(","))


def _reservation_sentence(row: Row) -> str:
    return f" It {lost(row)}." if row["lost_percent"] else ""


def _gain_text(row: Row, best: Row) -> str:
    """Return text on a codec's gain or loss in decibels over the answer; "equally accurate" below 0.05 dB."""
    gain = loss_db(best) - loss_db(row)
    if math.isnan(gain) or abs(gain) < 0.05:
        return "equally accurate"
    return f"{abs(gain):.1f} dB {'better' if gain > 0 else 'worse'} in {AIM_TITLES[row['aim']]}"


def _rung_text(row: Row, best: Row) -> str:
    """Return text on an alternative: its gain, its cost and, if different, its bits."""
    text = f"{called(row)}, {_gain_text(row, best)} ({_errors_text(row)})"
    return f"{text}, {_price_text(row, best)}{_bits_clause(row, best)}."


def _errors_text(row: Row) -> str:
    if not row.get("mixing"):
        return f"mean {degrees(row['angle_mean_deg'])}, {_largest_text(row)}"
    return f"after {_uses_text(row)} mean {degrees(mean(row))}, largest {degrees(largest_mixed(row))}"


def _price_text(row: Row, best: Row) -> str:
    if row["slots"] is None:
        return "at an unknown cost"
    table = " and a lookup table" if row["table"] and not best["table"] else ""
    if is_same_price(row, best):
        return f"at the same cost{table}"
    if price(row) == floor(row):
        return f"within the {HIDDEN_SLOTS} slots per pass that {TRAFFIC}{table}"
    ratio, gain = price(row) / price(best), loss_db(best) - loss_db(row)
    text = f"at {ratio:.2g} times the cost ({price(row):g} slots){table}"
    if ratio <= 1 or gain <= 0 or is_enough(best):
        return text
    rate = gain / math.log2(ratio)
    tie = f", about --worth {row['worth']:g}, so the cheaper encoding is recommended" if rate >= row["worth"] else ""
    return f"{text}: {rate:.1f} dB per doubling{tie}"


def _bits_clause(row: Row, best: Row) -> str:
    if row["bits"] == best["bits"]:
        return ""
    return f", in {_bits_text(row)}: {row['free_bits']} are free" if row["free_bits"] else f", in {_bits_text(row)}"


def _elsewhere_text(row: Row, best: Row) -> str:
    """Return a sentence on an encoding that is much better in another storage of the same bytes."""
    begin, end = around_gain(row, degrees(mean(row)))
    return f"{begin}{loss_db(best) - loss_db(row):.0f}{end}"


def around_gain(row: Row, mean_text: str) -> tuple[str, str]:
    """Return the sentence on a codec in another storage as two parts: the text before and after its gain."""
    free = f"leaves {row['free_bits']} bits free" if row["free_bits"] else "uses all bits"
    begin = f"In {row['storage']}, also {row['bytes']} bytes, {row['encoding']} is "
    return begin, f" dB better (mean {mean_text}) and {free}."


def _rival_sentence(row: Row, best: Row) -> str:
    if row["left_out"]:
        hole = f" ({row['hole']})" if row.get("hole") else ""
        return f"{row['encoding']} does not qualify: {row['left_out']}{hole}."
    text = f"{row['encoding']}: {_rung_text(row, best).removesuffix('.')}; {_images_text(row) or 'no image.'}"
    if row["front"]:
        return f"{text} No other encoding beats it in every figure."
    return f"{text} {best['encoding']} beats it in every figure." if beats(best, row) else text


def left_out(group: Sequence[Row]) -> Iterator[str]:
    """Yield one sentence on the codecs that do not qualify, grouped by reason; nothing if all qualify."""
    reasons: dict[str, list[Row]] = {}
    for row in group:
        if row["left_out"] and not row["against"]:
            reasons.setdefault(row["left_out"], []).append(row)
    if reasons:
        yield "Left out: " + "; ".join(_with_reason(rows, why) for why, rows in reasons.items()) + "."


def _with_reason(rows: Sequence[Row], why: str) -> str:
    """Return text that names the codecs left out for a reason, with the details of the first codec."""
    # The example is the one that people would ask about.
    rows = sorted(rows, key=lambda row: (bool(row.get("hole")), loss_db(row)))
    names = [f"{called(row)} {row['hole']}" if row.get("hole") else called(row) for row in rows]
    detail = str(rows[0].get("cannot_mix") or "").partition(":")[2]
    if not detail:
        return f"{_names_text(names)} ({why})"
    return (
        f"{_names_text(names)} ({why}:{detail})"
        if len(rows) == 1
        else f"{_names_text(names)} ({why}; {names[0]}:{detail})"
    )


def _names_text(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) <= MOST_NAMED else f"{len(names)} codecs"
