"""What a worker does: lay down the files of an order, make its steps, and measure those that are wanted."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import tempfile
import traceback
from collections import OrderedDict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from ...ground.machine.lost import require_living_device
from ...ground.output.cache import folder_of_this_process
from ...ground.output.errors import MissingError, UsageError, told
from ...tables.registry import TABLES
from ...tables.table import Row, Step
from ..measuring import Asked, asked_together, with_parts
from .about import About, about
from .orders import PICTURES, Order, check_paths

# Of how many orders a worker keeps the steps, with whatever these hold in memory.
KEPT_ORDERS = 3
TOLD = "normalbench: "


@dataclass(frozen=True)
class StepAnswer:
    """A measured step: its name, its rows, and its pictures by their place."""

    name: str
    rows: list[Row]
    pictures: dict[str, bytes]


@dataclass(frozen=True)
class Answer:
    """What a worker answers.

    Attributes:
        steps: those that were measured.
        knows: whether the worker has the order; else it is to be sent again.
        refused: why the worker measures nothing of the order; empty where it does.
        wrong: a UsageError or MissingError that measuring raised, or the trace of another.
        told: lines for standard error.
    """

    steps: list[StepAnswer] = field(default_factory=list)
    knows: bool = True
    refused: str = ""
    wrong: UsageError | MissingError | str = ""
    told: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Laid:
    """An order on this worker: its folder, what it asks, and its steps by name."""

    order: Order
    folder: Path
    ask: Asked
    steps: dict[str, Step]


_laid: OrderedDict[str, Laid] = OrderedDict()


def probe() -> About:
    """What this worker says of itself."""
    return about()


def measure(order: Order | str, wanted: Sequence[str]) -> Answer:
    """Measure steps of an order; never raises.

    Args:
        order: itself, or the id of one that was sent before.
        wanted: the names of steps.
    """
    try:
        laid = _laid_down(order)
        if laid is None:
            return Answer(knows=False)
    except (UsageError, MissingError) as error:
        return Answer(refused=str(error))
    except Exception:
        return Answer(wrong=traceback.format_exc())
    absent = [name for name in wanted if name not in laid.steps]
    if absent:
        return Answer(refused=f"it makes other steps of the table {laid.order.table} from the same options")
    return _measured(laid, wanted)


def _measured(laid: Laid, wanted: Sequence[str]) -> Answer:
    found: list[StepAnswer] = []
    wrong: UsageError | MissingError | str = ""
    with _in_folder(laid.folder), _listening() as lines:
        try:
            found.extend(_answers(laid, wanted))
        except (UsageError, MissingError) as error:
            wrong = error
        except Exception:
            wrong = traceback.format_exc()
    return Answer(found, wrong=wrong, told=[laid.order.as_typed(line) for line in lines])


def _answers(laid: Laid, wanted: Sequence[str]) -> Iterator[StepAnswer]:
    ask, chosen = laid.ask, [laid.steps[name] for name in wanted]
    rows_of = ask.table.work.measure(chosen, lambda _: None)
    for name, rows in zip(wanted, rows_of, strict=True):
        require_living_device()
        yield StepAnswer(name, laid.order.as_typed(list(rows)), _taken(laid.folder))


def _taken(folder: Path) -> dict[str, bytes]:
    """The pictures that a step wrote; they are there no more."""
    root = folder / PICTURES
    found = {path.relative_to(root).as_posix(): path for path in sorted(root.rglob("*")) if path.is_file()}
    taken = {name: path.read_bytes() for name, path in found.items()}
    for path in found.values():
        path.unlink()
    return taken


def _laid_down(order: Order | str) -> Laid | None:
    """An order with its steps, made once; None for one that is not known here. Raises UsageError and MissingError."""
    key = order if isinstance(order, str) else order.id
    if key in _laid:
        _laid.move_to_end(key)
        return _laid[key]
    if isinstance(order, str):
        return None
    while len(_laid) >= KEPT_ORDERS:
        shutil.rmtree(_laid.popitem(last=False)[1].folder, ignore_errors=True)
    _laid[key] = _made(order)
    return _laid[key]


def _made(order: Order) -> Laid:
    check_paths(order.files)
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
    return Laid(order, folder, ask, {order.name_of(step): step for step in with_parts(ask.steps)})


@contextlib.contextmanager
def _in_folder(folder: Path) -> Iterator[None]:
    """Words of the user's are read as they were typed: in the folder that stands for the user's."""
    before = Path.cwd()
    os.chdir(folder / "typed")
    try:
        yield
    finally:
        os.chdir(before)


@contextlib.contextmanager
def _listening() -> Iterator[list[str]]:
    """The lines that are told meanwhile, for the process that asks to tell."""
    lines: list[str] = []
    told.clear()
    with contextlib.redirect_stderr(io.StringIO()) as said:
        yield lines
    lines += [line.removeprefix(TOLD) for line in said.getvalue().splitlines() if line.startswith(TOLD)]
