"""The work of a worker: write the files of an order, make its steps, and measure the wanted steps."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace
from pathlib import Path

from ...ground.output.cache import folder_of_this_process
from ...ground.output.errors import MissingError, UsageError, told
from ...tables.registry import TABLES
from ...tables.table import Row, Step
from ..measuring import HERE, Asked, asked_together, with_parts
from .about import marks, named
from .carrier import Answer
from .orders import PICTURES, Order, step_name

# Of how many orders a worker keeps the steps, with whatever these hold in memory.
KEPT_ORDERS = 3
TOLD = "normalbench: "


@dataclass(frozen=True)
class Laid:
    """An order on this worker: its folder, its request and its steps by name."""

    order: Order
    folder: Path
    ask: Asked
    steps: dict[str, Step]


_laid: dict[str, Laid] = {}


def measure(order: Order | str, needs: Set[str], wanted: Sequence[str]) -> Answer:
    """Measure steps of an order, and return the answer. The answer also reports if this worker refuses the steps,
    does not know the order, or meets a UsageError or a MissingError.

    Args:
        order: the order, or the id of an order that was sent before.
        needs: the marks that this worker must have.
        wanted: the names of steps, as from `step_name`.
    """
    if absent := needs - set(marks().values()):
        return Answer(refused=f"no worker has the same {named(absent)}")
    try:
        laid = _laid_down(order)
    except (UsageError, MissingError) as error:
        return Answer(refused=f"workers refuse these steps: {error}")
    if laid is None:
        return Answer(knows=False)
    if not laid.steps.keys() >= set(wanted):
        return Answer(refused="workers derive different steps from the same options")
    steps: list[tuple[list[Row], dict[str, bytes]]] = []
    error = None
    with _in_folder(laid.folder), _listening() as lines:
        try:
            for answer in _answers(laid, wanted):
                steps.append(answer)
        except (UsageError, MissingError) as raised:
            error = raised
    return Answer(steps, [laid.order.as_typed(line) for line in lines], error=error)


def _answers(laid: Laid, wanted: Sequence[str]) -> Iterator[tuple[list[Row], dict[str, bytes]]]:
    """Measure steps, and yield for each step its rows and its pictures by path."""
    for _, rows in HERE.measure(laid.ask, [laid.steps[name] for name in wanted], lambda _: None):
        yield rows, _taken(laid.folder)


def _taken(folder: Path) -> dict[str, bytes]:
    """Return the pictures that a step wrote, by path relative to the folder of pictures, and delete their files."""
    root = folder / PICTURES
    paths = {path.relative_to(root).as_posix(): path for path in sorted(root.rglob("*")) if path.is_file()}
    taken = {name: path.read_bytes() for name, path in paths.items()}
    for path in paths.values():
        path.unlink()
    return taken


def _laid_down(order: Order | str) -> Laid | None:
    """Return an order with its files written and its steps made, which happens only once per order; None for an
    unknown id. Raises UsageError and MissingError."""
    if isinstance(order, str):
        return _laid.get(order)
    if order.id not in _laid:
        laid = _laid_of(order)
        while len(_laid) >= KEPT_ORDERS:
            shutil.rmtree(_laid.pop(next(iter(_laid))).folder, ignore_errors=True)
        _laid[order.id] = laid
    return _laid[order.id]


def _laid_of(order: Order) -> Laid:
    """Write an order's files into a new folder, make its steps there, and return them by name."""
    folder = Path(tempfile.mkdtemp(prefix="order-", dir=folder_of_this_process())).resolve()
    typed = folder / "typed"
    typed.mkdir()
    for name, data in order.files.items():
        path = typed / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    table = TABLES[order.table]
    outputs = replace(table.outputs(), **({PICTURES: folder / PICTURES} if order.pictures else {}))
    # The process that asks has said what is left out.
    with _in_folder(folder), _listening():
        ask = asked_together(table, [table.options(**values) for values in order.options], outputs)
    return Laid(order, folder, ask, {step_name(order.table, step.key): step for step in with_parts(ask.steps)})


@contextlib.contextmanager
def _in_folder(folder: Path) -> Iterator[None]:
    """Run a block in the folder that stands for the user's current folder, so that typed words mean the same."""
    before = Path.cwd()
    os.chdir(folder / "typed")
    try:
        yield
    finally:
        os.chdir(before)


@contextlib.contextmanager
def _listening() -> Iterator[list[str]]:
    """Yield a list that, after the block, contains the messages told in it; nothing is printed."""
    lines: list[str] = []
    told.clear()
    with contextlib.redirect_stderr(io.StringIO()) as printed:
        yield lines
    lines += [line.removeprefix(TOLD) for line in printed.getvalue().splitlines() if line.startswith(TOLD)]
