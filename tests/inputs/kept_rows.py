"""Rows that were measured once, for all tests, their processes and the next run.

A step's rows follow from its key, from the sources that its table imports, and from the machine: these are the key of
the file that keeps them. Steps that read a clock, and tables that leave more behind than rows, are measured each time.
"""

import ast
import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from importlib.metadata import distributions
from pathlib import Path

from normalbench.bench.ground.machine.devices import found_device, processor_kind
from normalbench.bench.ground.output.cache import key_of
from normalbench.bench.keep.plain import key_text, plain
from normalbench.bench.run.measuring import Asked
from normalbench.bench.tables.table import Row, Step, Tick

ROOT = Path(__file__).parents[2]
ROOMS = ("encodings", "gbuffer", "bench", "reports")
# The catalogue names its modules in strings, and shaders are named in strings everywhere: these count for every table.
ALWAYS = [
    path
    for room in ROOMS
    for path in sorted((ROOT / room).rglob("*"))
    if path.is_file() and (room == "encodings" or path.suffix != ".py") and "__pycache__" not in path.parts
]
Measure = Callable[..., Iterator[tuple[Step, list[Row]]]]


@cache
def imported(path: Path) -> set[Path]:
    """The files of the project that a file imports, wherever in it; a package stands for its `__init__.py`."""
    files = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            names = [base, *(base / alias.name for alias in node.names)]
            files |= {file for name in names for file in (name.with_suffix(".py"), name / "__init__.py")}
    return {file for file in files if file.is_file()}


def reached(first: Path) -> set[Path]:
    """All files that a file imports, directly or not, and the file itself."""
    files, waiting = set(), [first]
    while waiting:
        if (path := waiting.pop()) not in files:
            files.add(path)
            waiting += imported(path)
    return files


@cache
def fingerprint(package: str) -> str:
    """What the rows of a table's package follow from, besides the step."""
    folder = ROOT.joinpath(*package.split(".")[1:])
    digest = hashlib.sha256("\n".join(_machine()).encode())
    for path in [*ALWAYS, *sorted(set().union(*map(reached, folder.glob("*.py"))) - set(ALWAYS))]:
        digest.update(str(path.relative_to(ROOT)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


@cache
def _machine() -> list[str]:
    device, missing = found_device()
    gl = f"{device.renderer}, {device.version}" if device else missing
    settings = [
        f"{name}={os.environ[name]}" for name in sorted(os.environ) if name.startswith(("JAX_", "XLA_", "MESA"))
    ]
    packages = {f"{each.name} {each.version}" for each in distributions()}
    return [*sorted(packages), *processor_kind(), gl, *settings]


def kept(measure: Measure, folder: Path) -> Measure:
    """`Here.measure`, which takes what is asked, the steps and a function that is called for each part that is done."""

    def kept_measure(place: object, ask: Asked, steps: Sequence[Step], tick: Tick) -> Iterator[tuple[Step, list[Row]]]:
        table = ask.table
        if table.work.stays:
            yield from measure(place, ask, steps, tick)
            return
        known = {id(step): _read(folder / _key(ask, step)) for step in steps if not table.work.is_timed(step)}
        missing = [step for step in steps if known.get(id(step)) is None]
        measured = iter(measure(place, ask, missing, tick))
        for step in steps:
            rows = known.get(id(step))
            if rows is None:
                rows = next(measured)[1]
                if id(step) in known:
                    _write(folder / _key(ask, step), rows)
            yield step, rows

    return kept_measure


def _key(ask: Asked, step: Step) -> str:
    return key_of(key_text(ask.table.name, step.key), fingerprint(ask.table.package))


def _read(path: Path) -> list[Row] | None:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def _write(path: Path, rows: Sequence[Row]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    # Processes may write the same at once.
    with tempfile.NamedTemporaryFile("w", dir=path.parent, encoding="utf-8", delete=False) as file:
        json.dump(plain(rows), file)
    Path(file.name).replace(path)
