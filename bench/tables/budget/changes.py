"""The loss due to each attribute of a user's layout, and the proposed encodings that would improve it most."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from ....encodings.catalogue import ENCODINGS
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.words import FREE, OTHER, Target, place_of, spelt_out
from ...measures.metrics.totals import psnr_db
from .attributes import COMPONENTS
from .solve import UNSEEN, Solution

# How many changes are named, and the decibels that each brings at least: what rounds to less is no advice.
MOST, LEAST_DB = 3, 0.1
NUMBERS = ("metallic", "f0", "roughness", "ao")


def holds_other_quantities(layout: Layout) -> bool:
    """Whether a layout stores a diffuse colour and F0, or a specular power, instead of metallic-roughness values."""
    words = {word.component for word in layout.words}
    return "metallic" not in words and bool(words & {"f0.r", "power"})


def completed(layout: Layout) -> Layout:
    """Return a layout with its missing metallic-roughness attributes added in float targets; unchanged if
    `holds_other_quantities`."""
    if holds_other_quantities(layout):
        return layout
    lacks = [COMPONENTS[name][0] for name in NUMBERS if COMPONENTS[name][0] not in layout.components]
    words = [" ".join(lacks), "" if COMPONENTS["base_color"][0] in layout.components else "base_color -"]
    return replace(layout, targets=(*layout.targets, *(Target("rgba32f", holds) for holds in words if holds)))


def alone(layout: Layout, attribute: str) -> Layout:
    """Return a layout with its own words for one attribute, and everything else in 32-bit floats. If the layout lacks
    the attribute, so does the result.

    Raises:
        LayoutError: the words cannot be used alone, such as a roughness that stores a sign of the normal.
    """
    kept = [_only(layout, i, target, COMPONENTS[attribute]) for i, target in enumerate(layout.targets)]
    held = [target for target in kept if any(not word.startswith(FREE) for word in target.holds.split())]
    is_normal = attribute == "normal"
    if not is_normal:
        held.append(Target("rgba32f", "normal.x normal.y normal.z -"))
    if attribute != "base_color":
        held.append(Target("rgba32f", "base_color -"))
    others = [FREE if name == attribute else COMPONENTS[name][0] for name in NUMBERS]
    held.append(Target("rgba32f", " ".join(others)))
    changes = (
        {} if is_normal else {"encoding": ENCODINGS["xyz"], "space": "world", "depth": None, "rounding": "nearest"}
    )
    return replace(layout, name=f"{layout.name}_{attribute}", targets=tuple(held), light="", **changes)


def _only(layout: Layout, index: int, target: Target, components: Sequence[str]) -> Target:
    """Return a target with only the words of some components; the bits or channels of all other words become free."""
    words = []
    for text in spelt_out(place_of(layout.name, index, target), target):
        bits = text.partition(":")[2] if "(" not in text else text.rpartition(")")[2].partition(":")[2]
        is_kept = any(component in text for component in components) and not text.startswith(OTHER)
        words.append(text if is_kept else FREE + (f":{bits}" if bits else ""))
    return Target(target.format, " ".join(words))


Errors = Mapping[str, Mapping[str, float]]


def said(
    mine: Errors, proposal: Solution, errors_of: Callable[[str, str], Mapping[str, float]], classes: Sequence[str]
) -> str:
    """Return as text the changes that improve the worst class most, in order, each with the PSNR predicted after it;
    or that no encoding of the proposal is better.

    Args:
        mine: the error of each class, by attribute.
        proposal: a proposal of the same size.
        errors_of: a function from the names of an attribute and its encoding to the error of each class.
        classes: the classes whose worst error counts.
    """
    theirs = {
        placed.code.attribute: (placed.code.name, errors_of(placed.code.attribute, placed.code.name))
        for placed in proposal.placed
    }
    now = dict(mine)
    start = _worst(now, classes)
    parts: list[str] = []
    for _ in range(MOST if start else 0):
        best = min(
            (name for name in now if name in theirs and now[name] is not theirs[name][1]),
            key=lambda name: _worst({**now, name: theirs[name][1]}, classes),
            default=None,
        )
        if best is None or _gain_db(now, {**now, best: theirs[best][1]}, classes) < LEAST_DB:
            break
        now[best] = theirs[best][1]
        parts.append(f"{best} as {theirs[best][0]}, {psnr_db(_worst(now, classes)):.1f} dB")
    if not parts:
        return "no encoding of a proposal of the same size improves the worst class"
    less = [f"{name} as {theirs[name][0]}" for name in now if name in theirs and _is_less(mine[name], theirs[name][1])]
    in_return = f". Less accurate than yours: {', '.join(less)}" if less else ""
    return f"worst class, predicted from {psnr_db(start):.1f} dB: {'; then '.join(parts)}{in_return}"


def _is_less(mine: Mapping[str, float], theirs: Mapping[str, float]) -> bool:
    """Whether the largest error of a proposed encoding is visible and exceeds that of the layout's own encoding.

    Args:
        mine, theirs: the errors of the layout's and of the proposed encoding, by class."""
    return max(theirs.values(), default=0.0) > max(max(mine.values(), default=0.0), UNSEEN)


def _worst(errors: Errors, classes: Sequence[str]) -> float:
    return max(sum(class_errors.get(name, 0.0) for class_errors in errors.values()) for name in classes)


def _gain_db(before: Errors, after: Errors, classes: Sequence[str]) -> float:
    return psnr_db(_worst(after, classes)) - psnr_db(_worst(before, classes))
