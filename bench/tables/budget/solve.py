"""The choice of an encoding and a target for each attribute that minimises the error of the worst class: an integer
program.

With y = 1 if an encoding is in a target, z = 1 if a target is used, d the error that an encoding causes in a class,
and e the error that two encodings cause together beyond that, which counts if w = 1, that is, if both are used:

    minimise t   where for each class   sum of d y + sum of e w <= t
    each attribute has one encoding in one target that it fits; the targets' bytes fit the limit

HiGHS solves the program. Errors differ by many orders of magnitude, so it is solved again with errors in units of
the last t. The result is the plainest of all layouts within a fifth of a decibel of the best.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import scipy
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_array

from ...ground.output import cache
from ...ground.output.errors import UsageError
from ...ground.output.quiet import without_their_output
from .attributes import UNORM, Attribute, Code
from .bins import SHARED, WEBGPU, Bin

# Decibels within which layouts are equal, those that fewer bytes may cost, and how long HiGHS may look, in seconds.
EQUAL_DB, ENOUGH_DB, MOST_SECONDS = 0.2, 0.5, 20.0
# Of the least cost, within which a solution is the best.
GAP = 1e-3
# What SciPy says of a program whose time is over.
TIMED_OUT = 1
# More bytes than any layout has.
ANY_BYTES = 256
# Bytes that a pass fetches for each attribute that it reads, and bits from which another one beside it is large.
READ_BYTES, LARGE_BITS = 4, 16
# Errors that nobody looks for less than: 60 dB, a quarter of a step of 8 bits. And those that no 8 bits show, 54.2 dB.
UNSEEN, HALF_STEP = 1e-6, (0.5 / 255) ** 2
# Codes that are off by so little are exact: below what 8 bits of a display can show in any pixel, 120 dB.
NOTHING = 1e-12
SMALL = 1e-6


@dataclass(frozen=True)
class Rules:
    """The rules that a layout must keep to.

    Attributes:
        bytes: maximum bytes per pixel, over all targets.
        targets: maximum number of targets.
        blended: attributes that decals blend into.
        together: sets of attributes that must share one target each.
        read: attributes that a pass reads by themselves: at most READ_BYTES for each, from targets that hold no
            other large attribute.
        apart: attributes whose target holds nothing else.
        formats: maximum number of targets of each format; empty if any format may be used for all.
        webgpu: WebGPU's bytes per sample that remain for the targets; None if that limit does not apply.
    """

    bytes: int
    targets: int
    blended: frozenset[str] = frozenset()
    together: tuple[frozenset[str], ...] = ()
    webgpu: int | None = None
    apart: frozenset[str] = frozenset()
    formats: Mapping[str, int] = field(default_factory=dict)
    read: frozenset[str] = frozenset()


# A code by its attribute and its name, and two of them.
Key = tuple[str, str]
Pair = frozenset[Key]
# Variables of the program, by what each counts in a sum.
Terms = Mapping[int, float]


@dataclass(frozen=True)
class Placed:
    """An encoding in a target: the bin, and the number of its copy."""

    code: Code
    bin: Bin
    copy: int

    @property
    def key(self) -> Key:
        return self.code.key


@dataclass(frozen=True)
class Solution:
    """A layout as encodings placed in targets, and the error predicted for each class."""

    placed: tuple[Placed, ...]
    errors: Mapping[str, float]

    def worst_of(self, names: Sequence[str]) -> float:
        """Return the largest error of these classes; a class without an error counts as 0."""
        return max((self.errors.get(name, 0.0) for name in names), default=0.0)


@dataclass(frozen=True)
class Problem:
    """The choice of a layout as an optimisation problem.

    Attributes:
        attributes: attributes to store.
        errors: error in each class, by attribute and name of the encoding; an encoding that no image shows has no
            entry.
        together: error in each class of two encodings together, beyond their own errors.
        classes: classes whose worst error is minimised.
        bins: targets that may be used.
        rules: rules that the layout must keep to.
        cost: cost of an encoding in a target; None if not requested.
        most_cost: maximum total cost of the encodings.
    """

    attributes: Sequence[Attribute]
    errors: Mapping[tuple[str, str], Mapping[str, float]]
    classes: Sequence[str]
    bins: Sequence[Bin]
    rules: Rules
    together: Mapping[Pair, Mapping[str, float]] = field(default_factory=dict)
    cost: Callable[[Code, Bin], float] | None = None
    most_cost: float = math.inf

    def error(self, code: Code, name: str) -> float:
        error = self.errors.get((code.attribute, code.name), {}).get(name, 0.0)
        return 0.0 if error < NOTHING else error


class _Program:
    """The integer program of a problem. Its variables are, in this order: placements, targets, shared bytes, targets
    that a pass reads, pairs, and t."""

    def __init__(self, problem: Problem):
        self.problem = problem
        self.slots = [(target_bin, copy) for target_bin in problem.bins for copy in range(target_bin.copies)]
        self.choices = [
            (code, slot, need)
            for attribute in problem.attributes
            for code in attribute.codes
            for slot, (target_bin, _) in enumerate(self.slots)
            if target_bin.blends == (attribute.name in problem.rules.blended)
            and (need := target_bin.need(code)) is not None
        ]
        keys = {code.key for code, *_ in self.choices}
        self.pairs = [pair for pair in problem.together if pair <= keys]
        self.count = len(self.choices) + 3 * len(self.slots) + len(self.pairs) + 1
        self._rows: list[tuple[dict[int, float], float, float]] = []
        self._hold()
        self._fit()
        self._fetch()
        self._pair()

    def used(self, slot: int) -> int:
        return len(self.choices) + slot

    def shared(self, slot: int) -> int:
        return len(self.choices) + len(self.slots) + slot

    def fetched(self, slot: int) -> int:
        return len(self.choices) + 2 * len(self.slots) + slot

    def both(self, pair: int) -> int:
        return len(self.choices) + 3 * len(self.slots) + pair

    def row(self, terms: Mapping[int, float], low: float, high: float) -> None:
        self._rows.append((dict(terms), low, high))

    def _hold(self) -> None:
        """Require one encoding in one target for each attribute, a shared target for each set of attributes that must
        be together, and a separate target for each attribute that must be apart."""
        for attribute in self.problem.attributes:
            self.row({i: 1 for i, (code, *_) in enumerate(self.choices) if code.attribute == attribute.name}, 1, 1)
        for slot in range(len(self.slots)):
            here = {code.attribute: [] for code, place, _ in self.choices if place == slot}
            for i, (code, home, _) in enumerate(self.choices):
                if home == slot:
                    here[code.attribute].append(i)
            for name in sorted(self.problem.rules.apart & here.keys()):
                # y of what lies by itself, and of each other one: at most one of the two.
                for other in sorted(here.keys() - {name}):
                    self.row(dict.fromkeys((*here[name], *here[other]), 1.0), 0, 1)
        for names in self.problem.rules.together:
            first, *others = sorted(names)
            for other in others:
                for slot in range(len(self.slots)):
                    signs = {first: 1.0, other: -1.0}
                    terms = {
                        i: signs[code.attribute]
                        for i, (code, place, _) in enumerate(self.choices)
                        if place == slot and code.attribute in signs
                    }
                    self.row(terms, 0, 0)

    def _fit(self) -> None:
        rules = self.problem.rules
        for slot, (target_bin, copy) in enumerate(self.slots):
            here = [(i, need) for i, (_, place, need) in enumerate(self.choices) if place == slot]
            for channel, room in target_bin.channels.items():
                terms = {i: float(need[channel]) for i, need in here if channel in need}
                if channel == (UNORM, target_bin.part):
                    terms[self.shared(slot)] = 1.0
                self.row({**terms, self.used(slot): -float(room)}, -np.inf, 0)
            self.row({**{i: need[SHARED] for i, need in here if SHARED in need}, self.shared(slot): -1.0}, -np.inf, 0)
            if target_bin.fields:
                terms = {i: float(sum(need.values())) for i, need in here}
                self.row({**terms, self.used(slot): -float(target_bin.fields)}, -np.inf, 0)
            if copy:
                # Of equal targets the first ones are used.
                self.row({self.used(slot): 1.0, self.used(slot - 1): -1.0}, -np.inf, 0)
        every = range(len(self.slots))
        self.row(self.bytes(), 0, rules.bytes)
        self.row({self.used(slot): 1.0 for slot in every}, 0, rules.targets)
        for name, most in rules.formats.items():
            self.row({self.used(slot): 1.0 for slot in every if self.slots[slot][0].format == name}, 0, most)
        if rules.webgpu is not None:
            # Targets are written with the widest alignment first, so that none is lost to it.
            costs = {self.used(slot): float(WEBGPU[self.slots[slot][0].format][0]) for slot in every}
            self.row(costs, 0, rules.webgpu)
        if self.problem.most_cost < math.inf:
            self.row(self.costs(), 0, self.problem.most_cost)

    def _fetch(self) -> None:
        """Limit the bytes that a pass fetches for the attributes that it reads without the rest."""
        read = self.problem.rules.read
        if not read:
            return
        large = [
            attribute.name
            for attribute in self.problem.attributes
            if attribute.name not in read and min(code.total_bits for code in attribute.codes) >= LARGE_BITS
        ]
        for slot in range(len(self.slots)):
            here: dict[str, dict[int, float]] = {}
            for i, (code, place, _) in enumerate(self.choices):
                if place == slot:
                    here.setdefault(code.attribute, {})[i] = 1.0
            # The order of rows decides between equal layouts: no set's order may.
            for name in sorted(here.keys() & read):
                self.row({**here[name], self.fetched(slot): -1.0}, -np.inf, 0)
            for name in sorted(here.keys() & {*large}):
                self.row({**here[name], self.fetched(slot): 1.0}, -np.inf, 1)
        sizes = {self.fetched(slot): float(target_bin.bytes) for slot, (target_bin, _) in enumerate(self.slots)}
        self.row(sizes, 0, READ_BYTES * len(read))

    def _pair(self) -> None:
        """Constrain the variable of each pair of encodings to 1 if both are used, otherwise to 0."""
        for index, pair in enumerate(self.pairs):
            taken = [{i: 1.0 for i, (code, *_) in enumerate(self.choices) if code.key == key} for key in sorted(pair)]
            self.row({**taken[0], **taken[1], self.both(index): -1.0}, -np.inf, 1)
            for terms in taken:
                self.row({**terms, self.both(index): -1.0}, 0, np.inf)

    def forbid(self, codes: Set[Key]) -> None:
        """Forbid solutions that use all of these encodings together."""
        terms = {i: 1.0 for i, (code, *_) in enumerate(self.choices) if code.key in codes}
        self.row(terms, -np.inf, len(codes) - 1)

    def bytes(self) -> Terms:
        """Return the terms that sum to the total bytes of the targets that a solution uses."""
        return {self.used(slot): float(target_bin.bytes) for slot, (target_bin, _) in enumerate(self.slots)}

    def bytes_of(self, values: np.ndarray) -> int:
        """Return the total bytes of the targets that a solution uses, given the values of its variables."""
        return sum(target_bin.bytes for slot, (target_bin, _) in enumerate(self.slots) if values[self.used(slot)] > 0.5)

    def others(self, best: Solution) -> Terms:
        """Return the terms that sum the errors of all classes, each relative to the best solution's error, or to
        UNSEEN if that is larger."""
        classes = self.problem.classes
        units = {name: max(best.errors.get(name, 0.0), UNSEEN) for name in classes}
        return {
            i: sum(self.problem.error(code, name) / units[name] for name in classes)
            for i, (code, *_) in enumerate(self.choices)
        }

    def costs(self) -> Terms:
        """Return the terms that sum the costs of the encodings in their targets; all 0 if no cost is requested."""
        cost = self.problem.cost
        return {i: cost(code, self.slots[slot][0]) if cost else 0.0 for i, (code, slot, _) in enumerate(self.choices)}

    def fusses(self) -> Terms:
        """Return the terms that sum the penalties for encodings and targets that an engineer would rather avoid."""
        codes = {i: fuss(code, self.slots[place][0]) for i, (code, place, _) in enumerate(self.choices)}
        return codes | {
            self.used(slot): target_bin.fuss + TARGET_FUSS for slot, (target_bin, _) in enumerate(self.slots)
        }

    def solved(self, unit: float, most: float | None = None, least: Terms | None = None) -> np.ndarray | None:
        """Return the variables that minimise a sum; None if the program has no solution.

        Args:
            unit: the error that counts as 1.
            most: the largest t in these units; None for any.
            least: the sum to minimise, as the weight of each variable; None for t.

        Raises:
            UsageError: no solution was found in time.
        """
        rows, last = list(self._rows), self.count - 1
        for name in self.problem.classes:
            terms = {i: self.problem.error(code, name) / unit for i, (code, *_) in enumerate(self.choices)}
            terms |= {
                self.both(index): self.problem.together[pair].get(name, 0.0) / unit
                for index, pair in enumerate(self.pairs)
            }
            rows.append(({**{i: d for i, d in terms.items() if d}, last: -1.0}, -np.inf, 0.0))
        cost = np.zeros(self.count)
        for i, value in ({last: 1.0} if least is None else least).items():
            cost[i] = value
        upper = np.ones(self.count)
        upper[len(self.choices) + len(self.slots) : len(self.choices) + 2 * len(self.slots)] = 4
        upper[last] = np.inf if most is None else most
        # What alone is worse than what is known to be possible is not looked at.
        limit = np.inf if most is None else most
        for i, (code, *_) in enumerate(self.choices):
            worst = max((self.problem.error(code, name) for name in self.problem.classes), default=0.0) / unit
            upper[i] = 0 if worst > min(limit, WORST) * (1 + SMALL) else 1
        integral = np.ones(self.count)
        integral[last] = 0
        entries = [(r, i, v) for r, (terms, *_) in enumerate(rows) for i, v in terms.items()]
        matrix = csr_array(
            ([v for *_, v in entries], ([r for r, *_ in entries], [i for _, i, _ in entries])),
            shape=(len(rows), self.count),
        )
        lows, highs = np.array([low for _, low, _ in rows]), np.array([high for *_, high in rows])
        return _least(cost, matrix, lows, highs, upper, integral)

    def solution(self, values: np.ndarray) -> Solution:
        chosen = [self.choices[i] for i in range(len(self.choices)) if values[i] > 0.5]
        placed = tuple(Placed(code, *self.slots[slot]) for code, slot, _ in chosen)
        names = {name for by_class in self.problem.errors.values() for name in by_class}
        errors = {name: sum(self.problem.error(placement.code, name) for placement in placed) for name in sorted(names)}
        keys = {placement.code.key for placement in placed}
        for pair in self.pairs:
            if pair <= keys:
                errors = {name: e + self.problem.together[pair].get(name, 0.0) for name, e in errors.items()}
        return Solution(placed, errors)


def _least(
    cost: np.ndarray, matrix: csr_array, lows: np.ndarray, highs: np.ndarray, upper: np.ndarray, integral: np.ndarray
) -> np.ndarray | None:
    """Return the variables from 0 to ``upper`` that minimise ``cost`` while ``matrix`` times the variables is within
    bounds; None if the program has no solution. Solutions are cached.

    Raises:
        UsageError: no solution was found in time.
    """
    arrays = cost, matrix.data, matrix.indices, matrix.indptr, lows, highs, upper, integral
    key = cache.key_of(f"milp {scipy.__version__} {GAP}", *(np.ascontiguousarray(array).tobytes() for array in arrays))

    if known := cache.read(key):
        return np.array(known["values"]) if known["values"] else None
    # SciPy takes arrays for bounds; its types name numbers alone.
    none: Any = np.zeros(len(cost))
    most: Any = upper
    low: Any = lows
    high: Any = highs
    # HiGHS prints lines that are for its authors.
    with without_their_output():
        solution = milp(
            cost,
            integrality=integral,
            bounds=Bounds(none, most),
            constraints=LinearConstraint(matrix, low, high),
            options={"time_limit": MOST_SECONDS, "mip_rel_gap": GAP},
        )
    # What was found in haste is not the answer of another day.
    if solution.status != TIMED_OUT:
        cache.write(key, {"values": [] if solution.x is None else solution.x.tolist()})
    elif solution.x is None:
        raise UsageError(f"no layout found within {MOST_SECONDS:g} s; use fewer --formats or --targets")
    return solution.x


# One target more is worth half a target of shared bits; a number of bits that is no byte's a tenth, and one that is
# joined of bytes, which a wider channel would convert, a twentieth; a curve that shaders compute as much.
TARGET_FUSS, ODD_FUSS, JOINED_FUSS, CURVE_FUSS = 0.5, 0.1, 0.05, 0.05
# In units of the last t: what is far above it in one code is left out of the program, whose numbers stay of one size.
WORST = 1e3


def fuss(code: Code, target_bin: Bin) -> float:
    """Return the penalty for properties of an encoding in a target that an engineer would rather avoid."""
    is_shared = target_bin.fields or SHARED in (target_bin.need(code) or {})
    curve = CURVE_FUSS * any("(" in word for word in code.words)
    if not is_shared:
        return curve
    joined = sum(bits > target_bin.part for bits in code.bits) if not target_bin.fields else 0
    return curve + ODD_FUSS * sum(bits % 8 != 0 for bits in code.bits) + JOINED_FUSS * joined


def solved(problem: Problem) -> Solution | None:
    """Return the plainest layout among the best; None if no layout keeps to the rules."""
    return next(iter(finalists(problem, 1)), None)


def finalists(problem: Problem, count: int) -> list[Solution]:
    """Return up to `count` layouts with different encodings, the plainest first; empty if no layout keeps to the
    rules.

    Each layout is within EQUAL_DB of the best, first in the worst class and then in the sum of all classes; a
    worst-class error of up to UNSEEN is always allowed."""
    program = _Program(problem)
    best = _best(program)
    if best is None:
        return []
    # What nobody sees is no reason for another layout.
    allowed = max(best.worst_of(problem.classes) * 10 ** (EQUAL_DB / 10), UNSEEN)
    others = program.others(best)
    values = program.solved(allowed, most=1.0, least=others) if allowed > UNSEEN else None
    if values is not None:
        program.row(others, -np.inf, sum(values[i] * value for i, value in others.items()) * 10 ** (EQUAL_DB / 10))
    solutions: list[Solution] = []
    while len(solutions) < count:
        plain = program.solved(allowed, most=1.0, least=program.fusses())
        if plain is None:
            break
        solutions.append(program.solution(plain))
        program.forbid({placement.code.key for placement in solutions[-1].placed})
    return solutions or [best]


def _best(program: _Program) -> Solution | None:
    """Return the layout whose worst class has the smallest error; None if no layout keeps to the rules."""
    classes = program.problem.classes
    values = program.solved(1.0)
    if values is None:
        return None
    best = program.solution(values)
    # Solved anew in units of what was found, until that no longer changes.
    for _ in range(6):
        worst = best.worst_of(classes)
        if worst <= NOTHING:
            break
        values = program.solved(worst)
        if values is None:
            break
        tried = program.solution(values)
        better = tried.worst_of(classes)
        if better < worst:
            best = tried
        if better > worst * (1 - 1e-3):
            break
    return best


def enough_bytes(problem: Problem, unseen: float = HALF_STEP) -> int | None:
    """Return the bytes of the smallest layout whose worst class is within ENOUGH_DB of the best, or has an error of
    at most `unseen`; None if no layout keeps to the rules."""
    program = _Program(problem)
    best = _best(program)
    if best is None:
        return None
    allowed = max(best.worst_of(problem.classes) * 10 ** (ENOUGH_DB / 10), unseen)
    values = program.solved(allowed, most=1.0, least=program.bytes())
    return problem.rules.bytes if values is None else program.bytes_of(values)


def fewest_bytes(problem: Problem) -> int | None:
    """Return the bytes of the smallest layout that keeps to all rules but the byte limit; None if no layout does."""
    program = _Program(replace(problem, rules=replace(problem.rules, bytes=ANY_BYTES)))
    values = program.solved(1.0, least=program.bytes())
    if values is None:
        return None
    return program.bytes_of(values)


def cheapest(problem: Problem) -> Solution | None:
    """Return the layout whose encodings have the lowest total cost; None if no layout keeps to the rules."""
    program = _Program(problem)
    values = program.solved(1.0, least=program.costs())
    return None if values is None else program.solution(values)
