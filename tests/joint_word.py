"""Measure the gain of one word for normal and roughness, in which the levels per axis depend on roughness.

    python -m tests.joint_word
    python -m tests.joint_word --measure
    python -m tests.joint_word --picture

print the tables of docs/beyond-octahedral.md; the second measures anew, in three minutes, and the third draws the
page's picture. The second draws the images of
`normalbench roughness` for octahedral codes of 3:3 to 16:16 and for small steps of roughness. Then the least worst
error of each form is solved for:

- fixed split: L levels an axis and any number of roughness codes, spaced freely;
- joint: L is free for each code of roughness, sum of L^2 <= 2^bits;
- prefix classes: 2 or 4 ranges of roughness by the word's leading zeros, whole bits in each.

A roughness code that is w wide costs L^2 codes and is off by S w / 2 + E, with E(r, L) the displayed error of the
normals and S(r) that of a step of roughness; so a density of S / (2 (T - E)) codes holds an error T.
"""

from __future__ import annotations

import itertools
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

import numpy as np
from PIL import Image

from normalbench.bench.ground.machine.devices import require_device
from normalbench.bench.subjects.environments.environment_names import environment_named
from normalbench.bench.tables.roughness.frames import Accumulation
from normalbench.bench.tables.roughness.measure import Pictures, RoughnessCase
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.rules import by_rule

OBJECTS = (("panel4", "lamp"), ("panel20", "lamp"), ("panel4", "studio"), ("panel20", "studio"), ("plaster", None))
ROUGHNESS = (0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.85, 1)
BITS, WORDS = tuple(range(3, 17)), (20, 24, 28, 30, 32)
# Least roughnesses of materials: a perfect mirror, and that to which Frostbite clamps (Lagarde and de Rousiers 2014).
LEAST = (0.0, 0.045)
SIZE, STEPS = (400, 300), (0.004, 0.016)
KEPT = Path(__file__).parent / "inputs" / "joint_word.json"
FINE = np.arange(3, 16.001, 0.05)
LARGEST, LEAST_ERROR = 600.0, 0.05
# Words of 32 bits with a fixed split: bits an axis, bits of roughness, and the power of the code that is roughness.
SPLITS = {
    "10:10, roughness 12": (10, 12, 1),
    "12:12, roughness 8": (12, 8, 1),
    "13:13, roughness 6": (13, 6, 1),
    "13:13, square root of roughness 6": (13, 6, 2),
    "13:13, cube root of roughness 6": (13, 6, 3),
}
SHOWN_AT, TIMES = (0.05, 0.1), 8
SHOWN_SPLITS = ("10:10, roughness 12", "13:13, roughness 6", "13:13, cube root of roughness 6")
PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "joint-word.png"


def measured(objects=OBJECTS, roughness=ROUGHNESS, bits=BITS, size=SIZE) -> tuple[np.ndarray, np.ndarray]:
    """Return E of shape (roughnesses, bits) and S of shape (roughnesses,): the 99th percentile of the displayed
    difference, of 255, by octahedral codes and for a step of roughness of 1, on the worst object."""
    codecs = tuple(Codec(ENCODINGS["octahedral"], by_rule("unorm", (count, count))) for count in bits)
    parts = [_of_object(name, environment, codecs, roughness, size) for name, environment in objects]
    return np.max([part[0] for part in parts], 0), np.max([part[1] for part in parts], 0)


def _of_object(name, environment, codecs, roughness, size) -> tuple[np.ndarray, np.ndarray]:
    surroundings = environment_named(environment) if environment else None
    case = RoughnessCase(codecs, name, surroundings, (0.1,), size)
    with ExitStack() as stack:
        pictures = Pictures(require_device(), stack, case)
        frame = pictures.exact(1)
        covered = frame.covered

        def image(of, rough: float) -> np.ndarray:
            return pictures.image(of, rough)[covered].astype(np.float64)

        def apart(one: np.ndarray, other: np.ndarray) -> float:
            return 255 * float(np.percentile(abs(one - other).max(-1), 99))

        exact = {rough: image(frame, rough) for rough in roughness}
        errors = np.zeros((len(roughness), len(codecs)))
        for column, codec in enumerate(codecs):
            with ExitStack() as opened:
                decoded = pictures.opened(opened, codec, Accumulation())
                errors[:, column] = [apart(image(decoded, rough), exact[rough]) for rough in roughness]
        slopes = [
            max(apart(image(frame, rough + way * step), exact[rough]) / step for step in STEPS)
            for rough, way in ((rough, 1 if rough + max(STEPS) <= 1 else -1) for rough in roughness)
        ]
    return errors, np.array(slopes)


class Problem:
    """E and S between the measured roughnesses and levels: logarithms of E along both, S straight.

    Args:
        roughness, bits: where they were measured.
        errors, slopes: E and S there.
        least: the least roughness of materials.
    """

    def __init__(self, roughness, bits, errors, slopes, least: float = 0.0):
        self.least, self.grid = least, np.linspace(least, 1, 801)
        self.step = self.grid[1] - self.grid[0]
        columns = np.log(np.maximum(errors, LEAST_ERROR)).T
        along = np.array([np.interp(self.grid, roughness, column) for column in columns]).T
        self.errors = np.exp([np.interp(FINE, bits, row) for row in along])
        self.slopes = np.interp(self.grid, roughness, slopes)
        self.levels = 2**FINE

    def _sum(self, values: np.ndarray) -> float:
        return float(((values[1:] + values[:-1]) / 2).sum() * self.step)

    def _density(self, target: float) -> np.ndarray:
        """Return how many codes of roughness a unit of it takes, by roughness and levels; infinite where none hold."""
        room = target - self.errors
        return np.where(room > 0, self.slopes[:, None] / (2 * np.maximum(room, 1e-12)), np.inf)

    def joint(self, target: float) -> float:
        """Return how many codes a word takes whose levels depend on roughness."""
        least = (self.levels**2 * self._density(target)).min(1)
        return self._sum(least) if np.isfinite(least).all() else np.inf

    def fixed(self, target: float) -> float:
        """Return how many codes the best fixed split takes, whose fields have whole or broken numbers of bits."""
        density = self._density(target)
        sums = ((density[1:] + density[:-1]) / 2).sum(0) * self.step
        return float(np.min(self.levels**2 * np.maximum(sums, 1)))

    def half_steps(self, bits: int, power: float) -> np.ndarray:
        """Return the largest error of roughness in a code of `bits` bits whose power it is, by roughness."""
        most, span = 2**bits - 1, 1 - self.least
        code = ((self.grid - self.least) / span) ** (1 / power)
        above = span * np.minimum(code + 0.5 / most, 1) ** power - (self.grid - self.least)
        return np.maximum(above, self.grid - self.least - span * np.maximum(code - 0.5 / most, 0) ** power)

    def split(self, axis_bits: int, bits: int, power: float) -> np.ndarray:
        """Return the error of a word with a fixed split, by roughness."""
        return self.slopes * self.half_steps(bits, power) + self.errors[:, np.searchsorted(FINE, axis_bits - 1e-9)]

    def classes(self, bits: int, classes: int) -> list[tuple[float, int, float]]:
        """Return the classes with the least worst error: the roughness at which each ends, its normal's bits, and the
        error."""
        target = self.solved(bits)[f"prefix {classes}"]
        cells = self._density(target) * self.step
        last = len(self.grid) - 1
        ends = next(ends for order in _orders(bits, classes) if (ends := self._ends(order, cells))[-1][0] == last)
        return [(float(self.grid[end]), both, target) for end, both in ends]

    def prefix(self, target: float, bits: int, classes: int) -> bool:
        """Whether classes by leading zeros hold an error: of `bits` - 1, - 2, ... bits, the last two of as many."""
        cells = self._density(target) * self.step
        return any(self._ends(order, cells)[-1][0] == len(self.grid) - 1 for order in _orders(bits, classes))

    def _ends(self, order: Sequence[int], cells: np.ndarray) -> list[tuple[int, int]]:
        """Return how far each class reaches, and its normal's bits."""
        start, ends = 0, []
        for size in order:
            reached = [(start, 0)]
            for both in range(6, min(size, 32) + 1):
                column = cells[start:, np.searchsorted(FINE, both / 2 - 1e-9)]
                end = start + int(np.searchsorted(np.cumsum(column), 2.0 ** (size - both), side="right"))
                reached.append((min(end, len(self.grid) - 1), both))
            ends.append(max(reached))
            start = ends[-1][0]
        return ends

    def solved(self, bits: int) -> dict[str, float]:
        """Return the least worst error of each form in a word of `bits` bits."""
        count = 2.0**bits
        return {
            "fixed": least_error(lambda target: self.fixed(target) <= count),
            "joint": least_error(lambda target: self.joint(target) <= count),
            "prefix 2": least_error(lambda target: self.prefix(target, bits, 2)),
            "prefix 4": least_error(lambda target: self.prefix(target, bits, 4)),
        }


def _orders(bits: int, classes: int) -> list[tuple[int, ...]]:
    """Return the orders of the classes' sizes in bits, along roughness."""
    sizes = [bits - 1 - min(index, classes - 2) for index in range(classes)]
    return sorted(set(itertools.permutations(sizes)))


def least_error(holds: Callable[[float], bool]) -> float:
    """Return the least error that holds, by bisection of its logarithm."""
    low, high = LEAST_ERROR, LARGEST
    for _ in range(40):
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def cells(errors: Mapping[str, float]) -> list[str]:
    """Return the cells of the page's table for a word: the fixed split's error, and the gains in dB over it."""
    gains = [20 * np.log10(errors["fixed"] / errors[form]) for form in ("joint", "prefix 4")]
    return [f"{errors['fixed']:.1f}", *(f"{gain:.1f}" for gain in gains)]


def problems() -> list[Problem]:
    """Return the problem of what was measured, for each least roughness."""
    kept = json.loads(KEPT.read_text())
    errors, slopes = np.array(kept["errors"]), np.array(kept["slopes"])
    return [Problem(ROUGHNESS, BITS, errors, slopes, least) for least in LEAST]


def rows() -> list[list[str]]:
    """Return the rows of the page's table of gains: for each word its bits, and the cells for each least roughness."""
    both = problems()
    return [[str(bits), *(cell for problem in both for cell in cells(problem.solved(bits)))] for bits in WORDS]


def word_rows() -> list[list[str]]:
    """Return the rows of the page's table of words of 32 bits: the error of the worst roughness for each least one."""
    both = problems()
    lines = [[name, *(f"{problem.split(*split).max():.1f}" for problem in both)] for name, split in SPLITS.items()]
    solved = [problem.solved(32) for problem in both]
    names = {"fixed": "the best fixed split", "prefix 2": "2 classes", "prefix 4": "4 classes", "joint": "any levels"}
    return lines + [[name, *(f"{errors[form]:.1f}" for errors in solved)] for form, name in names.items()]


def picture() -> None:
    """Draw the page's picture: a panel by roughness, exact and as words give it where roughness is furthest from its
    codes, each with its difference below."""
    _, problem = problems()
    ends = problem.classes(32, 4)
    case = RoughnessCase((), "panel20", environment_named("lamp"), (0.1,), SIZE)
    lines = []
    with ExitStack() as stack:
        pictures = Pictures(require_device(), stack, case)
        for rough in SHOWN_AT:
            frame = pictures.exact(1)
            panel = np.ix_(frame.covered.any(1), frame.covered.any(0))
            exact = pictures.image(frame, rough)[panel]
            both = next(both for end, both, _ in ends if rough <= end)
            at = int(np.argmin(abs(problem.grid - rough)))
            splits = [(2 * SPLITS[name][0], problem.half_steps(*SPLITS[name][1:])[at]) for name in SHOWN_SPLITS]
            room = ends[0][2] - problem.errors[at, np.searchsorted(FINE, both / 2 - 1e-9)]
            images = []
            for count, step in [*splits, (both, room / problem.slopes[at])]:
                codec = Codec(ENCODINGS["octahedral"], by_rule("unorm", (count - count // 2, count // 2)))
                with ExitStack() as opened:
                    decoded = pictures.opened(opened, codec, Accumulation())
                    images.append(pictures.image(decoded, rough + float(step))[panel])
            apart = [np.clip(TIMES * abs(image - exact), 0, 1) for image in images]
            shown = np.hstack([exact, *images]), np.hstack([np.zeros_like(exact), *apart])
            lines.append(np.vstack(shown))
            off = [255 * float(np.percentile(abs(image - exact).max(-1), 99)) for image in images]
            print(rough, both, " ".join(f"{error:.1f}" for error in off))
    image = Image.fromarray(np.round(255 * np.vstack(lines)).astype(np.uint8))
    image.thumbnail((960, image.height))
    image.save(PICTURE, optimize=True)


def main() -> None:
    """Print the rows of the page's tables; with --measure keep what was measured first, with --picture draw."""
    if "--picture" in sys.argv[1:]:
        return picture()
    if "--measure" in sys.argv[1:]:
        lists = [np.round(part, 3).tolist() for part in measured()]
        KEPT.write_text(json.dumps(dict(zip(("errors", "slopes"), lists, strict=True))) + "\n")
    for line in [*rows(), *word_rows()]:
        print("|", " | ".join(line), "|")
    return None


if __name__ == "__main__":
    main()
