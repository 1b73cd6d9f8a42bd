"""What an answer needs of each code: angles, images and instructions. What was measured before is not measured anew."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import jax
import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS, is_in_catalogue
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....gbuffer.display import Display, measured_exposure
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.layouts.words import LayoutError
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.render import Keeps, rendering
from ....gbuffer.scenes.catalogue import SCENES, SceneMaker
from ....gbuffer.scenes.setting import Setting
from ...metrics.images import squared_error
from ...metrics.totals import psnr_db
from ...normals.normal_sets import NORMAL_SETS, NormalSet
from ...output import cache as kept
from ...output.sources import sources
from ...worst_case.exact_figures import has_twin
from ..cost import measure as cost
from ..mix import judge
from ..mix.verdict import DONE
from ..quality import measure as quality
from ..render import measure as render
from .answer import IMAGE, answered, clearly_beats
from .table import TABLE

Row = dict[str, Any]
# Half a decibel from what 640 x 480 and three moments say, in a sixth of the time.
SIZE = (320, 240)
STAGE = "fragment"
SUPREMUM = "angle_sup_deg"
QUALITY = ("angle_mean_deg", "angle_max_deg", "invalid", "count", "device", "skipped")


@dataclass(frozen=True)
class Case:
    """One code and what is asked of it.

    Attributes:
        codec: the code.
        normal_set: what its angles are over.
        maker, setting, powers: what is rendered, and with which specular powers.
        said: what the row says of the question.
        pipeline: what renders, with the effects that were asked for.
    """

    codec: Codec
    normal_set: NormalSet
    maker: SceneMaker
    setting: Setting
    powers: tuple[float, ...]
    said: Mapping[str, Any]
    pipeline: Pipeline = PIPELINES["hybrid"]


def rows(asked: Sequence[Sequence[Case]], device: Device | None, tick: Callable[[str], None]) -> Iterator[list[Row]]:
    """The rows of each question: the codes of one storage on one set of normals and in one scene, in their order.

    Images and suprema take seconds each. Images are of codes that no other one beats by its angles and instructions;
    of all that qualify where the image decides. Suprema are of the best; of all where the largest angle decides.

    Args:
        device: draws; without one there are no images.
    """
    if not asked:
        return
    encodings = dict.fromkeys(case.codec.encoding for chosen in asked for case in chosen)
    costs = Costs(encodings, asked[0][0].said["family"])
    pictures = Pictures(device) if device else None
    # JAX compiles in a thread of its own while the device draws in this one.
    pool = ThreadPoolExecutor(1)
    try:
        questions = [Question(chosen, pool, costs) for chosen in asked]
        # While a device draws in this thread, little Python runs in the other: what JAX traces comes first.
        for question in questions:
            question.measure(tick)
        for question in questions:
            question.draw(pictures)
            yield question.rows()
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


class Question:
    """The codes of one storage on one set of normals and in one scene."""

    def __init__(self, chosen: Sequence[Case], pool: Executor, costs: Costs):
        self._cases = {case.codec.encoding.name: case for case in chosen}
        self._pool, self._costs, self._aim = pool, costs, chosen[0].said["aim"]
        self._suprema: dict[str, Future[float | None]] = {}
        self._by_jax = [case for case in chosen if has_twin(case.codec.encoding)]
        # What has no twin is measured by GL, in the thread that draws.
        self._by_gl = [case for case in chosen if not has_twin(case.codec.encoding)]
        self._angles = pool.submit(_angles, self._by_jax)
        self._rows: dict[str, Row] = {}

    def measure(self, tick: Callable[[str], None]) -> None:
        """Angles and instructions; the suprema that they ask for are still computed in the other thread."""
        measured = zip([*self._by_gl, *self._by_jax], [*_angles(self._by_gl), *self._angles.result()], strict=True)
        angles = {case.codec.encoding.name: row for case, row in measured}
        for name, case in self._cases.items():
            self._rows[name] = _described(case) | angles[name] | self._costs.of(case.codec.encoding)
            tick(f"{case.codec.name} {case.normal_set.name}")
        for row in self._qualified("angle"):
            if row["mixing"]:
                self._rows[row["encoding"]] |= _mixed(self._cases[row["encoding"]])
        self._find_suprema(self._qualified("angle") if self._aim == "worst" else self.answered()[:1])

    def draw(self, pictures: Pictures | None) -> None:
        """Images, if there is what draws them, and the supremum of the best."""
        if self._aim == "worst":
            self._take_suprema()
        if pictures:
            fit = self._qualified("angle")
            better = [] if self._aim == "image" else fit
            drawn = [row for row in fit if not any(clearly_beats(one, row) for one in better)]
            for row in drawn + [row for row in self._rows.values() if row["against"]]:
                self._rows[row["encoding"]] |= pictures.of(self._cases[row["encoding"]])
        self._find_suprema(self.answered()[:1])

    def answered(self) -> list[Row]:
        """The rows as far as they are known, the best first."""
        return answered(list(self._rows.values()))

    def _qualified(self, aim: str) -> list[Row]:
        return [row for row in answered([row | {"aim": aim} for row in self._rows.values()]) if not row["left_out"]]

    def _find_suprema(self, wanted: Iterable[Row]) -> None:
        for row in wanted:
            if row["encoding"] not in self._suprema:
                case = self._cases[row["encoding"]]
                self._suprema[row["encoding"]] = self._pool.submit(_supremum, case)

    def _take_suprema(self) -> None:
        for name, found in self._suprema.items():
            self._rows[name][SUPREMUM] = found.result()

    def rows(self) -> list[Row]:
        """The rows, in the order of the cases."""
        self._take_suprema()
        return list(self._rows.values())


def _mixed(case: Case) -> Row:
    """Why a code does not survive the mixing that is asked for, if it does not."""
    uses, domain = case.said["mixing"], case.said["needs"] or case.codec.encoding.domain
    if domain == "sphere" and not _lost(case.normal_set, "hemisphere"):
        domain = "hemisphere"
    key = _key("mixing", case.codec, uses, domain, _normals(case))

    def judged() -> Row:
        found = judge.faults(case.codec, uses.split(","), case.normal_set, domain)
        said = (f"cannot be {DONE[use]}: {why}" for use, why in found.items())
        return {"cannot_mix": "; ".join(said) or None}

    return kept.kept(key, judged)


def _described(case: Case) -> Row:
    encoding = case.codec.encoding
    return (
        TABLE.empty(f"{power:g}" for power in case.powers)
        | dict(case.said)
        | {"storage": case.codec.storage.name, "encoding": encoding.name, "domain": encoding.domain}
        | {
            "bits": case.codec.bits,
            "seed": case.normal_set.seed,
            "lost_percent": _lost(case.normal_set, encoding.domain),
        }
    )


def _angles(chosen: Sequence[Case]) -> list[Row]:
    """The columns of angles of each case, measured together where they are not kept."""
    keys = [_key("angles", case.codec, _normals(case)) for case in chosen]
    rows = [kept.read(key) if key else None for key in keys]
    missing = [_quality_case(case) for case, row in zip(chosen, rows, strict=True) if row is None]
    measured = quality.rows(missing, lambda _: None)
    for at, key in enumerate(keys):
        if rows[at] is None:
            row = {name: value for name, value in next(measured).items() if name in QUALITY}
            rows[at] = row
            if key and not row["skipped"]:
                kept.write(key, row)
    return [row or {} for row in rows]


def _quality_case(case: Case) -> quality.Case:
    return quality.Case(case.codec, case.normal_set, "jax" if has_twin(case.codec.encoding) else "glsl")


def _supremum(case: Case) -> float | None:
    """The largest angle in exact arithmetic; None of a code in GLSL alone and of a set without a domain."""
    one = _quality_case(case)
    if one.backend != "jax":
        return None
    key = _key("supremum", case.codec, _normals(case))
    return kept.kept(key, lambda: {SUPREMUM: quality.measure(replace(one, worst_case=True))[SUPREMUM]})[SUPREMUM]


def _normals(case: Case) -> list[Any] | None:
    """What is kept of a set of normals in a key; None of one that may be another next time."""
    chosen = case.normal_set
    return [chosen.name, chosen.count, chosen.seed] if chosen.name in NORMAL_SETS else None


def _key(what: str, codec: Codec, *parts: Any) -> str:
    """Where figures are kept for good; empty where they may be others next time."""
    if None in parts or not is_in_catalogue(codec.encoding):
        return ""
    return kept.key_of("pick", what, sources(), jax.__version__, codec.name, *map(repr, parts))


class Pictures:
    """The error of the image that is lit by a code's normals, each scene's reference drawn once."""

    def __init__(self, device: Device):
        self._device = device
        self._references: dict[tuple[SceneMaker, Setting, tuple[float, ...], Pipeline], list[np.ndarray]] = {}

    def of(self, case: Case) -> Row:
        """The PSNR of the displayed image at each power; none where the device or a layout has no room for the code."""
        known = case.maker.name if case.maker is SCENES.get(case.maker.name) else None
        asked = (case.setting, case.powers, case.said.get("effects") or "")
        key = _key("image", case.codec, known, *asked, self._device.renderer)
        try:
            return kept.kept(key, lambda: self._measured(case))
        except (LayoutError, *render.UNMEASURABLE):
            return {}

    def _measured(self, case: Case) -> Row:
        shown = self.shown(case).items()
        return {f"{IMAGE}{power:g}": psnr_db(squared_error(image, right)[0]) for power, (image, right) in shown}

    def shown(self, case: Case) -> dict[float, tuple[np.ndarray, np.ndarray]]:
        """At each power the displayed image, and that of exact normals: (height, width, 3), 0 to 1.

        Raises:
            LayoutError, or one of render.UNMEASURABLE: there is no room for the code.
        """
        layout = LAYOUTS["fp32"].with_codec(case.codec)
        images = self._relit(case) if has_twin(case.codec.encoding) else self._drawn(case, layout)
        question = (case.maker, case.setting, case.powers, case.pipeline)
        if question not in self._references:
            self._references[question] = self._drawn(case, LAYOUTS["fp32"])
        found: dict[float, tuple[np.ndarray, np.ndarray]] = {}
        for power, image, right in zip(case.powers, images, self._references[question], strict=True):
            display = _display(case.maker, right)
            found[power] = display.image(image), display.image(right)
        return found

    def _relit(self, case: Case) -> list[np.ndarray]:
        """Images lit by what JAX makes of the normals. No shader is compiled for the code, which takes a second."""

        def keeps(position: np.ndarray, n: np.ndarray) -> np.ndarray:
            render.require_surface(case.maker, len(n) > 0)
            return quality.round_trip(case.codec, n, position)

        return self._drawn(case, LAYOUTS["fp32"], keeps)

    def _drawn(self, case: Case, layout: Layout, keeps: Keeps | None = None) -> list[np.ndarray]:
        plan = Plan(SIZE, 1, layout, LIGHT_BUFFERS["rgba32f"], 2, True, 1.0)
        scene, shown = case.maker.make(case.setting), []
        with rendering(self._device, case.pipeline, scene, plan) as made:
            for power in case.powers:
                made.draw(scene.with_power(power), keeps)
                shown.append(made.image())
        return shown


def _display(maker: SceneMaker, right: np.ndarray) -> Display:
    """As the render table shows a scene, by its reference in linear light."""
    if maker.exposure is not None:
        return Display(maker.exposure)
    return Display(measured_exposure(right.reshape(-1, 3)))


@cache
def _lost(normals: NormalSet, domain: str) -> float:
    """The percentage of normals that lie outside a domain."""
    if domain == "sphere":
        return 0.0
    lost = count = 0
    for load in normals.loads():
        chunk = load()
        n, view, covered = ([np.asarray(c) for c in chunk.n], [np.asarray(c) for c in chunk.view], chunk.covered)
        is_lost = n[2] < 0 if domain == "hemisphere" else sum(a * b for a, b in zip(n, view, strict=True)) > 0
        covered = np.asarray(covered)
        lost, count = lost + int(np.count_nonzero(is_lost & covered)), count + int(np.count_nonzero(covered))
    return 100.0 * lost / max(count, 1)


class Costs:
    """Instructions of encodings on one family; unknown where this machine has no compilers."""

    def __init__(self, encodings: Iterable[Encoding], family: str):
        self._rows = cost.counted(encodings, family, STAGE)

    def of(self, encoding: Encoding) -> Row:
        """The columns of instructions; None where they are not known."""
        encode, decode = (self._rows.get((encoding.name, operation)) for operation in cost.OPERATIONS)
        if not encode or not decode:
            return {}
        return {
            "encode_instructions": encode["instructions"],
            "decode_instructions": decode["instructions"],
            "instructions": encode["instructions"] + decode["instructions"],
            "loops": (encode["loops"] or 0) + (decode["loops"] or 0),
        }
