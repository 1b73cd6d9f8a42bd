"""The budget table: a layout for each size, the quality of its images, and the sources of its error."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np

from ....encodings.codecs.depth_codec import DepthEncoding
from ....gbuffer.gl.device import Device, FormatError
from ....gbuffer.gl.shader import ShaderError
from ....gbuffer.layouts.layout import DIFFUSE_F0, Layout
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.layouts.words import LayoutError
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import check
from ...ground.output.errors import UsageError
from ...measures.metrics.totals import psnr_db
from ..table import Row, Tick
from . import changes
from .attributes import COMPONENTS, EMISSION, WITHOUT, Attribute, Surfaces, usual
from .bins import webgpu_cost
from .contract import IN_LIGHT
from .cost import Slots, least, whole, within
from .own import Own, own
from .question import Question
from .rates import FRAME, LEAST_PIXELS, PIPELINE, Exact, rates, rates_of_pair
from .sentences import INVISIBLE
from .solve import (
    HALF_STEP,
    NOTHING,
    UNSEEN,
    Key,
    Pair,
    Problem,
    Rules,
    Solution,
    enough_bytes,
    fewest_bytes,
    finalists,
)
from .table import ENGINE, IMPROVED, MINE, PROPOSAL, TABLE
from .written import layout_of

# Layouts that count as equal are drawn, so many of them; FLIP within so much is as good.
FINALISTS, EQUAL_FLIP = 3, 0.005
# Decibels that targets of whole numbers have to gain to be taken in place of others.
INTEGER_DB = 3.0
# Decibels from which a prediction is off, and the share of an error from which two codes are said to make it together.
OFF_DB, LEAST_SHARE = 0.5, 0.05
# By how many bytes more a limit is tried, to say what they would buy, and from how many decibels on that is said.
MORE, WORTH_DB = (1, 2, 4), 0.5
# Bits of the largest code that is usual.
ONE_WORD = 32
UNMEASURABLE = (ShaderError, FormatError, LayoutError)
# What engines may lack, with a word of a layout that has it.
LACKS = {"motion": "motion.x", "shading_model": "shading_model", "f0": "f0", "ao": "ao"}
# Pixels of the two pictures that traffic is said for.
HD, UHD = 1920 * 1080, 3840 * 2160


def measure(device: Device, question: Question, tick: Tick) -> list[Row]:
    """Return a row for each limit, or one for the threshold, followed by the rows of the layouts to compare."""
    with ExitStack() as stack:
        judges = [Exact(device, stack, stage) for stage in question.stages]
        judged = Judged(question, judges, tick)
        if question.threshold is None:
            rows = [row for rules in question.rules for row in judged.proposals(rules)]
        else:
            rows = list(judged.fewest())
        for layout in judged.others(device):
            if layout in question.against:
                rows += judged.mine(layout)
            else:
                rows.append(judged.row_of(ENGINE, layout))
            tick(layout.name)
    return [row | {"device": device.renderer} for row in rows]


class Judged:
    """The scenes of a question, with the errors that encodings cause in them."""

    def __init__(self, question: Question, judges: Sequence[Exact], tick: Tick):
        self._question, self._judges, self._tick = question, judges, tick
        self._slots = Slots(question.families)
        self._errors: dict[Key, dict[str, float]] = {}
        self._together: dict[Pair, dict[str, float]] = {}
        self._take(question.attributes, tick)
        if not self.classes:
            asked = ", ".join(question.judging)
            raise UsageError(
                f"--size: no class of surfaces ({asked}) has at least {LEAST_PIXELS} pixels in {question.scenes}; "
                "use a larger size"
            )
        self.unseen = [
            attribute.name for attribute in question.attributes if not (attribute.is_seen and self._shows(attribute))
        ]

    def _take(self, attributes: Sequence[Attribute], tick: Tick) -> None:
        """Measure, in every scene, the errors of the attributes' encodings that are not yet known, and keep them."""
        for attribute in attributes:
            new = [code for code in attribute.codes if code.key not in self._errors]
            for judge in self._judges:
                for code, errors in rates(judge, new, tick).items():
                    mine = self._errors.setdefault((attribute.name, code), {})
                    mine.update({_class_of(judge, n): e for n, e in errors.items()})

    def _shows(self, attribute: Attribute) -> bool:
        """Whether any encoding of an attribute causes an error in a scene."""
        mine = (errors for (name, _), errors in self._errors.items() if name == attribute.name)
        return any(e > NOTHING for errors in mine for e in errors.values())

    @property
    def classes(self) -> list[str]:
        """The names, as "SCENE CLASS", of the errors that count: those of the judging surface classes in each scene."""
        names = dict.fromkeys(name for errors in self._errors.values() for name in errors)
        return [name for name in names if name.rpartition(" ")[2] in self._question.judging]

    def _usual(self, attributes: Sequence[Attribute]) -> list[Attribute]:
        """Return the attributes with fewer encodings: at least the usual number of bits if no scene shows the
        attribute, otherwise no needlessly wide encodings."""
        return [
            usual(attribute) if attribute.is_seen and not self._shows(attribute) else self._in_one_word(attribute)
            for attribute in attributes
        ]

    def _in_one_word(self, attribute: Attribute) -> Attribute:
        """Return an attribute without encodings over 32 bits if a smaller encoding has no visible error in any class:
        48 bits for a normal would then be wasted. Attributes that decals blend into are unchanged, because they may
        need wide encodings."""
        if attribute.name in self._question.rules[0].blended:
            return attribute
        small = [code for code in attribute.codes if code.total_bits <= ONE_WORD]
        errors = [self._errors.get(code.key, {}) for code in small]
        is_shown = all(max((of.get(name, 0.0) for name in self.classes), default=0.0) > HALF_STEP for of in errors)
        return attribute if is_shown else replace(attribute, codes=tuple(small))

    def _solved(self, rules: Rules) -> Solution | None:
        q = self._question
        return next(iter(self._finalists(Own(q.attributes, q.bins, rules), 1)), None)

    def _finalists(self, asked: Own, count: int) -> list[Solution]:
        return next(filter(None, (self._kept(problem, count) for problem in self._problems(asked))), [])

    def _problems(self, asked: Own, classes: Sequence[str] = ()) -> Iterator[Problem]:
        """Yield a problem with the usual number of bits for attributes that no scene shows, then a problem with their
        minimum, in case the usual bits do not fit.

        Args:
            classes: the classes that judge; empty for all.
        """
        usually = self._usual(asked.attributes)
        for held in (usually, *([asked.attributes] if usually != asked.attributes else [])):
            yield Problem(held, self._errors, classes or self.classes, asked.bins, asked.rules, self._together)

    def _held_back_db(self, asked: Own) -> float | None:
        """Return the PSNR of the mean error over scenes, with the worst class of each scene in a layout that was
        chosen on the other scenes; None if there is only one scene."""
        errors = []
        for scene in dict.fromkeys(map(_scene_of, self.classes)):
            inside = [name for name in self.classes if _scene_of(name) == scene]
            others = [name for name in self.classes if _scene_of(name) != scene]
            problems = self._problems(asked, others) if others else ()
            solutions = next(filter(None, (self._kept(problem, 1) for problem in problems)), [])
            errors += [solution.worst_of(inside) for solution in solutions]
        return psnr_db(float(np.mean(errors))) if len(errors) > 1 else None

    def _kept(self, problem: Problem, count: int) -> list[Solution]:
        """Return up to `count` of the best layouts; integer targets are used only if the gain is large."""
        plain = _in_channels(problem)
        solutions = self._in_slots(plain, count)
        if len(plain.bins) == len(problem.bins):
            return solutions
        if not solutions:
            return self._in_slots(problem, count)
        worst = solutions[0].worst_of(problem.classes)
        others = self._in_slots(problem, count) if worst > UNSEEN else []
        if not others or psnr_db(others[0].worst_of(problem.classes)) - psnr_db(worst) < INTEGER_DB:
            return solutions
        return others

    def _in_slots(self, problem: Problem, count: int) -> list[Solution]:
        """Return up to `count` of the best layouts, within --most-instructions if that option is set."""
        most, best = self._question.most_instructions, partial(finalists, count=count)
        return best(problem) if most is None else within(problem, most, self._slots, best)

    def _best(self, name: str, asked: Own, depth: DepthEncoding | None = None) -> tuple[Solution, Layout, Row] | None:
        """Return the best layout and the row of its images; None if no layout fits. If the images differ from the
        prediction, measure pairs of the layout's encodings and solve again with the results."""
        best = self._best_drawn(name, asked, depth)
        if best and self._is_off(best[0], best[2]) and self._measure_pairs(best[0]):
            return self._best_drawn(name, asked, depth)
        return best

    def _best_drawn(self, name: str, asked: Own, depth: DepthEncoding | None) -> tuple[Solution, Layout, Row] | None:
        """Measure the solutions that count as equal; return the solution, layout and row with the lowest FLIP, or the
        first and plainest if none is visibly better; None if no layout fits."""
        best = None
        for solution in self._finalists(asked, FINALISTS):
            layout = _with_depth(layout_of(name, solution), depth)
            row = self.row_of(PROPOSAL, layout)
            flip_p99 = math.inf if row["flip_p99"] is None else row["flip_p99"]
            if best is None or flip_p99 < best[2]["flip_p99"] - EQUAL_FLIP:
                best = solution, layout, row
            # What nobody sees, or nobody can tell, is not compared.
            if flip_p99 <= INVISIBLE:
                break
        return best

    def _is_off(self, solution: Solution, row: Row) -> bool:
        """Whether the PSNR of the worst class in the images differs from the prediction by more than OFF_DB."""
        return not row["skipped"] and abs(psnr_db(solution.worst_of(self.classes)) - row["worst_db"]) > OFF_DB

    def _measure_pairs(self, solution: Solution) -> bool:
        """Measure the joint errors of pairs of a layout's encodings; return whether any new pair matters."""
        codes, before = [placed.code for placed in solution.placed if placed.code.trip], len(self._together)
        for first, second in combinations(codes, 2):
            pair = frozenset((first.key, second.key))
            beyond: dict[str, float] = {}
            for judge in self._judges if pair not in self._together else ():
                both = rates_of_pair(judge, first, second)
                for name, e in both.items():
                    key = _class_of(judge, name)
                    beyond[key] = e - self._errors[first.key].get(key, 0.0) - self._errors[second.key].get(key, 0.0)
            if any(abs(e) > LEAST_SHARE * solution.errors[name] for name, e in beyond.items() if name in self.classes):
                self._together[pair] = beyond
        return len(self._together) > before

    def fewest(self) -> Iterator[Row]:
        """Search by bisection for the fewest bytes whose layout keeps to the FLIP threshold, and yield its proposals,
        or else a row without figures whose `skipped` says why."""
        q, (low, high) = self._question, self._question.search
        first, last = q.rules[0], high
        while low < high:
            middle = (low + high) // 2
            low, high = (low, middle) if self._keeps(replace(first, bytes=middle)) else (middle + 1, high)
        if low == last and not self._keeps(replace(first, bytes=last)):
            reason = f"no layout of up to {last} bytes has FLIP of at most {q.threshold:g}"
            yield self._empty(PROPOSAL, f"{last} bytes") | {"limit": last, "skipped": reason}
            return
        yield from self.proposals(replace(first, bytes=low))

    def _keeps(self, rules: Rules) -> bool:
        """Whether the best layout for a limit keeps to the FLIP threshold in every scene."""
        solution, threshold = self._solved(rules), self._question.threshold
        if solution is None or threshold is None:
            return False
        flips = [judge.of_layout(layout_of(f"budget_{rules.bytes}", solution)).flip for judge in self._judges]
        return all(flip <= threshold for flip in flips)

    def proposals(self, rules: Rules) -> Iterator[Row]:
        """Yield the row for a limit; a row without figures if no layout keeps to the rules."""
        asked = Own(self._question.attributes, self._question.bins, rules)
        enough = replace(rules, bytes=self._enough(asked))
        best = self._best(f"budget_{rules.bytes}", replace(asked, rules=enough))
        if best and enough.bytes < rules.bytes and (best[2]["flip_p99"] or 0.0) > INVISIBLE:
            # An error that was supposed to be invisible is not: what the other bytes gain counts.
            enough = replace(rules, bytes=self._enough(asked, unseen=0.0))
            best = self._best(f"budget_{rules.bytes}", replace(asked, rules=enough))
        if best is None:
            yield self._empty(PROPOSAL, f"{rules.bytes} bytes") | {"limit": rules.bytes, "skipped": self._why(rules)}
            return
        solution, layout, row = best
        held_back = self._held_back_db(replace(asked, rules=enough))
        row |= {"held_back_db": row["held_back_db"] if held_back is None else held_back}
        yield row | self._predicted(solution, row) | self._next(rules, solution) | {"limit": rules.bytes}
        self._tick(layout.name)

    def _enough(self, asked: Own, unseen: float = HALF_STEP) -> int:
        """Return the fewest bytes whose layout is within half a decibel of the limit's layout, or has an error of at
        most `unseen`; the limit itself if no such size is known, or if instructions are limited."""
        problems = self._problems(asked) if self._question.most_instructions is None else ()
        sizes = (enough_bytes(_in_channels(problem), unseen) for problem in problems)
        return next((size for size in sizes if size is not None), asked.rules.bytes)

    def mine(self, layout: Layout) -> Iterator[Row]:
        """Yield the row of a user's layout and, if one fits, of a proposal with the same attributes and formats."""
        row = self.row_of(MINE, layout)
        if changes.holds_other_quantities(layout):
            note = "not compared, because it stores no metallic; the encodings are for metallic-roughness materials"
            yield row | {"changes": note}
            return
        asked = own(layout, self._question.rules[0])
        # These codes are in no count of steps.
        self._take(asked.attributes, lambda _: None)
        best = self._best(f"{layout.name}_improved", asked, layout.depth)
        if best is None:
            within = " within WebGPU's limit" if asked.rules.webgpu is not None else ""
            yield row | {"changes": f"its attributes do not fit into its targets{within} with the required bits"}
            return
        solution, _, improved = best
        yield row | {"changes": self._changes(layout, solution)}
        unseen = dict.fromkeys(attribute.name.split()[0] for attribute in asked.attributes if not attribute.is_seen)
        note = {"by_contract": ", ".join(unseen) or None}
        yield (
            improved | self._predicted(solution, improved) | note | {"kind": IMPROVED, "limit": layout.bytes_per_pixel}
        )

    def _next(self, rules: Rules, solution: Solution) -> Row:
        """Return the smallest number of additional bytes with a worthwhile gain, and the gain in dB; empty if no
        number in MORE brings such a gain."""
        worst = solution.worst_of(self.classes)
        now = psnr_db(worst)
        for size in MORE if worst > HALF_STEP else ():
            more = self._solved(replace(rules, bytes=rules.bytes + size))
            gain = psnr_db(more.worst_of(self.classes)) - now if more else 0.0
            if gain >= WORTH_DB:
                return {"next_bytes": size, "next_db": gain}
        return {}

    def _why(self, rules: Rules) -> str:
        """Return why no layout fits a limit, with the smallest size or cost that is possible."""
        q = self._question
        problem = Problem(q.attributes, self._errors, self.classes, q.bins, rules)
        least_bytes = fewest_bytes(problem)
        if least_bytes is None:
            return self._why_never(rules)
        if least_bytes <= rules.bytes and q.most_instructions is not None:
            return self._why_too_dear(problem, q.most_instructions)
        bits = sum(min(code.total_bits for code in attribute.codes) for attribute in q.attributes)
        few = f"{rules.bytes} bytes are too few"
        smallest = f"the attributes need {bits} bits, and the smallest layout under these rules has {least_bytes} bytes"
        return f"{few}: {smallest}{self._dropped(problem)}"

    def _dropped(self, problem: Problem) -> str:
        """Return `. A layout fits` and the attributes to leave out, smallest loss first; empty if no choice of
        attributes helps."""
        losses = {
            attribute.name: loss for attribute in problem.attributes if (loss := self._loss(attribute)) is not None
        }
        order = sorted(losses, key=lambda name: (name != EMISSION.name, losses[name] > HALF_STEP, losses[name]))
        fits = partial(_fits_without, problem)
        count = next((count for count in range(1, len(order) + 1) if fits(order[:count])), 0)
        dropped = order[:count]
        for name in reversed(order[:count]):
            dropped = kept if fits(kept := [other for other in dropped if other != name]) else dropped
        # The light buffer holds what is given off for nothing.
        light = [f"with {EMISSION.name} in the light buffer ({IN_LIGHT})"] if EMISSION.name in dropped else []
        parts = [f"{name} ({_loss_text(losses[name])})" for name in dropped if name != EMISSION.name]
        without = [f"without {' and '.join(parts)}"] if parts else []
        return f". A layout fits {', and '.join([*light, *without])}" if dropped else ""

    def _loss(self, attribute: Attribute) -> float | None:
        """Return the error of the worst class without an attribute: 0 if no image reads the attribute, None if images
        need it."""
        if not attribute.is_seen:
            return 0.0
        if attribute.name not in WITHOUT:
            return None
        trip = partial(_constant, attribute.name, WITHOUT[attribute.name])
        errors = {_class_of(judge, name): e for judge in self._judges for name, e in judge.of(trip).items()}
        return max(errors[name] for name in self.classes)

    def _why_never(self, rules: Rules) -> str:
        """Return which attribute fits no target, or that no set of targets can store all attributes together."""
        q = self._question
        for attribute in q.attributes:
            is_blended = attribute.name in rules.blended
            if not any(home.blends == is_blended and home.need(code) for home in q.bins for code in attribute.codes):
                codes = ", ".join(code.name for code in attribute.codes)
                into = " that decals blend into" if is_blended else ""
                return f"no target{into} of these formats can hold {attribute.name} ({codes}); allow other --formats"
        more = "allow more --targets or --formats" + (", or --read-alone none" if rules.read else "")
        return f"no layout of any size holds these attributes under these rules; {more}"

    def _why_too_dear(self, problem: Problem, most: int) -> str:
        solution = least(problem, self._slots, partial(finalists, count=1))
        slots = f"takes {whole(self._slots, solution):g} slots to pack and unpack" if solution else "has unknown cost"
        families = " and ".join(self._question.families)
        return (
            f"{most} issue slots are too few: the cheapest layout of {problem.rules.bytes} bytes {slots} on {families}"
        )

    def _predicted(self, solution: Solution, row: Row) -> Row:
        """Return a layout's predicted figures, and the sources of the error in the worst class."""
        worst = row["worst_class"] or max(self.classes, key=lambda name: solution.errors.get(name, 0.0))
        total = solution.errors[worst]
        shares = {placed.code.attribute: self._errors.get(placed.key, {}).get(worst, 0.0) for placed in solution.placed}
        for pair, beyond in self._together.items():
            if pair <= {placed.key for placed in solution.placed}:
                shares[" with ".join(sorted(name for name, _ in pair))] = beyond.get(worst, 0.0)
        largest = sorted(shares.items(), key=lambda pair: -pair[1])
        parts = [f"{name} {100 * e / total:.0f}%" for name, e in largest if total and abs(e) / total >= 0.01]
        frames = [e for name, e in solution.errors.items() if name.endswith(f" {FRAME}")]
        return {
            "predicted_db": psnr_db(max(frames, default=0.0)),
            "predicted_worst_db": psnr_db(solution.worst_of(self.classes)),
            "error_from": ", ".join(parts) or None,
            "blends": ", ".join(placed.code.attribute for placed in solution.placed if placed.bin.blends) or None,
            "codes": "; ".join(f"{placed.code.attribute} {placed.code.name}" for placed in solution.placed),
            "by_contract": ", ".join(self.unseen) or None,
        }

    def row_of(self, kind: str, layout: Layout) -> Row:
        """Return the row of a layout: its targets, bytes, traffic and cost, and its PSNR and worst class in the
        scenes. If the layout cannot be drawn, `skipped` says why."""
        row = self._empty(kind, layout.name) | {
            "targets": "; ".join(f"{target.format}: {target.holds}" for target in layout.targets),
            "bytes_per_pixel": layout.bytes_per_pixel,
            "contract_bytes": self._contract_bytes(layout),
            "webgpu_bytes": webgpu_cost([target.format for target in layout.targets]),
            **self._in_tile(layout),
            "holds": layout.reflects_by or None,
            **self._traffic(layout),
            **self._slots.columns(layout, self._question.overdraw, self._question.readers.full),
        }
        try:
            # What a layout lacks is no rounding: it is drawn exact, and its bytes are added.
            whole = changes.completed(layout)
            measurements = [(judge, judge.of_layout(whole)) for judge in self._judges]
        except UNMEASURABLE as error:
            return row | {"skipped": str(error)}
        errors = {
            _class_of(judge, n): e for judge, errors_of_scene in measurements for n, e in errors_of_scene.errors.items()
        }
        worst = max((n for n in errors if n.rpartition(" ")[2] in self._question.judging), key=lambda n: errors[n])
        frame = max(e for n, e in errors.items() if n.endswith(f" {FRAME}"))
        return row | {
            "psnr_db": psnr_db(frame),
            "worst_db": psnr_db(errors[worst]),
            "worst_class": worst,
            "held_back_db": self._by_scene_db(errors),
            "flip_p99": max(errors_of_scene.flip for _, errors_of_scene in measurements),
        }

    def _by_scene_db(self, errors: Mapping[str, float]) -> float:
        """Return the PSNR of the mean error over scenes, with the worst class of each scene."""
        worst: dict[str, float] = {}
        for name in self.classes:
            worst[_scene_of(name)] = max(worst.get(_scene_of(name), 0.0), errors[name])
        return psnr_db(float(np.mean(list(worst.values()))))

    def _beside(self, layout: Layout) -> float:
        """Return the bytes per pixel for held attributes that a layout lacks, minus the bytes for emission that the
        layout stores but that is not held."""
        kept = {word.component for word in layout.words}
        held = {
            attribute.name: min(code.total_bits for code in attribute.codes) for attribute in self._question.attributes
        }
        lacks = [held[name] for name, word in LACKS.items() if name in held and word not in kept]
        storages = [(word, layout.targets[word.target].storage) for word in layout.words]
        more = [word.bits_in(storage) for word, storage in storages if "emissive" in word.component]
        return sum(lacks) / 8 - (0 if "emissive" in held else sum(more) / 8)

    def _contract_bytes(self, layout: Layout) -> int:
        return math.ceil(layout.bytes_per_pixel + self._beside(layout))

    def _changes(self, layout: Layout, proposal: Solution) -> str:
        """Return as text the changes from a proposal that would improve a layout most."""
        whole, mine = changes.completed(layout), {}
        for name in COMPONENTS:
            # A number that carries a sign of the normal does not stand alone.
            with suppress(*UNMEASURABLE):
                mine[name] = self._errors_alone(whole, name)
        return changes.said(mine, proposal, lambda name, code: self._errors.get((name, code), {}), self.classes)

    def _errors_alone(self, layout: Layout, attribute: str) -> dict[str, float]:
        only = changes.alone(layout, attribute)
        measurements = [(judge, judge.of_layout(only).errors) for judge in self._judges]
        return {_class_of(judge, n): e for judge, errors in measurements for n, e in errors.items()}

    def _in_tile(self, layout: Layout) -> Row:
        q, taken = self._question, layout.bytes_per_pixel + self._question.light_bytes
        return {"in_tile": taken <= q.tile, "tile_bytes": taken} if q.tile is not None else {}

    def _traffic(self, layout: Layout) -> Row:
        q = self._question
        moved = (q.overdraw * layout.bytes_per_pixel + q.readers.bytes_of(layout)) / 1e6
        return {"mb_1080p": HD * moved, "mb_4k": UHD * moved}

    def _empty(self, kind: str, name: str) -> Row:
        q, judge = self._question, self._judges[0]
        return TABLE.empty() | {
            "kind": kind,
            "layout": name,
            "scene": q.scenes,
            "size": "x".join(map(str, judge.stage.size)),
            "overdraw": q.overdraw,
            "readers": q.readers.said,
        }

    def others(self, device: Device) -> list[Layout]:
        """Return the layouts to compare with: the user's layouts, and engines' layouts that the pipeline can draw;
        count their slots."""
        layouts = [*self._question.against, *self._engines(device)]
        self._slots.count(layouts)
        return layouts

    def _engines(self, device: Device) -> Iterator[Layout]:
        plan = self._judges[0].stage.plan
        for layout in LAYOUTS.values() if self._question.engines else ():
            # Diffuse colour and F0 are other quantities than these codes are for.
            is_named = layout in self._question.against
            if layout.is_whole and not is_named and layout.reflects_by not in ("", DIFFUSE_F0):
                try:
                    check(device, PIPELINES[PIPELINE], plan(layout), True)
                except LayoutError:
                    continue
                yield layout


def _fits_without(problem: Problem, names: Sequence[str]) -> bool:
    """Whether a layout without these attributes can keep to the rules."""
    rules = problem.rules
    kept = [attribute for attribute in problem.attributes if attribute.name not in names]
    left = replace(
        rules,
        blended=rules.blended - {*names},
        together=tuple(group for group in rules.together if not group & {*names}),
        apart=rules.apart - {*names},
        read=rules.read - {*names},
    )
    least = fewest_bytes(replace(problem, attributes=kept, rules=left))
    return least is not None and least <= rules.bytes


def _constant(name: str, value: float, surfaces: Surfaces) -> Surfaces:
    """Return surfaces with one attribute set to the same value everywhere."""
    return replace(surfaces, **{name: np.full_like(getattr(surfaces, name), value)})


def _loss_text(loss: float) -> str:
    if not loss:
        return "not measured"
    return "not visible here" if loss <= HALF_STEP else f"the worst class falls to {psnr_db(loss):.0f} dB"


def _in_channels(problem: Problem) -> Problem:
    """Return a problem without integer targets."""
    return replace(problem, bins=[home for home in problem.bins if not home.fields])


def _with_depth(layout: Layout, depth: DepthEncoding | None) -> Layout:
    """Return a layout with depth in this encoding; unchanged if the layout stores no depth, or if `depth` is None."""
    return replace(layout, depth=depth) if depth and "depth" in layout.components else layout


def _class_of(judge: Exact, name: str) -> str:
    return f"{judge.stage.maker.name} {name}"


def _scene_of(name: str) -> str:
    """Return the scene of a class, whose name consists of the scene's name, a space and the class's own name."""
    return name.rpartition(" ")[0]


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return rows sorted by kind: proposals by limit, then a user's layouts, their improvements, and engines' layouts
    by bytes and by the PSNR of the worst class."""
    kinds = (PROPOSAL, MINE, IMPROVED, ENGINE)
    return sorted(
        rows,
        key=lambda row: (
            kinds.index(row["kind"]),
            row["limit"] or row["bytes_per_pixel"] or 0,
            -(row["worst_db"] or 0),
        ),
    )
