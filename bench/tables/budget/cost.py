"""The cost in issue slots of packing and unpacking a surface in a layout, and the search for layouts that keep the
cost within a limit."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

from ....encodings.catalogue import ENCODINGS
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.words import Target
from ...ground.options.counts import MOST_INSTRUCTIONS
from ...ground.options.gpu_families import FAMILIES
from ...ground.output.errors import MissingError
from ...shaders.code.whole.kernel import pack_operation, unpack_operation
from ...shaders.isa import isa, spirv
from ..cost.measure import CostCase, counted
from ..table import Row
from .attributes import Code
from .bins import SHARED, Bin
from .solve import Placed, Problem, Solution, cheapest
from .written import NORMAL, layout_of, target_of

# A layout has more numbers than a fragment shader has outputs to keep them all.
STAGE = "compute"
PACK, UNPACK = "pack", "unpack"
# How a code lies in a target: in channels that the format converts, in bits of bytes, or in bits of whole numbers.
OWN, BYTES, FIELDS = "own", "bytes", "fields"
# How often a program is solved anew, and what a limit is lowered by at least.
TRIES, LEAST_STEP = 6, 0.5
# How far above the least sum the least whole layout is looked for.
BEYOND = (1.0, 2.0)
# Of what is not counted: above any limit.
UNKNOWN = 2.0 * MOST_INSTRUCTIONS

# The best layouts of a problem.
Solve = Callable[[Problem], Collection[Solution]]


@dataclass(frozen=True)
class Price:
    """The issue slots that a layout's code takes on a GPU family: to pack a surface, and to unpack it."""

    family: str
    pack: float
    unpack: float

    @property
    def once(self) -> float:
        return self.pack + self.unpack


def check_compilers(families: Iterable[str]) -> None:
    """Raise MissingError if the compiler for a family is not installed on this machine."""
    spirv.compiler()
    for reason in filter(None, (isa.missing(FAMILIES[family].library) for family in families)):
        raise MissingError(f"--most-instructions requires a compiler: {reason}")


class Slots:
    """The issue slots of layouts and of single encodings on several families, each counted once."""

    def __init__(self, families: Sequence[str]):
        self._families = families
        self._known: dict[str, tuple[Price, ...]] = {}
        self._alone: dict[tuple[str, str, str], Layout] = {}

    def count(self, layouts: Iterable[Layout]) -> None:
        """Count the slots of layouts that have not been counted yet; one call for many layouts is fastest."""
        new = {layout.summary: layout for layout in layouts if layout.summary not in self._known}
        make = {PACK: pack_operation, UNPACK: unpack_operation}
        cases = [
            CostCase(None, key, name, partial(do, layout)) for key, layout in new.items() for name, do in make.items()
        ]
        counts = {family: counted(cases, family, STAGE) for family in self._families} if cases else {}
        for key in new:
            prices = (_price(family, rows.get((key, PACK)), rows.get((key, UNPACK))) for family, rows in counts.items())
            self._known[key] = tuple(filter(None, prices))

    def of(self, layout: Layout) -> tuple[Price, ...]:
        """Return the layout's cost on each family for which it is known."""
        self.count([layout])
        return self._known[layout.summary]

    def once(self, layout: Layout) -> float:
        """Return the slots to pack and unpack once on the most expensive family; UNKNOWN if a family has no count."""
        prices = self.of(layout)
        return max(price.once for price in prices) if len(prices) == len(self._families) else UNKNOWN

    def count_codes(self, problem: Problem) -> None:
        """Count the slots of every encoding in a problem, for each way to store it in a target."""
        for code in (code for attribute in problem.attributes for code in attribute.codes):
            for target in problem.bins:
                if target.need(code) is not None and _key(code, target) not in self._alone:
                    self._alone[_key(code, target)] = alone(code, target)
        self.count(self._alone.values())

    def of_code(self, code: Code, target_bin: Bin) -> float:
        """Return the slots for an encoding alone in a target. Requires `count_codes`."""
        return self.once(self._alone[_key(code, target_bin)])

    def columns(self, layout: Layout, overdraw: float, readers: float) -> Row:
        """Return the cost columns for the family with the highest cost per pixel; empty if no cost is known."""

        def pixel(price: Price) -> float:
            return overdraw * price.pack + readers * price.unpack

        prices = self.of(layout)
        if not prices:
            return {}
        dearest = max(prices, key=pixel)
        figures = {"pack_slots": dearest.pack, "unpack_slots": dearest.unpack, "slots": pixel(dearest)}
        return {**{name: round(value, 1) for name, value in figures.items()}, "dearest_family": dearest.family}


def _price(family: str, pack: Row | None, unpack: Row | None) -> Price | None:
    slots = [row["executed_slots"] for row in (pack, unpack) if row and row["executed_slots"] is not None]
    return Price(family, *slots) if len(slots) == 2 else None


def _key(code: Code, target_bin: Bin) -> tuple[str, str, str]:
    how = FIELDS if target_bin.fields else BYTES if SHARED in (target_bin.need(code) or {}) else OWN
    return code.attribute, code.name, how


def alone(code: Code, target_bin: Bin) -> Layout:
    """Return a layout that stores one encoding in a target and, unless it encodes the normal, a normal in floats."""
    placed, name = Placed(code, target_bin, 0), f"{code.attribute} {code.name}"
    if code.attribute == NORMAL:
        return layout_of(name, Solution((placed,), {}))
    targets = (target_of(target_bin, [placed]), Target("rgba32f", "normal.x normal.y normal.z -"))
    return Layout(name, name, targets, ENCODINGS["xyz"], "this project", space="world")


def within(problem: Problem, most: float, slots: Slots, solve: Solve) -> list[Solution]:
    """Return the best layouts whose whole code needs at most `most` slots; empty if no such layout is found.

    The solver knows only the slots of each encoding alone. The code of a whole layout needs more slots, to join bits,
    or fewer, if encodings share a byte. This difference is taken from the last layout found.
    """
    slots.count_codes(problem)
    best: list[Solution] = []
    # Sums for which layouts kept to the limit, and did not.
    low, high, allowed = -math.inf, math.inf, most
    for _ in range(TRIES):
        solutions = list(solve(replace(problem, cost=slots.of_code, most_cost=allowed)))
        if not solutions:
            break
        kept = [solution for solution in solutions if whole(slots, solution) <= most]
        total = _total(slots, solutions[0])
        wish = most + total - whole(slots, solutions[0])
        if kept:
            low, best = allowed, kept
        else:
            high, wish = allowed, min(wish, total - LEAST_STEP)
        if not low < wish < high:
            break
        allowed = wish
    if best:
        return best
    cheapest_found = least(problem, slots, solve)
    return [cheapest_found] if cheapest_found and whole(slots, cheapest_found) <= most else []


def least(problem: Problem, slots: Slots, solve: Solve) -> Solution | None:
    """Return the layout whose whole code takes the fewest slots, among layouts whose separate encodings take the
    fewest or nearly the fewest; None if no layout satisfies the rules."""
    slots.count_codes(problem)
    first = cheapest(replace(problem, cost=slots.of_code))
    if first is None:
        return None
    sums = [_total(slots, first) + more for more in BEYOND]
    others = [solution for most in sums for solution in solve(replace(problem, cost=slots.of_code, most_cost=most))]
    return min((first, *others), key=lambda candidate: whole(slots, candidate))


def _total(slots: Slots, solution: Solution) -> float:
    """Return the sum of the slots that a layout's encodings take separately."""
    return sum(slots.of_code(placed.code, placed.bin) for placed in solution.placed)


def whole(slots: Slots, solution: Solution) -> float:
    """Return the slots to pack and unpack a layout once."""
    return slots.once(layout_of("", solution))
