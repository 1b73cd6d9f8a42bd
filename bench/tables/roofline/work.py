"""Computation and display of the roofline table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from ...ground.options.counts import checked_numbers, checked_sides
from ...ground.options.targets import that_fit
from ...ground.output.errors import UsageError
from ...shaders.isa import spirv
from ...subjects.codecs.names import codecs_named
from ..table import COMPILERS, Measured, Row, Sheet, Step, Work, each
from . import measure
from .answers import answers
from .charts import charts
from .measure import Frame, RooflineCase
from .rates import RANGES, gpus_named
from .table import TABLE, RooflineOptions, RooflineOutputs

MOST_SIDE, MOST_READS = 32768, 1024
# Of more codes nobody reads every pair.
MOST_PAIRS = 6


def cases(options: RooflineOptions) -> list[RooflineCase]:
    """Return a case for each GPU. Raises UsageError for an unknown name or a value out of range."""
    if not 0.01 <= options.overdraw <= 1000:
        raise UsageError(f"--overdraw {options.overdraw}: out of range; use 0.01 to 1000")
    if not 0 <= options.cache_share <= 1:
        raise UsageError(f"--cache-share {options.cache_share}: out of range; use 0 to 1")
    sizes = [checked_sides(word, MOST_SIDE, "here") for word in map(str, options.size)]
    reads = checked_numbers("--reads", options.reads, int, 1, MOST_READS)
    gpus = gpus_named(options.gpu)
    codecs = that_fit(codecs_named(options.encoding, options.storage, ("nearest",)))
    frames = [Frame(size, count, options.overdraw, options.cache_share) for size in sizes for count in reads]
    return [RooflineCase(codecs, name, rates, frames, options.shared) for name, rates in gpus.items()]


def _steps(options: RooflineOptions, _: RooflineOutputs) -> list[Step]:
    return [Step(_key(case), case, case.gpu) for case in cases(options)]


def _key(case: RooflineCase) -> Row:
    about = {"gpu": case.gpu, "shared": case.is_shared}
    about |= {name: getattr(case.rates, name) for name in ("family", *RANGES)}
    frames = [[*frame.size, frame.reads, frame.overdraw, frame.cache_share] for frame in case.frames]
    return {**about, "codecs": [codec.name for codec in case.codecs], "frames": frames}


def _shown(done: Measured) -> Iterator[Sheet]:
    yield from _sheets(done.rows)
    notes = [line for step in done.steps for line in _duels(step.case)]
    if notes:
        yield Sheet("", (), notes=tuple(notes))


def _sheets(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a sheet for each GPU and size at the fewest reads, the fastest codec first; answers are on the first."""
    hidden = ["encoding", "storage", "gpu", "size", "shared", "overdraw", "ridge", "family", "driver", "skipped"]
    known = [row for row in rows if row["frame_us"] is not None]
    sentences = answers(rows)
    for gpu, size in dict.fromkeys((row["gpu"], row["size"]) for row in known):
        part = [row for row in known if (row["gpu"], row["size"]) == (gpu, size)]
        ridges = {row["in_cache"]: row["ridge"] for row in part}
        places = (("memory", False), ("the cache", True))
        takes = [f"a byte from {w} takes as long as {ridges[c]:.3g} instructions" for w, c in places if c in ridges]
        about = ", ".join([*takes, part[0]["driver"]])
        unseen = hidden if True in ridges else [*hidden, "in_cache"]
        lines = [
            {"code": f"{row['encoding']} {row['storage']}"} | {name: row[name] for name in row if name not in unseen}
            for row in part
        ]
        yield Sheet(f"{gpu}, {size}: {about}", lines, TABLE.drops(lines), said=sentences)
        sentences = ()


def _duels(case: RooflineCase) -> Iterator[str]:
    """Yield lines on the numbers of reads and the sizes at which the smaller of two codecs is faster, for each pair
    of different bytes. If there are many pairs, pairs in which the smaller codec is always faster are only
    counted."""
    works = {f"{codec.encoding.name} {codec.storage.name}": case.work(codec) for codec in case.codecs}
    known = sorted(((name, work) for name, work in works.items() if work), key=lambda entry: entry[1].bytes)
    pairs = [pair for pair in combinations(known, 2) if pair[0][1].bytes < pair[1][1].bytes]
    duels = {(small[0], large[0]): _by_size(case, small[1], large[1]) for small, large in pairs}
    few = (
        duels if len(duels) <= MOST_PAIRS else {pair: sizes for pair, sizes in duels.items() if [*sizes] != ["always"]}
    )
    if len(few) < len(duels):
        yield f"{case.gpu}: the smaller encoding is always faster in {len(duels) - len(few)} of {len(duels)} pairs"
    for (small, large), sizes in list(few.items())[:MOST_PAIRS]:
        answers = (_said(answer, answer_sizes if len(sizes) > 1 else []) for answer, answer_sizes in sizes.items())
        yield f"{case.gpu}: {small} is faster than {large}: {'; '.join(answers)}"
    if len(few) > MOST_PAIRS:
        yield f"{case.gpu}: {len(few) - MOST_PAIRS} more pairs; name fewer encodings to see them"


def _by_size(case: RooflineCase, candidate: measure.Work, other: measure.Work) -> dict[str, list[str]]:
    """Return the sizes, such as 1920x1080, grouped by the answer of `from_reads`."""
    groups: dict[str, list[str]] = {}
    for size, frame in {frame.size: frame for frame in case.frames}.items():
        answer = measure.from_reads(candidate, other, case.rates, frame)
        groups.setdefault(answer, []).append("x".join(map(str, size)))
    return groups


def _said(answer: str, sizes: Sequence[str]) -> str:
    reads = "" if answer in ("always", "never", "equal") else " reads of the G-buffer"
    return answer + reads + (f" at {', '.join(sizes)}" if sizes else "")


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a sheet for each number of reads, with a row for each codec and a column for each GPU and size."""
    known = [row for row in rows if row["frame_us"] is not None]
    sentences = answers(rows)
    for reads in dict.fromkeys(row["reads"] for row in known):
        part = [row for row in known if row["reads"] == reads]
        lines: dict[str, Row] = {}
        for row in sorted(part, key=lambda row: row["bits"]):
            code = f"{row['encoding']} {row['storage']}"
            line = lines.setdefault(code, {"code": code, "bits": row["bits"]})
            line[f"{row['gpu']} {row['size']}"] = row["frame_us"]
        times = "1 read" if reads == 1 else f"{reads} reads"
        title = f"microseconds per frame, with {times} of the G-buffer"
        yield Sheet(title, list(lines.values()), said=sentences)
        sentences = ()


def _lacking(done: Measured) -> list[str]:
    return list(dict.fromkeys(row["skipped"] for row in done.rows if row["skipped"]))


def _missing() -> str:
    return spirv.NO_COMPILER if spirv.version(spirv.COMPILER) is None else ""


WORK = Work(
    steps=_steps,
    measure=each(lambda case: list(case.rows())),
    finish=measure.ranked,
    shown=_shown,
    summary=_summary,
    charts=charts,
    lacking=_lacking,
    missing=_missing,
    needs=lambda _: frozenset({COMPILERS}),
)
