"""Measurement of each codec for an answer: angles, images and instructions, with earlier results from the cache."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import nullcontext
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.codecs.codec import Codec
from ....gbuffer.gl.device import Device
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.setting import Setting
from ...ground.options.gpu_families import CHOICES
from ...ground.output import cache as kept
from ...measures.images.turns import NEAR_DB
from ...measures.worst_case.recorded import SUPREMA, name_of
from ...shaders.code.twin import has_twin
from ...subjects.normals.domains import view_angles
from ...subjects.normals.normal_sets import NORMAL_SETS, NormalSet, from_arrays
from ..mix import judge
from ..mix.table import USES
from ..mix.verdict import DONE
from ..quality import measure as quality
from ..table import Row
from .answer import (
    AFFORDABLE,
    EDGE_SAID,
    ERRORS,
    answered,
    edges_decide,
    floor,
    image_loss,
    image_name,
    price,
    score,
    why_left_out,
    why_unfit,
)
from .images import Images
from .kept_figures import figures_key
from .pictures import write
from .prices import Costs
from .table import TABLE

# The angles of all codes take about this share of the time, images the rest.
OF_ANGLES = 4
SUPREMUM, AXES = "angle_sup_deg", "angle_axes_deg"
# The GPU families that a survey counts for: Mesa has their compilers, which take a second for each.
SURVEYED = (*CHOICES["radeon"], "tgl", "dg2")
# Normals that tell whether decodes have length 1.
FEW = 2**14
QUALITY = ("angle_mean_deg", "angle_max_deg", "angle_counts", "worst_normal", "invalid", "count", "device", "skipped")


@dataclass(frozen=True)
class PickCase:
    """A codec, and the question that it may answer.

    Attributes:
        codec: the codec.
        normal_set: the normals over which its angles are measured.
        makers, setting, powers: the scenes to render, their setting, and the specular powers.
        said: the columns of the row that describe the question.
        pipeline: the renderer, with the requested effects.
        is_surveyed: whether constraints other than the requested ones are measured too.
    """

    codec: Codec
    normal_set: NormalSet
    makers: tuple[SceneMaker, ...]
    setting: Setting
    powers: tuple[float, ...]
    said: Mapping[str, Any]
    pipeline: Pipeline = PIPELINES["deferred"]
    is_surveyed: bool = False

    @property
    def name(self) -> str:
        """The name of the case within its question, in which all cases have the same rounding: `encoding/storage`."""
        return f"{self.codec.encoding.name}/{self.codec.storage.name}"

    @property
    def is_beside(self) -> bool:
        """Whether the case has another storage of the same bytes, so that only its angles are compared."""
        return bool(self.said["beside"])

    def powers_of(self, maker: SceneMaker) -> tuple[float | None, ...]:
        """Return the specular powers with which a scene is drawn; `(None,)` if its materials have no powers."""
        return (None,) if maker.is_metal_rough else self.powers


def rows(
    asked: Sequence[Sequence[PickCase]], device: Device | None, images: Path | None, tick: Callable[[str], None]
) -> Iterator[list[Row]]:
    """Yield the rows of each question, which compares the codecs of one storage on one set of normals and its scenes.

    Images and suprema take seconds each. Images are drawn for codecs that have a place in the answer, or for all that
    qualify if images decide. Suprema are computed for codecs that have a place, or for all that qualify if the
    largest angle decides.

    Args:
        asked: the cases of each question.
        device: device that draws the images; None for no images.
        images: folder for the images of codecs that an answer names; None to write no images.
        tick: called with a name when a case is done.
    """
    if not asked:
        return
    shared = asked[0][0].said
    codecs = [case.codec for chosen in asked for case in chosen]
    costs = Costs(codecs, shared["family"].split(","), shared["readers"])
    others = Costs(codecs, SURVEYED, shared["readers"]) if asked[0][0].is_surveyed else None
    # JAX compiles in a thread of its own while the device draws in this one.
    pool = ThreadPoolExecutor(1)
    try:
        questions = [Question(chosen, pool, costs, others) for chosen in asked]
        # While a device draws in this thread, little Python runs in the other: what JAX traces comes first.
        for question in questions:
            question.measure(tick)
        with Images(device) if device else nullcontext() as drawn:
            for chosen, question in zip(asked, questions, strict=True):
                question.draw(drawn, tick)
                rows = question.rows()
                if drawn and images:
                    write(images, chosen, answered(rows), drawn)
                yield rows
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


class Question:
    """The codecs for one storage, or for storages of the same bytes, on one set of normals and in its scenes."""

    def __init__(self, chosen: Sequence[PickCase], pool: Executor, costs: Costs, others: Costs | None):
        self._pool, self._costs, self._others, self._aim = pool, costs, others, chosen[0].said["aim"]
        self._cases = {case.name: case for case in chosen}
        self._suprema: dict[str, Future[float | None]] = {}
        self._rows = {name: _case_columns(case) | costs.of(case.codec) for name, case in self._cases.items()}
        # Of other storages only codes are compared that cost little, of packings those that do not cost much.
        chosen = [case for name, case in self._cases.items() if price(self._rows[name]) <= self._most_price(case)]
        self._rows = {case.name: self._rows[case.name] for case in chosen}
        self._by_jax = [case for case in chosen if has_twin(case.codec.encoding)]
        # What has no twin is measured by GL, in the thread that draws.
        self._by_gl = [case for case in chosen if not has_twin(case.codec.encoding)]
        self._angle_columns = pool.submit(_angle_columns, self._by_jax)

    def _most_price(self, case: PickCase) -> float:
        """Return the highest cost at which a codec is still compared; infinite unless its storage is another storage
        of the same bytes or a packing."""
        cheap = AFFORDABLE * floor(self._rows[case.name])
        return cheap if case.is_beside else 2 * cheap if case.said["packed"] else math.inf

    def measure(self, tick: Callable[[str], None]) -> None:
        """Measure the angles of all cases and the requested mixing, if any, and start computing the suprema that are
        then needed in the other thread."""
        measured = zip(
            [*self._by_gl, *self._by_jax], [*_angle_columns(self._by_gl), *self._angle_columns.result()], strict=True
        )
        angles = {case.name: row for case, row in measured}
        for name in self._rows:
            self._rows[name] |= angles[name]
        for case in self._own[: len(self._own) // OF_ANGLES]:
            tick(f"{case.codec.name} {case.normal_set.name}")
        # Also of codes with a hole, which has none where the codes without it do not survive.
        for row in list(self._rows.values()):
            if row["mixing"] and not row["beside"] and not why_left_out(row | {"aim": "angle"}):
                self._rows[_case_name(row)] |= _mixing_columns(self._cases[_case_name(row)])
        self._judge_others()
        if self._others:
            self._survey(self._others)
        self._find_suprema(self._qualified_rows("angle") if self._aim == "worst" else self._placed_rows())

    def _survey(self, others: Costs) -> None:
        """Measure issue slots and mixing for other constraints that a reader of the page may set: for all possible
        answers, with mixing in another storage only for codecs that the answer names."""
        named = {_case_name(row) for row in self._placed_rows()}
        for name, row in self._rows.items():
            if why_unfit(row | {"accept_lengths": True}):
                continue
            row["by_family"] = json.dumps(others.slots_of(self._cases[name].codec))
            if name in named or not row["beside"]:
                row["by_use"] = json.dumps(_by_use(self._cases[name]))

    def _judge_others(self) -> None:
        """Measure the effect of mixing on the codec in another storage that the answer would name; if the codec does
        not survive, measure the next one."""
        judged: set[str] = set()
        while waits := [
            row for row in self._placed_rows() if row["beside"] and row["mixing"] and _case_name(row) not in judged
        ]:
            for row in waits:
                judged.add(_case_name(row))
                self._rows[_case_name(row)] |= _mixing_columns(self._cases[_case_name(row)])

    @property
    def _own(self) -> list[PickCase]:
        """The cases with the requested storage, which count as progress."""
        return [case for name, case in self._cases.items() if name in self._rows and not case.is_beside]

    def draw(self, images: Images | None, tick: Callable[[str], None]) -> None:
        """Draw images, if `images` is given, and find the suprema of the codecs that have a place as a result."""
        own = self._own
        left = own[len(own) // OF_ANGLES :]
        if self._aim == "worst":
            self._take_suprema()
        if images:
            if self._aim == "image":
                self._draw_near_the_best(images)
            drawn = self._placed_rows()
            for number, row in enumerate(drawn, 1):
                case = self._cases[_case_name(row)]
                self._rows[case.name] |= images.of(case)
                while left and len(left) > len(own) * (1 - number / len(drawn)):
                    left.pop()
                    tick(f"images of {case.codec.name}")
        for case in left:
            tick(case.codec.name)
        placed = self._placed_rows()
        self._find_suprema([*placed, *self._recorded_front()])
        self._measure_axes([self._cases[_case_name(row)] for row in placed])

    def _draw_near_the_best(self, images: Images) -> None:
        """Draw all codecs that qualify in a few orientations, then the codecs near the best in all orientations."""
        names = [_case_name(row) for row in self._qualified_rows("angle")]
        for name in names:
            self._rows[name] |= images.first(self._cases[name])
        rows = self._qualified_rows(self._aim)
        for figure in (score, image_loss):
            least = min(map(figure, rows), default=0.0)
            near = [row for row in rows if figure(row) - ERRORS * (row["image_se_db"] or 0.0) <= least + NEAR_DB]
            for name in map(_case_name, near):
                self._rows[name] |= images.of(self._cases[name])

    def _measure_axes(self, cases: Sequence[PickCase]) -> None:
        """Measure the largest error over axis-aligned normals: over all of them, or over those with z >= 0 if the
        encoding need not or cannot represent the others."""
        axes = {case.name: replace(case, normal_set=_axis_set(_is_half(case))) for case in cases}
        for name, row in zip(axes, _angle_columns(list(axes.values())), strict=True):
            self._rows[name][AXES] = row["angle_max_deg"]

    def answered(self) -> list[Row]:
        """Return the answered rows with the figures known so far, the best first."""
        return answered(list(self._rows.values()))

    def _placed_rows(self) -> list[Row]:
        """Return the rows with a place in the answer; they are ranked by angle until images exist."""
        rows = list(self._rows.values())
        has_images = any(row.get("image_errors") for row in rows)
        aim = "angle" if self._aim == "image" and not has_images else self._aim
        return [row for row in answered([row | {"aim": aim} for row in rows]) if row["place"]]

    def _recorded_front(self) -> list[Row]:
        """Return the rows on the Pareto front whose suprema are recorded in the package."""
        cases = ((row, self._cases[_case_name(row)]) for row in self.answered() if row["front"])
        return [row for row, case in cases if SUPREMA.find(name_of(case.codec, _is_half(case)), case.codec)]

    def _qualified_rows(self, aim: str) -> list[Row]:
        answer = answered([row | {"aim": aim} for row in self._rows.values()])
        return [row for row in answer if not row["left_out"] and not row["beside"]]

    def _find_suprema(self, wanted: Iterable[Row]) -> None:
        for name in map(_case_name, wanted):
            if name not in self._suprema:
                self._suprema[name] = self._pool.submit(_supremum_deg, self._cases[name])

    def _take_suprema(self) -> None:
        for name, future in self._suprema.items():
            self._rows[name][SUPREMUM] = future.result()

    def rows(self) -> list[Row]:
        """Return the rows, in the order of the cases, after waiting for their suprema."""
        self._take_suprema()
        return list(self._rows.values())


def _is_half(case: PickCase) -> bool:
    """Whether an encoding need not, or cannot, represent all directions."""
    return bool(case.said["needs"] not in (None, "", "sphere") or case.codec.encoding.domain != "sphere")


@cache
def _axis_set(is_half: bool) -> NormalSet:
    """Return the axis-aligned normals, as of floors, walls and ceilings: all, or those with z >= 0."""
    axes = NORMAL_SETS["axes"](0, 0)
    if not is_half:
        return axes
    (load,) = axes.loads()
    chunk = load()
    n, view = (
        np.stack([np.asarray(plane)[: axes.count] for plane in planes], axis=1) for planes in (chunk.n, chunk.view)
    )
    held = n[:, 2] >= 0
    return from_arrays("axes, z >= 0", axes.title, n[held], view[held], np.ones(held.sum(), bool), None)


def _case_name(row: Row) -> str:
    """Return the name of a row's case: `encoding/storage`."""
    return f"{row['encoding']}/{row['storage']}"


def _by_use(case: PickCase) -> Row:
    """Return for each use the reason why a codec cannot be used in this way, empty if it can, and the sum, count and
    maximum of its errors."""
    domain, at_edges = _mixed_domain(case), edges_decide(case.said["needs"])
    key = figures_key("each use", case.codec, domain, at_edges, _normals_key(case))

    def judged() -> Row:
        judgements = judge.judgements(case.codec, list(USES), case.normal_set, domain)
        return {
            use: {
                "cannot": f"cannot be {DONE[use]}"
                if judgement.inside
                else EDGE_SAID
                if judgement.across and at_edges
                else "",
                "count": judgement.count,
                "sum": (judgement.mean_deg or 0.0) * judgement.count,
                "max": judgement.max_deg,
            }
            for use, judgement in judgements.items()
        }

    return kept.figures(key, judged)


def _mixing_columns(case: PickCase) -> Row:
    """Return columns on the effect of the requested mixing: reasons why a codec does not survive, and its errors."""
    uses, domain = case.said["mixing"], _mixed_domain(case)
    key = figures_key("mixing", case.codec, uses, domain, _normals_key(case))

    def judged() -> Row:
        judgement = judge.judgement(case.codec, uses.split(","), case.normal_set, domain)
        reasons = (f"cannot be {DONE[use]}: {why}" for use, why in judgement.inside.items())
        return {
            "cannot_mix": "; ".join(reasons) or None,
            "mixed_across": "; ".join(judgement.across.values()) or None,
            "mixed_mean_deg": judgement.mean_deg,
            "mixed_max_deg": judgement.max_deg,
        }

    return kept.figures(key, judged)


def _mixed_domain(case: PickCase) -> str:
    """Return the domain of the normals to mix: the requested domain, otherwise the encoding's; "hemisphere" instead
    of "sphere" if the set has no normals with z < 0."""
    domain = case.said["needs"] or case.codec.encoding.domain
    return "hemisphere" if domain == "sphere" and not _lost_percent(case.normal_set, "hemisphere") else domain


def _case_columns(case: PickCase) -> Row:
    codec, encoding = case.codec, case.codec.encoding
    images = (image_name(maker.name, power) for maker in case.makers for power in case.powers_of(maker))
    return (
        TABLE.empty(images)
        | dict(case.said)
        | {"storage": codec.storage.name, "encoding": encoding.name, "domain": encoding.domain}
        | {
            "bits": codec.bits,
            "free_bits": 8 * codec.storage.texel_bytes - codec.bits + encoding.sign_bits,
            "table": encoding.has_tables,
        }
        | {
            "seed": case.normal_set.seed,
            "lost_percent": _lost_percent(case.normal_set, encoding.domain, encoding.reach_deg),
        }
        | {"code_bits": codec.code_bits}
    )


def _angle_columns(chosen: Sequence[PickCase]) -> list[Row]:
    """Return the angle columns of each case; cases that are not in the cache are measured together."""
    keys = [figures_key("angles", case.codec, _normals_key(case)) for case in chosen]
    rows = [kept.read_figures(key) for key in keys]
    missing = [_quality_case(case) for case, row in zip(chosen, rows, strict=True) if row is None]
    measured = quality.rows(missing, lambda _: None)
    for index, key in enumerate(keys):
        if rows[index] is None:
            figures = next(measured)
            row = {name: figures[name] for name in QUALITY} | {"length_share": _length_share(figures)}
            rows[index] = row
            if key and not row["skipped"]:
                kept.write(key, row)
    return [row or {} for row in rows]


def length_shares(codecs: Sequence[Codec]) -> dict[str, float | None]:
    """Return the ratio of the length error to the direction error by codec name, over a few normals of the sphere;
    None if it is not known."""
    return {name: row["length_share"] for name, row in _angles_of(codecs, NORMAL_SETS["sphere"](FEW, 0))}


def mean_angles(codecs: Sequence[Codec], normals: NormalSet) -> dict[str, float]:
    """Return the mean angle over a set of normals, in degrees, by codec name; codecs without figures are left out."""
    return {name: row["angle_mean_deg"] for name, row in _angles_of(codecs, normals) if not row["skipped"]}


def _angles_of(codecs: Sequence[Codec], normals: NormalSet) -> Iterator[tuple[str, Row]]:
    cases = [PickCase(codec, normals, (), Setting(), (), {"beside": False, "packed": False}) for codec in codecs]
    yield from zip((codec.name for codec in codecs), _angle_columns(cases), strict=True)


def _length_share(row: Row) -> float | None:
    """Return the RMS error of the decoded lengths divided by the RMS angle in radians; None if there are no figures
    or no direction error.

    |n - n'|^2 = (1 - |n'|)^2 + 2 |n'| (1 - cos theta), and the last term's mean is close to that of theta^2.
    """
    if row["mse"] is None or not row["angle_rms_deg"]:
        return None
    angle = math.radians(row["angle_rms_deg"])
    return math.sqrt(max(0.0, 3 * row["mse"] - angle**2)) / angle


def _quality_case(case: PickCase) -> quality.QualityCase:
    return quality.QualityCase(case.codec, case.normal_set, "jax" if has_twin(case.codec.encoding) else "glsl")


def _supremum_deg(case: PickCase) -> float | None:
    """Return the largest angle in exact arithmetic; None for an encoding that exists only in shaders, or for a set
    without a domain."""
    quality_case = _quality_case(case)
    if quality_case.backend != "jax":
        return None
    key = figures_key("supremum", case.codec, _normals_key(case))
    return kept.figures(key, lambda: {SUPREMUM: quality.measure(replace(quality_case, worst_case=True))[SUPREMUM]})[
        SUPREMUM
    ]


def _normals_key(case: PickCase) -> list[Any] | None:
    """Return the part of a cache key for a set of normals; None for a set that may change between runs."""
    chosen = case.normal_set
    return [chosen.name, chosen.count, chosen.seed] if chosen.name in NORMAL_SETS else None


@cache
def _lost_percent(normals: NormalSet, domain: str, reach_deg: float = 90.0) -> float:
    """Return the percentage of normals outside a domain; for "view", of normals more than `reach_deg` from the line
    of sight."""
    if domain == "sphere":
        return 0.0
    lost = count = 0
    for load in normals.loads():
        chunk = load()
        covered = np.asarray(chunk.covered)
        n, view = (np.stack([np.asarray(c)[covered] for c in plane], axis=-1) for plane in (chunk.n, chunk.view))
        is_lost = n[..., 2] < 0 if domain == "hemisphere" else view_angles(n, view) > reach_deg
        lost, count = lost + int(np.count_nonzero(is_lost)), count + len(n)
    return 100.0 * lost / max(count, 1)
