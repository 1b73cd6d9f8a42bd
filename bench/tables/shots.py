"""Steps that draw a frame each: a row of figures, and pictures of it where somebody asks for them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..ground.machine.memory import give_back_what_is_freed
from .table import Row, Step, Tick


@dataclass(frozen=True)
class Shot:
    """A case, what measures it, and the folder for its pictures, if any.

    Attributes:
        bench: has `measure`, from a case to its row and what was drawn (None where nothing was), and `reference`.
        case: what is measured.
        images: the folder.
    """

    bench: Any
    case: Any
    images: Path | None


def by_shots(write: Callable[[Path, Row, Any, Any], None]) -> Callable[[Sequence[Step], Tick], Iterator[list[Row]]]:
    """A Work's `measure` for steps whose cases are shots.

    Args:
        write: the pictures: from the folder, the row, what was drawn and its reference.
    """

    def measure(steps: Sequence[Step], tick: Tick) -> Iterator[list[Row]]:
        writing: Future[list[Row]] | None = None
        # The pictures of one step are written while the next is rendered, which leaves much of a core idle.
        with ThreadPoolExecutor(1) as pool:
            for step in steps:
                shot: Shot = step.case
                row, drawn = shot.bench.measure(shot.case)
                pictures = (drawn, shot.bench.reference(shot.case)) if shot.images and drawn else None
                if writing:
                    yield writing.result()
                writing = pool.submit(written, shot.images, row, pictures)
                del drawn, pictures
                give_back_what_is_freed()
                tick(step.name)
            if writing:
                yield writing.result()

    def written(images: Path | None, row: Row, pictures: tuple[Any, Any] | None) -> list[Row]:
        if images and pictures:
            write(images, row, *pictures)
        return [row]

    return measure


def name_of_file(effects: str) -> str:
    """Names of effects as a part of a file's name."""
    return re.sub(r"[^\w.]+", "_", effects)
