"""Measurement and display of the pick table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from ....encodings.catalogue import is_in_catalogue
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.rules import of_count
from ....encodings.storages.storage import STORAGES, Storage
from ....gbuffer.effects.effect import ChosenEffect
from ....gbuffer.gl.device import Device
from ....gbuffer.pipelines import PIPELINES, Pipeline
from ....gbuffer.scenes.catalogue import SceneMaker
from ....gbuffer.scenes.setting import Setting
from ...ground.choose import choose, choose_one
from ...ground.machine.devices import found_device, require_jax
from ...ground.options.counts import MAX_POWER, MOST_INSTRUCTIONS, check_seed, checked_count, checked_numbers, in_range
from ...ground.output.errors import UsageError, by_reason, leave_out, tell
from ...ground.output.writing import check_folder
from ...ground.spelling import spelled
from ...subjects.codecs.names import as_declared, check_twin, codecs_named
from ...subjects.names.effects import effects_named, lacking, name_of, pipeline_with
from ...subjects.names.storages import roundings_named, storages_named
from ...subjects.normals.normal_names import lacking_rays, normal_sets_named
from ...subjects.normals.normal_sets import NormalSet
from ...subjects.scenes.scene_names import scene_makers_named
from ..families_named import families_named
from ..mix.table import USES
from ..table import COMPILERS, GL, Measured, Row, Sheet, Step, Tick, Work
from . import measure, pictures
from .answer import AIMS, ELSEWHERE, answered, asked_of, groups, images, largest, largest_mixed, mean
from .charts import charts
from .choices import extras
from .sentences import called, conditions, in_short, left_out, told
from .table import TABLE, PickOptions, PickOutputs

MOST_READERS, MOST_WORTH, MOST_ENOUGH = 64, 100.0, 360.0
# By the domain that is asked for, the set that is measured.
SETS = {None: "sphere", "sphere": "sphere", "hemisphere": "hemisphere", "view": "playground"}
# Where normals have all directions, z >= 0, or face the viewer.
SPACES = {"sphere": "sphere", "tangent": "hemisphere", "terrain": "hemisphere", "map": "hemisphere", "view": "view"}
WHICH_SPACE = (
    "--domain hemisphere: ambiguous; use tangent, terrain or map for normals with z >= 0, view for a G-buffer's "
    "normals in view space, and sphere in world space"
)
# Below so many random normals, chance decides between codes.
FEW = 4096
# What people see of the front.
SHOWN = ("encoding", "storage", "place", "bits", "free_bits", "angle_mean_deg", "largest_deg", "image_db_*", "slots")


@dataclass(frozen=True)
class PickStep:
    """The cases of a question, the device that draws them, and the folder for their images, if requested."""

    cases: Sequence[measure.PickCase]
    device: Device | None
    images: Path | None


def questions(options: PickOptions) -> list[list[measure.PickCase]]:
    """Return a list of cases for each combination of rounding, storage or number of bytes, and set of normals: a case
    for each codec that fits.

    Raises:
        UsageError: unknown names, counts out of range, or no codec that fits.
    """
    count = checked_count(options.count)
    check_seed(options.seed)
    shared = _question(options)
    asked = _asked(options)
    names = tuple(dict.fromkeys(storage.name for storages in asked.values() for storage in storages))
    against = as_declared(codecs_named(options.against, names, options.rounding)) if options.against else []
    named = {codec.encoding.name for codec in against}
    codecs = dict.fromkeys([*as_declared(codecs_named(options.encoding, names, options.rounding)), *against])
    fit, misfits = _fitting(codecs)
    # Those of the catalogue are traced by tests.
    encodings = list(dict.fromkeys(codec.encoding for codec in codecs))
    for encoding in dict.fromkeys(codec.encoding for codec in fit if not is_in_catalogue(codec.encoding)):
        check_twin(encoding)
    needs_rays = any(codec.encoding.domain == "view" for codec in fit)
    chosen = options.normals or (SETS[shared["needs"]],)
    sets = normal_sets_named(chosen, count, options.seed, options.reading, needs_rays)
    if shared["needs"] == "view":
        sets = [normals.facing() for normals in sets]
    _say_if_few(sets)
    powers, makers = (
        checked_numbers("--power", options.power, float, 1, MAX_POWER),
        _scenes(options, shared["needs"]),
    )
    effects = effects_named(options.effects) if options.effects else []
    setting = Setting(seed=options.seed)
    pipeline = _pipeline(effects, makers, setting)
    shared |= {"effects": name_of(effects), "scene": ",".join(maker.name for maker in makers)}
    for codec in (packed_codec for packed_codec in fit if packed_codec.encoding.is_packed):
        for name in (name for name, storages in asked.items() if not _is_held(codec, storages, codec.rounding)):
            leave_out(
                f"{codec.encoding.name} packs into a {codec.storage.texel_bytes}-byte integer; "
                f"texels of {name} have a different size"
            )
    for line in misfits if "all" not in options.encoding else ():
        leave_out(line)

    def case(codec: Codec, normals: NormalSet, about: Row) -> measure.PickCase:
        more: Row = {"normals": normals.name, "code_space": normals.code_space}
        more["against"] = codec.encoding.name in named and not about["beside"]
        return measure.PickCase(
            codec, normals, makers, setting, powers, shared | about | more, pipeline, options.survey
        )

    case_groups = [
        [
            case(codec, normals, about)
            for codec, about in _compared(name, storages, rounding, fit, encodings)
            if normals.serves(codec.encoding)
        ]
        for rounding in roundings_named(options.rounding)
        for name, storages in asked.items()
        if any(_is_held(codec, storages, rounding) for codec in fit)
        for normals in sets
    ]
    lacking = lacking_rays((codec.encoding, normals) for codec in fit for normals in sets)
    if lacking and not any(case_groups):
        raise UsageError(lacking[0])
    for line in dict.fromkeys(lacking) if "all" not in options.encoding else ():
        leave_out(line)
    return [cases for cases in case_groups if cases]


def _scenes(options: PickOptions, needs: str | None) -> tuple[SceneMaker, ...]:
    """Return the scenes to draw. Normals with z >= 0 have none unless scenes are named, because no G-buffer is
    limited to them."""
    is_usual = options.scene == PickOptions().scene and options.aim != "image" and not options.effects
    return () if needs == "hemisphere" and is_usual else tuple(scene_makers_named(options.scene))


def _say_if_few(sets: Iterable[NormalSet]) -> None:
    """Print a line for each count of random normals that is so low that another seed may change the answer."""
    few = {normals.count: normals.name for normals in sets if normals.area is not None and normals.count < FEW}
    for count, name in few.items():
        tell(
            f"--count {count}: with fewer than {FEW} random normals ({name}), "
            "a different --seed may give a different answer"
        )


def _asked(options: PickOptions) -> dict[str, list[Storage]]:
    """Return the storages of each question, by the storage or number of bytes requested. Raises UsageError."""
    if options.bytes is None:
        # Of floats whose number nobody said, all that a texel has.
        asked = [of_count(storage, storage.channels) for storage in storages_named(options.storage)]
        return {storage.name: [storage, *_packings(storage)] for storage in asked}
    sizes = sorted({storage.texel_bytes for storage in STORAGES.values()})
    chosen = choose("number of bytes", options.bytes, {str(size): size for size in sizes})
    return {
        f"{size} bytes": [candidate for candidate in STORAGES.values() if candidate.texel_bytes == size]
        for size in chosen
    }


def _packings(storage: Storage) -> list[Storage]:
    """Return the storages that are packed in texels of a storage."""
    return [other for other in STORAGES.values() if other.is_packed and other.target == storage and other != storage]


def _compared(
    name: str, storages: Sequence[Storage], rounding: str, fit: Sequence[Codec], encodings: Sequence[Encoding]
) -> Iterator[tuple[Codec, Row]]:
    """Yield the codecs of a question with their columns: the requested codecs, then, if one storage was requested,
    the codecs in other storages with the same number of bytes."""
    size, is_one = storages[0].texel_bytes, storages[0].name == name
    about: Row = {"asked": name, "bytes": size, "rounding": rounding, "beside": False, "packed": False}
    for codec in fit:
        if _is_held(codec, storages, rounding):
            is_laid = is_one and codec.storage.name != name and not codec.encoding.is_packed
            yield codec, about | {"packed": is_laid}
    others = (
        [sibling for sibling in STORAGES.values() if sibling.texel_bytes == size and sibling not in storages]
        if is_one
        else []
    )
    codecs = (Codec(encoding, other, rounding) for other in others for encoding in encodings if not encoding.is_packed)
    yield from ((codec, about | {"beside": True}) for codec in codecs if codec.fits)


def _is_held(codec: Codec, storages: Sequence[Storage], rounding: str) -> bool:
    """Whether a codec belongs to a question: it has the storage and rounding, or it is an integer of the same number
    of bytes."""
    is_integer = codec.encoding.is_packed and codec.storage.texel_bytes == storages[0].texel_bytes
    return is_integer or (codec.storage in storages and codec.rounding == rounding)


def _pipeline(effects: Sequence[ChosenEffect], makers: Sequence[SceneMaker], setting: Setting) -> Pipeline:
    """Return the pipeline that renders the images. Raises UsageError for effects that cannot be combined or that have
    nothing to do in a scene."""
    complaints: list[str] = []
    # Pixels can be sampled of deferred shading; some effects need what is special to the hybrid pipeline.
    pipeline = pipeline_with(PIPELINES["hybrid" if effects else "deferred"], effects, complaints)
    complaints += filter(None, (lacking(effects, maker.name, maker.make(setting)) for maker in makers))
    if not pipeline or complaints:
        raise UsageError(complaints[0])
    return pipeline


def _question(options: PickOptions) -> Row:
    """Return the columns on the question, which all rows share. Raises UsageError for an invalid question."""
    if options.most_instructions is not None:
        in_range("--most-instructions", options.most_instructions, 0, MOST_INSTRUCTIONS)
    in_range("--readers", options.readers, 0, MOST_READERS)
    if not 0 < options.worth <= MOST_WORTH:
        raise UsageError(f"--worth {options.worth:g}: out of range; use more than 0, up to {MOST_WORTH:g} dB")
    if options.domain and spelled("domain", options.domain, ["hemisphere"]):
        raise UsageError(WHICH_SPACE)
    needs = None if options.domain is None else SPACES[choose_one("domain", options.domain, SPACES)]
    aim, family = (
        choose_one("aim", options.aim, {name: name for name in AIMS}),
        ",".join(families_named(options.family)),
    )
    uses = None if options.needs is None else choose("use", options.needs, {use: use for use in USES})
    shared = {"aim": aim, "family": family, "needs": needs, "most_instructions": options.most_instructions}
    if not 0 <= options.enough <= MOST_ENOUGH:
        raise UsageError(f"--enough {options.enough:g}: out of range; use 0 to {MOST_ENOUGH:g} degrees")
    shared |= {"readers": options.readers, "worth": options.worth, "enough": options.enough}
    shared |= {"accept_holes": options.accept_holes, "accept_lengths": options.accept_lengths}
    shared |= {"look_ups": options.look_ups}
    return shared | {"mixing": ",".join(uses) if uses else None}


def _fitting(codecs: Iterable[Codec]) -> tuple[list[Codec], list[str]]:
    """Return the codecs that fit, and a line for each reason against the others. Raises UsageError if none fits."""
    misfits, fit = [], []
    for codec in codecs:
        if codec.misfit:
            misfits.append((codec.encoding.name, codec.misfit))
        else:
            fit.append(codec)
    reasons = by_reason(dict.fromkeys(misfits))
    if not fit:
        raise UsageError(reasons[0])
    return fit, reasons


def _steps(options: PickOptions, outputs: PickOutputs) -> list[Step]:
    """Return a step for each question, because the measurements of a codec depend on the others."""
    require_jax()
    asked = questions(options)
    device, why = found_device()
    if not device:
        tell(f"no images: {why}")
    for folder in filter(None, (outputs.images, outputs.live)):
        check_folder(folder)
    return [
        Step(
            _key(chosen),
            PickStep(chosen, device, outputs.images),
            _name(chosen),
            sum(not case.is_beside for case in chosen),
        )
        for chosen in asked
    ]


def _name(chosen: Sequence[measure.PickCase]) -> str:
    return f"{asked_of(dict(chosen[0].said))} {chosen[0].normal_set.name}"


def _key(chosen: Sequence[measure.PickCase]) -> Row:
    first = chosen[0]
    key: Row = {"codecs": [case.codec.name for case in chosen], "powers": list(first.powers)}
    key |= {"count": first.normal_set.count, "seed": first.normal_set.seed}
    against = [case.codec.name for case in chosen if case.said["against"]]
    # Runs that knew no other rounding have said nothing of it.
    shared = {name: value for name, value in first.said.items() if (name, value) != ("rounding", "nearest")}
    return key | shared | {"against": against} | ({"survey": True} if first.is_surveyed else {})


def _measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
    first = steps[0].case if steps else PickStep((), None, None)
    return measure.rows([step.case.cases for step in steps], first.device, first.images, tick)


def _sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a sheet for each question: the answer in sentences, and the Pareto-optimal and recommended encodings."""
    for (asked, normals, scene), group in groups(rows).items():
        front = [_short(row) for row in group if row["front"] or row["place"]]
        title = f"{asked}, on {normals}: Pareto-optimal encodings in error, cost and bits"
        lines, aside = tuple(told(group)), tuple(left_out(group))
        keys = {"storage": group[0]["asked"], "rounding": group[0]["rounding"], "normals": normals}
        keys["scene"] = scene.split(",")[0]
        yield Sheet(title if front else "", front, TABLE.drops(front), said=lines, aside=aside, keys=keys)


def _short_sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a short sheet for each question: the answer in sentences, and the alternatives."""
    for group in groups(rows).values():
        # The first sentence has what lies in another storage.
        placed = [_alternative(row) for row in group if row["place"] and row["place"] != ELSEWHERE]
        if len({row["bits"] for row in placed}) == 1:
            # The sentence says it.
            placed = [{name: value for name, value in row.items() if name != "bits"} for row in placed]
        yield Sheet("", placed, (), said=tuple(in_short(group)), notes=tuple(conditions(group)))


def _alternative(row: Row) -> Row:
    """Return the short table's row for an encoding that has a place in the answer, with errors in degrees and the
    worst image in decibels."""
    figures = {"mean (°)": mean(row), "worst (°)": largest_mixed(row), "slots": row["slots"], "bits": row["bits"]}
    worst = min(images(row).values(), default=None)
    return {"encoding": called(row), "place": row["place"]} | figures | {"image (dB)": worst}


def _short(row: Row) -> Row:
    row = row | {"largest_deg": largest(row)}
    return {name: row[name] for pattern in SHOWN for name in row if fnmatchcase(name, pattern)}


def _failures(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a line for each question without an answer; the sentences on the sheet give the reason."""
    for (asked, normals, _), group in groups(rows).items():
        if all(row["left_out"] for row in group):
            yield f"no answer for {asked} on {normals}"


def _write(done: Measured, _: Tick) -> None:
    if done.outputs.live:
        # It imports what writes GLSL ES, which rows alone do not need.
        from ...measures.live.kept import write_live

        eligible = (case for step in done.steps for case in pictures.eligible(step.case.cases, done.rows))
        write_live((case.codec for case in eligible), done.outputs.live)


WORK = Work(
    steps=_steps,
    measure=_measure,
    finish=answered,
    shown=lambda done: _sheets(done.rows) if done.outputs.verbose else _short_sheets(done.rows),
    summary=_sheets,
    failures=_failures,
    write=_write,
    charts=charts,
    extras=extras,
    needs=lambda _: frozenset({COMPILERS, GL}),
    subjects=pictures.subjects,
)
