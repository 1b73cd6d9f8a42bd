"""Likely mistakes in an encoder and its decoder, found by round trips of directions without any storage.

Each diagnosis is one line with a figure and an example direction.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from .....gbuffer.gl.device import Device
from ....ground.directions import circles, directions
from . import exact, folds, nearly
from .between import MOST, SAME_DEG, axes_of, step_between
from .cut_off import cut_off
from .domains import EXACT_DEG, HALVES, HEMISPHERE, SPHERE, Domain, asked, finite, guessed
from .halves import Sides, lost, unread, unused
from .likeness import likeness
from .probe import Probe, Trip, trip_of

# This near directions come back nearly: a scale that is a few hundredths off.
NEARLY_DEG = 10.0
# What an encoder that rounds by itself may lose, in degrees, of codes of one step.
OF_A_STEP_DEG = 600.0
# By what the angles of one half are larger than those of the other where an encoding is made for that one alone.
FAR_BETTER = 2.0
NO_PAIR, MAKES_ONE = "encode and decode are not a pair", "between the two makes them a pair"


@dataclass(frozen=True)
class Diagnosis:
    """The diagnosis of an encoder and a decoder.

    Attributes:
        domain: the directions that the two functions are made for.
        wrong: likely mistakes, as lines.
        broken: a direction in the domain where a function is not finite, if there are too many to measure the
            functions; otherwise empty.
        hole: a direction outside the domain where a function is not finite; otherwise empty.
    """

    domain: Domain
    wrong: list[str]
    broken: str = ""
    hole: str = ""


def bad(probe: Probe, domain: Domain) -> np.ndarray:
    """Return the directions in a domain that do not round-trip, of shape (count, 3), to mark them in an image of the
    sphere."""
    held = domain.held(trip_of(probe, np.concatenate([directions(), circles()])))
    held = held.of(held.is_finite)
    return held.n[held.angles() > exact.unusual(held)]


def diagnosed(probe: Probe, gl: Device, name: str = "") -> Diagnosis:
    """Return the Diagnosis of two functions: domain, likely mistakes as lines, and where a function is not finite.

    Args:
        probe: the two functions.
        name: the domain that the user states; empty to find out.
    """
    trip = trip_of(probe, directions())
    whole, kept = finite(trip), trip.of(trip.is_finite)
    meant = asked(name, kept, whole) if name else None
    # What is no number of a few directions is counted in tables, and the rest is measured.
    is_nearly_whole = trip.is_finite[(meant or SPHERE).holds(trip)].mean() > MOST
    if not is_nearly_whole and (not whole or meant not in (None, *whole)):
        broken = meant.held(trip).hole if meant else trip.hole
        return Diagnosis(meant or SPHERE, folds.mistakes(probe), broken)
    diagnosis = _finite_diagnosis(kept, probe, gl, meant)
    if diagnosis.domain in whole:
        return replace(diagnosis, hole=trip.hole)
    hole = diagnosis.domain.held(trip).hole
    if is_nearly_whole:
        # Its author may rely on these directions as well. A mistake that makes them is named in place of what follows
        # from it.
        wrong = [line for line in folds.mistakes(probe) if line not in diagnosis.wrong] + diagnosis.wrong
        return replace(diagnosis, wrong=[hole, *wrong] if wrong else [f"{hole}; all other directions round-trip"])
    if diagnosis.wrong or diagnosis.domain != SPHERE:
        return replace(diagnosis, broken=hole)
    return Diagnosis(whole[0], [], hole=trip.hole)


def _finite_diagnosis(trip: Trip, probe: Probe, gl: Device, meant: Domain | None) -> Diagnosis:
    """Return the Diagnosis of a trip with finite codes and decoded directions.

    Args:
        meant: the domain that the user states; None to find out.
    """
    # What packs by itself has few codes, as many as it likes.
    within = NEARLY_DEG if probe.is_packed else _same_within_deg(trip)
    domain = meant or guessed(trip, within)
    wider = None if meant else _nearly_back(trip, domain)
    if wider and (mistakes := list(nearly.mistakes(wider.held(trip), probe))):
        return _near_diagnosis(trip, probe, wider, mistakes)
    if domain.name == HEMISPHERE and not meant and (half := list(_half_faults(trip, probe, domain))):
        return Diagnosis(SPHERE, [*half, *_of_held(domain.held(trip), probe)])
    if domain.name and not _is_lost(trip, domain, within):
        return Diagnosis(domain, _of_pair(trip, probe, domain, is_meant=bool(meant)))
    return _of_none(trip, probe, gl, domain)


def _nearly_back(trip: Trip, domain: Domain) -> Domain | None:
    """Return a domain that nearly round-trips and differs from `domain`; None if no such domain exists."""
    wider = guessed(trip, NEARLY_DEG)
    return wider if wider.name and wider != domain else None


def _near_diagnosis(trip: Trip, probe: Probe, domain: Domain, mistakes: list[str]) -> Diagnosis:
    """Return the Diagnosis for a domain that nearly round-trips: mistakes, then lines about lengths and ranges."""
    return Diagnosis(domain, [*mistakes, *exact.lengths(domain.held(trip)), *exact.ranges(trip, domain, probe)])


def _same_within_deg(trip: Trip) -> float:
    """Return the angle in degrees within which a decoded direction counts as the same."""
    lattice = nearly.lattice_of(trip.codes)
    return max(SAME_DEG, OF_A_STEP_DEG / lattice.steps) if lattice else SAME_DEG


def _is_lost(trip: Trip, domain: Domain, within: float) -> bool:
    """Whether too few directions in a domain round-trip, as can happen if the user states the domain."""
    return (domain.held(trip).angles() < within).mean() <= MOST


def _of_pair(trip: Trip, probe: Probe, domain: Domain, is_meant: bool) -> list[str]:
    """Return the mistakes in a pair that round-trips on a domain.

    Args:
        is_meant: whether the user states this domain; unused codes are then intended.
    """
    held, ranges = domain.held(trip), list(exact.ranges(trip, domain, probe))
    wasted = [] if is_meant else [*unread(probe, trip.codes), *(() if ranges else unused(held, probe))]
    return [*_of_held(held, probe), *wasted, *ranges]


def _of_held(held: Trip, probe: Probe) -> list[str]:
    """Return the mistakes at directions that the encoding is made for, as lines."""
    mistakes = list(_inexact(held, probe)) if np.median(held.angles()) > EXACT_DEG else []
    # What is scaled or shifted is far off where the map is steep, which says nothing more.
    seams = [] if mistakes else [*exact.seam(held, probe), *exact.poles(held)]
    return [*mistakes, *seams, *exact.lengths(held)]


def _inexact(held: Trip, probe: Probe) -> Iterator[str]:
    """Yield reasons why directions only nearly round-trip. The halves of packed codes are not examined separately."""
    mistakes = [] if probe.is_packed else list(nearly.mistakes(held, probe))
    rounds_itself = probe.is_packed or nearly.lattice_of(held.codes)
    mistakes = mistakes or (list(nearly.scaled_angles(held)) if rounds_itself else [])
    yield from mistakes or (cut_off(held, probe) if rounds_itself else ())


def _half_faults(trip: Trip, probe: Probe, half: Domain) -> Iterator[str]:
    """Yield the mistakes that explain why only one half of the sphere round-trips; nothing if the encoding is
    designed for that half."""
    sides = Sides(trip, probe, half)
    gone = sides.gone
    if not sides.encoder_knows and not sides.decoder_reaches:
        return
    if mistakes := folds.mistakes(probe):
        which = f"{sides.share}directions with {half.lost_text}"
        yield from (f"{mistake}: {which} are lost; {gone.worst}" for mistake in mistakes)
    elif line := lost(sides, half):
        why = "; ".join([*unread(probe, trip.codes), line])
        yield f"{why}; {gone.worst}"
    else:
        yield _elsewhere_text(half, half.lost(trip))


def _elsewhere_text(half: Domain, gone: Trip) -> str:
    """Return in words how the directions in the other half decode, if both functions support that half."""
    if axes := axes_of(gone):
        return f"directions with {half.lost_text} come back with {axes}: {gone.worst}"
    return f"directions with {half.lost_text}: {exact.lost(gone)}; {gone.worst}"


def _of_none(trip: Trip, probe: Probe, gl: Device, given: Domain) -> Diagnosis:
    """Return the Diagnosis of two functions that are not a pair, or not a pair on the domain that the user states."""
    nearby = given if given.name else guessed(trip, NEARLY_DEG)
    if given.name and (mistakes := list(nearly.mistakes(given.held(trip), probe))):
        return _near_diagnosis(trip, probe, given, mistakes)
    likely = nearby if nearby.name else _likely_domain(trip)
    held, ranges = likely.held(trip), list(exact.ranges(trip, likely, probe))
    # What is clipped comes back elsewhere, whatever else is right.
    is_clipped = any(exact.CLIPPED in line for line in ranges)
    scaled = _scale_text(trip, held, probe) if is_clipped and not _is_back_unclipped(held, probe) else ""
    if scaled:
        ranges, why = [], [f"{_apart_text(held, likely)}; {scaled}"]
    else:
        why = [] if is_clipped else [_why(trip, held, probe, gl, likely)]
    # What a wrong code decodes to may have any length, and what stands between the two changes the range.
    lengths = [] if any(NO_PAIR in line for line in why) else exact.lengths(held)
    if any(MAKES_ONE in line for line in why):
        ranges = [line for line in ranges if exact.UNUSED not in line]
    return Diagnosis(given if given.name else SPHERE, [*why, *unread(probe, trip.codes), *lengths, *ranges])


def _is_back_unclipped(trip: Trip, probe: Probe) -> bool:
    """Whether directions whose codes exceed the range of storages round-trip if the codes are not clipped."""
    whole = replace(trip, decoded=probe.decode(trip.codes))
    return bool(np.median(whole.angles()) < SAME_DEG)


def _scale_text(trip: Trip, held: Trip, probe: Probe) -> str:
    """Return in words the scale between the two functions that makes a pair, even if only on one half; empty if no
    scale does."""
    begin = nearly.start(held, probe)
    decoded = probe.decode(begin.of(trip.codes).astype(np.float32))
    domain = guessed(replace(trip, decoded=decoded), NEARLY_DEG)
    mistakes = list(nearly.mistakes(domain.held(trip) if domain.name else held, probe, begin))
    return mistakes[0] if mistakes else ""


def _apart_text(held: Trip, likely: Domain) -> str:
    """Return in words how far the two functions are from being a pair."""
    return f"{NO_PAIR}: {held.angles().mean():.3g} degrees apart on average{_domain_text(likely)} without any storage"


def _why(trip: Trip, held: Trip, probe: Probe, gl: Device, likely: Domain) -> str:
    """Return one line on why directions do not round-trip: axes swapped or reversed, either everywhere or in one
    half; otherwise the mean error, with what would make a pair or with the worst direction."""
    if axes := axes_of(trip):
        return f"every direction comes back with {axes}{_or_numbers(trip, probe)}: {trip.worst}"
    for half in HALVES:
        if axes := axes_of(half.held(trip)):
            held = half.held(trip)
            return f"directions with {half.text} come back with {axes}{_or_numbers(trip, probe)}: {held.worst}"
    return f"{_apart_text(held, likely)}; {_what_fits(trip, probe, gl, likely) or held.worst}"


def _or_numbers(trip: Trip, probe: Probe) -> str:
    """Return in words, after a comma, the change of the code's components that would also explain the changed axes;
    empty if no change does."""
    between = step_between(trip, probe)
    return f", as with {between[0].said} between the two" if between else ""


def _domain_text(domain: Domain) -> str:
    return f" for {domain.made_for.replace('normals', 'directions')}" if domain.made_for else ""


def _what_fits(trip: Trip, probe: Probe, gl: Device, likely: Domain) -> str:
    """Return in words what would make the two functions a pair; empty if no known change would."""
    if mistakes := folds.mistakes(probe):
        return mistakes[0]
    if between := step_between(trip, probe):
        step, domain = between
        return f"{step.said} {MAKES_ONE}{_domain_text(domain)}"
    if scaled := _scale_text(trip, likely.held(trip), probe):
        return scaled
    like = likeness(gl, probe, likely)
    if like.encoder and like.decoder and not like.shared():
        return f"encode matches {like.encoder[0]}, decode matches {like.decoder[0]}"
    if like.encoder and not like.decoder:
        return f"encode matches {like.encoder[0]}, whose decode makes a pair with it; decode matches no known encoding"
    if like.decoder and not like.encoder:
        return f"decode matches {like.decoder[0]}, whose encode makes a pair with it; encode matches no known encoding"
    return ""


def _likely_domain(trip: Trip) -> Domain:
    """Return the first half whose mean error is far below that of the other directions; otherwise the sphere."""
    angles = trip.angles()
    for half in HALVES:
        inside = half.holds(trip)
        if FAR_BETTER * angles[inside].mean() < angles[~inside].mean():
            return half
    return SPHERE
