"""Whether a codec can be filtered, blended or resolved, judged from a few thousand mixes without the mix table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from operator import attrgetter
from pathlib import Path
from statistics import fmean

from ....encodings.codecs.codec import Codec
from ...measures.recorded import Recorded
from ...shaders.code.twin import has_twin
from ...subjects.normals.normal_sets import NORMAL_SETS, NormalSet
from .measure import MixCase, measure
from .model import BY_MODEL
from .patches import Mixes, mixes_of, patches_of
from .table import COUNT, OF_INTEGER, USES
from .verdict import Row, decides, decides_across, summed_up, worst_fault

# All around, and about the six axes, where seams lie.
AXES = "axes"
SETS, ANGLES = ("sphere", AXES), (1.0, 5.0)
SAMPLES, POWER = 4, 1.0


EDGE = 60.0
# What uses do to the catalogue's codecs, over the usual mixes. `python -m tests.recorded` writes it.
RECORDED = Recorded(
    Path(__file__).with_name("uses.json"),
    [
        f"bench/tables/mix/{name}.py"
        for name in ("judge", "measure", "model", "means", "figures", "reference", "patches")
    ]
    + [f"bench/tables/mix/{name}.py" for name in ("programs", "table", "verdict")],
)
_INSIDE, _ACROSS = attrgetter("inside"), attrgetter("across")


@cache
def _usual_mixes(seed: int) -> tuple[Mixes, ...]:
    chosen = (NORMAL_SETS[name](COUNT, seed) for name in SETS)
    all_patches = (patches for normals in chosen for patches in patches_of(normals, ANGLES, COUNT, seed, (EDGE,)))
    return tuple(mixes_of(patches, SAMPLES) for patches in all_patches)


def _mixes_of_set(normals: NormalSet) -> tuple[Mixes, ...]:
    """Return the mixes of neighbouring pixels if the set is an image, otherwise the usual mixes with its seed."""
    if not normals.shape:
        return _usual_mixes(normals.seed)
    return tuple(mixes_of(patches, SAMPLES) for patches in patches_of(normals, ANGLES, COUNT, normals.seed))


@dataclass(frozen=True)
class Judgement:
    """The effect of mixing on a codec.

    Attributes:
        inside, across: reasons why the codec cannot be used inside a surface and across an edge, by use; empty if it
            can.
        mean_deg, max_deg: mean over all operations and distances, and maximum, of the errors of mixes inside a
            surface; None if nothing was measured.
        count: number of errors in the mean.
    """

    inside: dict[str, str]
    across: dict[str, str]
    mean_deg: float | None
    max_deg: float | None
    count: int


def judgement(codec: Codec, uses: Sequence[str], normals: NormalSet, domain: str) -> Judgement:
    """Return the combined effect of several uses on a codec; the arguments are those of `judgements`."""
    parts = judgements(codec, uses, normals, domain).values()
    count = sum(part.count for part in parts)
    inside, across = ({use: why for part in parts for use, why in of(part).items()} for of in (_INSIDE, _ACROSS))
    return Judgement(
        inside,
        across,
        sum((part.mean_deg or 0.0) * part.count for part in parts) / count if count else None,
        max((part.max_deg for part in parts if part.max_deg is not None), default=None),
        count,
    )


def judgements(codec: Codec, uses: Sequence[str], normals: NormalSet, domain: str) -> dict[str, Judgement]:
    """Return the effect of each use on a codec, from recorded results if possible.

    Args:
        uses: keys of table.USES.
        normals: an image whose neighbouring pixels are mixed; for any other set only the seed matters.
        domain: domain of the normals that are mixed: "sphere", "hemisphere" or "view".

    A codec without a twin in JAX is measured in GLSL; a codec that cannot be measured has no faults.
    """
    is_usual = not normals.shape and not normals.seed and domain == codec.encoding.domain
    if is_usual and (known := RECORDED.find(codec.name, codec)):
        return {use: Judgement(**known["uses"][use]) for use in uses}
    return judged_now(codec, uses, normals, domain)


def judged_now(codec: Codec, uses: Sequence[str], normals: NormalSet, domain: str) -> dict[str, Judgement]:
    """Return what `judgements` returns, always measured and never from recorded results."""
    rows = _measured_rows(codec, uses, normals, domain)
    return {use: _judged(codec, [use], [row for row in rows if row["operation"] in USES[use]]) for use in uses}


def _measured_rows(codec: Codec, uses: Sequence[str], normals: NormalSet, domain: str) -> list[Row]:
    operations = tuple(operation for use in uses for operation in USES[use])
    backend = "jax" if has_twin(codec.encoding) else "glsl"
    cases = (MixCase(codec, mixes, backend, operations, POWER, domain) for mixes in _mixes_of_set(normals))
    return [row for case in cases for row in measure(case)]


def _judged(codec: Codec, uses: Sequence[str], rows: Sequence[Row]) -> Judgement:
    inside, across = ([row for row in rows if is_decisive(row)] for is_decisive in (decides, decides_across))
    # Seams lie about the axes: a mean over these is not that of a surface.
    means = [row["angle_mean_deg"] for row in inside if row["normals"] != AXES]
    largest = max((row["angle_max_deg"] for row in inside), default=None)
    integer = dict.fromkeys((use for use in uses if _is_of_codes(use)), OF_INTEGER) if codec.is_integer else {}
    mean, faults = fmean(means) if means else None, _faults_by_use(inside, uses) | integer
    return Judgement(faults, _faults_by_use(across, uses), mean, largest, len(means))


def _is_of_codes(use: str) -> bool:
    """Whether a use mixes stored codes instead of decoded normals."""
    return any(operation in BY_MODEL for operation in USES[use])


def _faults_by_use(rows: Sequence[Row], uses: Sequence[str]) -> dict[str, str]:
    faults = {use: worst_fault([row for row in rows if row["operation"] in USES[use]]) for use in uses}
    return {use: summed_up(row) for use, row in faults.items() if row}
