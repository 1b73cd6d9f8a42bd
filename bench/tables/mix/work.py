"""Measurement and display of the mix table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ...ground.choose import choose
from ...ground.machine.devices import found_device, require_device, require_jax
from ...ground.options.counts import check_seed, checked_numbers, in_range
from ...ground.output.errors import UsageError, leave_out
from ...subjects.codecs.names import check_twin, codecs_named, fitting
from ...subjects.names.backends import backends_named
from ...subjects.normals.normal_names import check_rays, normal_sets_named
from ..charts import one_backend
from ..table import Measured, Row, Sheet, Step, Work, each
from ..verdicts import codec_name, codecs, listed
from . import measure
from .charts import charts
from .measure import MixCase
from .patches import Patches, mixes_of, patches_of
from .table import ACROSS, MOST_COUNT, MOST_JUDGED_DEG, OPERATIONS, TABLE, MixOptions, MixOutputs
from .verdict import judged, lines, worst_of_each

# Two neighbours further apart than this lie on no surface that a filter is for.
MOST_ANGLE, MOST_SAMPLES, MOST_POWER = 60.0, 64, 65536
# Two sides of an edge face away from each other at most so far.
MOST_EDGE = 170.0
NEAREST = "nearest"
SUMMARY_DROPS = ("why", "storage", "alone_max_deg")


def cases(options: MixOptions) -> list[MixCase]:
    """Return one case for each codec, set of patches (by normals, and by angle between neighbours or edge) and backend.

    Raises:
        UsageError: unknown names, numbers out of range, a file that cannot be read, or no codec that fits.
        MissingError: only GLSL is requested and there is no OpenGL device.
    """
    in_range("--count", options.count, 1, MOST_COUNT)
    in_range("--samples", options.samples, 2, MOST_SAMPLES)
    check_seed(options.seed)
    if not 1 <= options.power <= MOST_POWER:
        raise UsageError(f"--power {options.power:g}: out of range; use 1 to {MOST_POWER}")
    angles = checked_numbers("--angle", options.angle, float, 0.01, MOST_ANGLE)
    edges = () if options.edge == ("none",) else checked_numbers("--edge", options.edge, float, 1, MOST_EDGE)
    operations = tuple(choose("operation", options.operation, {name: name for name in OPERATIONS}))
    backends = backends_named(options.backend, measure.BACKENDS)
    codecs = _codecs(options)
    sets = _patches(options, (angles, edges), any(codec.encoding.domain == "view" for codec in codecs))
    samples = _samples(options.samples, backends)
    mixes = [{given: mixes_of(patches, given) for given in set(samples.values())} for patches in sets]
    return [
        MixCase(codec, by_samples[samples[name]], name, operations, options.power, worst_case=options.worst_case)
        for codec in codecs
        for by_samples in mixes
        for name in backends
    ]


def _codecs(options: MixOptions) -> list[Codec]:
    codecs, left_out = fitting(codecs_named(options.encoding, options.storage, (NEAREST,)))
    require_jax()
    if options.backend == ("glsl",):
        require_device()
    for encoding in dict.fromkeys(codec.encoding for codec in codecs):
        check_twin(encoding)
    for line in left_out:
        leave_out(line)
    return codecs


def _patches(
    options: MixOptions, apart: tuple[tuple[float, ...], tuple[float, ...]], needs_rays: bool
) -> list[Patches]:
    angles, edges = apart
    all_patches: list[Patches] = []
    sets = normal_sets_named(options.normals, options.count, options.seed, options.reading, needs_rays)
    check_rays(sets, needs_rays)
    for normals in sets:
        patches = list(patches_of(normals, angles, options.count, options.seed, edges))
        if not patches:
            raise UsageError(
                f"--normals {normals.name}: no square of 4 x 4 pixels is covered; use an image with larger surfaces"
            )
        all_patches += patches
    return all_patches


def _samples(asked: int, backends: Sequence[str]) -> dict[str, int]:
    """Return the samples per pixel by backend: the device may provide more samples than requested."""
    gl, _ = found_device()
    return {name: gl.given_samples(asked) if gl and name == "glsl" else asked for name in backends}


def _steps(options: MixOptions, _: MixOutputs) -> list[Step]:
    return [Step(_key(case), case, case.name) for case in cases(options)]


def _key(case: MixCase) -> Row:
    patches = case.mixes.patches
    key: Row = {"codec": case.codec.name, "normals": patches.name, "angle": patches.angle_deg, "backend": case.backend}
    key |= {"edge": patches.edge_deg}
    key |= {"operations": list(case.operations), "samples": case.mixes.samples, "power": case.power}
    return key | {"count": patches.count, "seed": patches.seed, "worst_case": case.worst_case}


def in_order(rows: Sequence[Row]) -> list[Row]:
    """Return the rows by set, angle, edge and operation, then by share of garbage in ascending order, each with its
    codec's verdicts."""
    groups = list(dict.fromkeys(_group(row) for row in rows))

    def place(row: Row) -> tuple[Any, ...]:
        is_skipped = row["angle_max_deg"] is None
        figures = (0.0, 0.0) if is_skipped else (row["garbage_percent"], row["angle_max_deg"])
        return groups.index(_group(row)), is_skipped, *figures

    return sorted(judged(rows), key=place)


def _group(row: Row) -> tuple[Any, ...]:
    return row["normals"], row["angle_deg"], row["edge_deg"], row["operation"]


def _shown(done: Measured) -> Iterator[Sheet]:
    """Yield the sheets of verdicts, of the worst figures for each operation by one backend, and of how the device
    mixes; files contain every row."""
    yield from _summary(done.rows)
    shown = ("encoding", "storage", "backend", "operation", "normals", "angle_deg", "edge_deg", "alone_max_deg")
    shown += ("angle_mean_deg", "angle_max_deg", "angle_worst_deg", "garbage_percent", "garbage_error_percent")
    shown += ("power_error_percent", "power_decoded_percent")
    inside = [row for row in one_backend(done.rows) if not row["edge_deg"]]
    across = [row for row in one_backend(done.rows) if row["edge_deg"]]
    for title, rows in (("inside a surface, over all sets and angles", inside), ("across an edge", across)):
        if worst := [{name: row[name] for name in shown} for row in worst_of_each(rows)]:
            yield Sheet(f"The worst {title}, by operation", worst, TABLE.drops(worst))
    if ways := _ways(done.rows):
        yield Sheet("How the device mixes, and its lowest agreement with the model", ways)


def _ways(rows: Sequence[Row]) -> list[Row]:
    """Return a row for each storage, operation and device arithmetic, with the lowest agreement with the model."""
    agreed: dict[tuple[str, ...], float] = {}
    for row in rows:
        if row["mixed_by"] and row["agree_percent"] is not None:
            key = row["storage"], row["operation"], row["mixed_by"]
            agreed[key] = min(agreed.get(key, 100.0), row["agree_percent"])
    names = ("storage", "operation", "mixed_by")
    return [dict(zip(names, key, strict=True)) | {"agree_percent": least} for key, least in agreed.items()]


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence on the encodings that survive each use with every backend."""
    verdict_lines = list(lines(rows))
    uses = {"filtering": "filterable", "blending": "blendable", "MSAA resolve": "resolvable"}
    uses["filtering across an edge"] = f"filterable{ACROSS}"
    by_codecs: dict[str, list[str]] = {}
    for use, column in uses.items():
        if any(line[column] is not None for line in verdict_lines):
            by_codecs.setdefault(_surviving(verdict_lines, column), []).append(use)
    if by_codecs:
        yield (
            "Encodings that survive (inside a surface unless stated): "
            + "; ".join(f"{listed(survived)}: {names}" for names, survived in by_codecs.items())
            + "."
        )


def _surviving(rows: Sequence[Row], column: str) -> str:
    """Return one text that names the encodings whose verdict is "yes" with every backend, or "none of them"."""
    failing = {codec_name(line) for line in rows if line[column] != "yes"}
    surviving = {codec_name(line): line for line in rows if codec_name(line) not in failing}
    halves = [line["encoding"] for line in surviving.values() if _is_of_half(line["encoding"])]
    of_half = f" ({listed(halves)} only for z >= 0)" if halves else ""
    return codecs(list(surviving.values()), listed) + of_half if surviving else "none of them"


def _is_of_half(name: str) -> bool:
    """Whether this is the name of an encoding in the catalogue that represents only a hemisphere."""
    return name in ENCODINGS and ENCODINGS[name].domain == "hemisphere"


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    verdict_lines = list(lines(rows))
    if verdict_lines:
        notes = tuple(
            f"{line['encoding']}/{line['storage']}: {line['why']}" for line in one_backend(verdict_lines) if line["why"]
        )
        shown = [{name: value for name, value in line.items() if name != "why"} for line in verdict_lines]
        title = f"What each codec can be used for: inside a surface, with neighbours up to {MOST_JUDGED_DEG:g} degrees "
        title += "apart or an image's own; and filtered across an edge"
        yield Sheet(title, shown, SUMMARY_DROPS, notes=notes)


WORK = Work(
    steps=_steps,
    measure=each(measure.measure),
    finish=in_order,
    shown=_shown,
    verdict=_verdict,
    summary=_summary,
    charts=charts,
)
