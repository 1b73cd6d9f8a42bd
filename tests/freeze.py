"""The rows of every table at small counts, and the code of every pair, as they were when they were written down.

    python -m tests.freeze [--write] [--share N --seed WORD]

compares what is measured now with `freeze.json.gz`, and prints what differs. With --write it keeps what is measured
now. With --share one of N questions is asked, drawn by the seed.

On the processor, driver and packages that the file names, rows are equal to the last bit; elsewhere numbers agree to
1e-6 of what they are, or of 1. Times are left out, costs are the recorded counts, and code is written but not run.
Exit status: 0 where nothing differs.
"""

from __future__ import annotations

import argparse
import gzip
import hashlib
import json
import math
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stderr
from functools import partial
from io import StringIO
from multiprocessing import get_context
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("freeze.json.gz")
NEAR, DIGITS, LINES, PROCESSES = 1e-6, 9, 60, 2
SAME = ("processor", "GL", "GL version", "numpy", "jax", "jaxlib")

NORMALS = {"encoding": "all", "normals": "domain", "count": 1024}
FEW = "octahedral,spheremap,spherical,stereographic,latitude_longitude,xyz"
SMALL = {"size": "64x48", "objects": 20}
DRAWN = SMALL | {"lights": 8}
SPHERE = {"environment": "studio", "object": "sphere", "size": "64x64"}

# A table and its options, by a name. Those that take longest come first.
QUESTIONS: Mapping[str, tuple[str, dict[str, Any]]] = {
    "pick": ("pick", {"storage": "rg8,rgb10a2", "encoding": FEW, "scene": "studio", "power": "47"}),
    "budget": ("budget", {"bytes": "12", "scene": "ramps"}),
    "roughness": ("roughness", {"encoding": FEW, "storage": "rg8,rg16", **SPHERE}),
    **{f"quality {name}": ("quality", NORMALS | {"storage": name}) for name in ("rg8", "rgba8", "rgb10a2", "rg16")},
    "quality halves": ("quality", NORMALS | {"encoding": FEW, "storage": "rg16f,rgba16f,unorm:9:7"}),
    "quality rounded": ("quality", NORMALS | {"encoding": FEW, "storage": "rg8_snorm", "rounding": "all"}),
    "quality worst": ("quality", NORMALS | {"encoding": "octahedral", "storage": "rg8", "worst_case": True}),
    "render": ("render", DRAWN | {"encoding": FEW, "storage": "rgba8", "repeats": 0}),
    "render layouts": ("render", DRAWN | {"layout": "all", "scene": "gloss", "repeats": 0}),
    "mix": ("mix", {"encoding": FEW, "count": 256}),
    "maps": ("maps", {"normals": "bumps"}),
    "roofline": ("roofline", {}),
    "effects": ("effects", SMALL | {"encoding": "octahedral,xyz", "rays": 0}),
    "motion": ("motion", {"encoding": FEW, "count": 512, "size": "64x48", "frames": 4, "turn": "0.25"}),
    "lights": ("lights", {"counts": "8"}),
    "depth": ("depth", {"count": 1024}),
    "frames": ("frames", {"count": 256}),
    "vectors": ("vectors", {"count": 64}),
    "curves": ("curves", {}),
    "sweep": ("sweep", {"size": "64x48", "objects": "20", "repeats": 1}),
    "tune": ("tune", {"encoding": "stereographic", "count": 1024}),
}
# Rows by key, each a column to its value.
Rows = dict[str, dict[str, Any]]


def measured(name: str) -> Rows:
    """Return the rows of a question, less times and what only says how they were measured."""
    import normalbench as nb
    from normalbench.bench.tables.registry import TABLES

    _use_recorded_counts()
    word, options = QUESTIONS[name]
    table = TABLES[word]
    with redirect_stderr(StringIO()):
        rows = getattr(nb, word)(**options).measured[1].rows
    found: Rows = {}
    for row in rows:
        columns = {key: table.column(key) for key in row}
        kept = {key: row[key] for key, column in columns.items() if _is_figure(column)}
        _add(found, f"{name}: {table.name_of(row)}", json.loads(json.dumps(kept, default=_plain)))
    return found


def _is_figure(column: Any) -> bool:
    """Whether a column is neither a time nor a circumstance."""
    from normalbench.reports.sheets import Role

    return column is not None and column.role not in (Role.TIME, Role.HOW) and column.unit != "ms"


def _use_recorded_counts() -> None:
    """Take instructions as they were recorded: another version of a driver counts other ones."""
    from normalbench.bench.tables.cost import measure

    def counted(chosen: Sequence[Any], family: str, stage: str) -> dict[tuple[str, str], Any]:
        rows = [
            case.row("isa", family=family, stage=stage) | row for case, row in measure.recorded(chosen, family, stage)
        ]
        return {(row["encoding"] or row["storage"], row["operation"]): row for row in rows}

    measure.counted = counted


def _plain(value: Any) -> Any:
    return value.item() if hasattr(value, "item") else str(value)


def _add(rows: Rows, key: str, row: dict[str, Any]) -> None:
    """Keys name a row; a second one of the same key has a number."""
    number = 2
    while key in rows:
        key, number = f"{key.removesuffix(f' #{number - 1}')} #{number}", number + 1
    rows[key] = row


def counted(_: str) -> Rows:
    """Return the recorded counts of all operations whose GLSL is what was counted, by family."""
    from normalbench.bench.ground.options.gpu_families import usual_stage
    from normalbench.bench.tables.cost import measure
    from normalbench.bench.tables.pick.measure import SURVEYED

    from .recorded_costs import cases

    chosen = cases()
    found: Rows = {}
    for family in SURVEYED:
        for case, row in measure.recorded(chosen, family, usual_stage(family)):
            found[f"cost: {family} {case.name}"] = row
    return found


def written(question: str) -> Rows:
    """Return the hashes of the code of one sort of thing, in all languages."""
    from normalbench.bench.ground.output.errors import UsageError
    from normalbench.bench.shaders.code.emit import LANGUAGES

    found: Rows = {}
    for name, maker in _writers(question.removeprefix("code ")):
        for language in LANGUAGES:
            try:
                text = maker(language).body
            except UsageError as error:
                text = str(error)
            found[f"{question}: {language} {name}"] = {"hash": hashlib.sha256(text.encode()).hexdigest()[:16]}
    return found


def _writers(of: str) -> Iterator[tuple[str, Callable[[str], Any]]]:
    """By name what writes a code in a language: of normals, of the other kinds, or of layouts."""
    from normalbench.bench.door.code_command import SHIPPED
    from normalbench.bench.shaders.code.files import code_of
    from normalbench.bench.shaders.code.whole.emit import gbuffer_code
    from normalbench.bench.subjects.codecs.kinds.codecs import codecs_of_kind
    from normalbench.bench.subjects.codecs.layout_names import layouts_named
    from normalbench.bench.subjects.codecs.names import codecs_named, fitting
    from normalbench.encodings.kinds import KINDS, NORMAL

    if of == "layouts":
        yield from ((layout.name, partial(gbuffer_code, layout)) for layout in layouts_named(("all",)))
        return
    named = {NORMAL: fitting(codecs_named(("all",), SHIPPED, ("nearest",)))[0]} if of == "normals" else {}
    if of == "others":
        named = {
            kind: codecs_of_kind(kind, ("all",), (), ("nearest",), slice(1)) for kind in KINDS if kind is not NORMAL
        }
    for kind, codecs in named.items():
        yield from ((f"{kind.word} {codec.name}", partial(code_of, codec)) for codec in codecs if not codec.misfit)


OTHERS: Mapping[str, Callable[[str], Rows]] = {
    "cost": counted,
    **dict.fromkeys(("code normals", "code others", "code layouts"), written),
}


def frozen(question: str) -> dict[str, Any]:
    """Return the rows of a question, each with its hash, and with floats of nine digits."""
    rows = OTHERS.get(question, measured)(question)
    return {key: [_hash(row), {column: _rounded(value) for column, value in row.items()}] for key, row in rows.items()}


def _hash(row: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(row, sort_keys=True).encode()).hexdigest()[:12]


def _rounded(value: Any) -> Any:
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) and math.isfinite(value) else value


def facts() -> dict[str, str]:
    """Return what the last bits of a row depend on."""
    from normalbench.bench.ground.machine.systems.system_files import processor_lines
    from normalbench.bench.keep.machine import machine

    known = machine()
    # Processors of one name may have other instructions, which XLA compiles for.
    flags = next((line for line in processor_lines() if line.startswith("flags")), "")
    named = {name: known[name] for name in SAME if name in known}
    return named | {"instructions": hashlib.sha256(flags.encode()).hexdigest()[:12]}


def asked(share: int, seed: str) -> list[str]:
    """Return the questions that are asked: one of `share`, by a seed; at least one."""
    every = [*QUESTIONS, *OTHERS]
    drawn = sorted(every, key=lambda name: hashlib.sha256(f"{seed} {name}".encode()).hexdigest())
    taken = set(drawn[: max(1, -(-len(every) // share))])
    return [name for name in every if name in taken]


def differences(kept: Mapping[str, Any], rows: Mapping[str, Any], is_same: bool) -> Iterator[str]:
    """Return a line for each row that went, came, or has other figures."""
    yield from (f"gone: {key}" for key in kept if key not in rows)
    yield from (f"new: {key}" for key in rows if key not in kept)
    for key in kept.keys() & rows.keys():
        (old_hash, old), (new_hash, new) = kept[key], rows[key]
        if old_hash == new_hash:
            continue
        columns = [column for column in old | new if not _are_near(old.get(column), new.get(column), is_same)]
        if columns:
            first = ", ".join(f"{column} {old.get(column)} -> {new.get(column)}" for column in columns[:4])
            yield f"differs: {key}: {first}{', ...' if len(columns) > 4 else ''}"
        elif is_same:
            yield f"differs: {key}: beyond the ninth digit"


def _are_near(old: Any, new: Any, is_same: bool) -> bool:
    if is_same or not isinstance(old, int | float) or not isinstance(new, int | float):
        return old == new
    return old == new or abs(old - new) <= NEAR * max(1.0, abs(old))


def main() -> int:
    """Return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.freeze", description=__doc__)
    parser.add_argument("--write", action="store_true", help="Keep what is measured now.")
    parser.add_argument("--share", type=int, default=1, help="Ask one of so many questions. Default: all.")
    parser.add_argument("--seed", default="", help="What draws them, such as a commit's hash.")
    parser.add_argument("--only", default="", help="Ask those whose names hold this word.")
    parser.add_argument("--times", action="store_true", help="Say the processor seconds of each question.")
    given = parser.parse_args()
    begin = time.monotonic()
    names = [name for name in asked(given.share, given.seed) if given.only in name]
    rows, seconds = _answered(names)
    kept = json.loads(gzip.decompress(FILE.read_bytes())) if FILE.exists() else {"facts": {}, "rows": {}}
    here = facts()
    is_same = kept["facts"] == here
    before = {key: row for key, row in kept["rows"].items() if key.partition(": ")[0] in names}
    if not (given.share > 1 or given.only):
        before = kept["rows"]
    lines = list(differences(before, rows, is_same))
    print(*lines[:LINES], sep="\n", end="\n" * bool(lines))
    if len(lines) > LINES:
        print(f"and {len(lines) - LINES} more")
    if given.times:
        print(*(f"{second:6.1f} s  {name}" for name, second in seconds.items()), sep="\n")
    how = "to the bit" if is_same else f"to {NEAR:g}, as the machine differs"
    print(f"{len(rows)} rows of {len(names)} questions, compared {how}: {len(lines)} differ; ", end="")
    print(f"{time.monotonic() - begin:.0f} s")
    if given.write:
        _keep(here, {key: row for key, row in kept["rows"].items() if key not in before} | rows)
        return 0
    return int(bool(lines))


def _answered(names: Sequence[str]) -> tuple[dict[str, Any], dict[str, float]]:
    """The rows of all questions, and the processor seconds of each."""
    rows: dict[str, Any] = {}
    seconds: dict[str, float] = {}
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        for name, (found, took) in zip(names, pool.map(_timed, names), strict=True):
            rows |= found
            seconds[name] = took
    return rows, seconds


def _timed(name: str) -> tuple[dict[str, Any], float]:
    begin = time.process_time()
    try:
        return frozen(name), time.process_time() - begin
    except Exception as error:
        raise RuntimeError(f"{name}: {error}") from error


def _keep(here: Mapping[str, str], rows: Mapping[str, Any]) -> None:
    text = json.dumps({"facts": here, "rows": dict(sorted(rows.items()))}, separators=(",", ":"))
    FILE.write_bytes(gzip.compress(text.encode(), mtime=0))
    print(f"{FILE.name}: {len(rows)} rows, {FILE.stat().st_size} bytes")


if __name__ == "__main__":
    sys.exit(main())
