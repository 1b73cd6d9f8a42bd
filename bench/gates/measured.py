"""Rows as a gate or a test asks for them: a table, and its options by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

from ..metrics.images import require_flip
from ..metrics.meter import Worst
from ..options.option import MEASURED, Reading, checked_options, fields_of
from ..results.runs import Row
from ..tables.quality import measure as quality
from ..tables.quality.command import Request
from ..tables.quality.measure import require_device
from ..tables.render.command import RenderRequest
from ..tables.render.measure import Bench, ranked
from .limits import Limit


@dataclass(frozen=True)
class Found:
    """A row, and how to find the normal that came back farthest off, which takes a second look."""

    row: Row
    find: Callable[[], Worst | None]

    @cached_property
    def worst(self) -> Worst | None:
        """That normal; None where there is none."""
        return self.find()


def measured(table: str, values: Mapping[str, Any], usual: Mapping[str, Any] | None = None) -> list[Found]:
    """The rows of a table with these options, and with what is usual where they say nothing.

    Args:
        table: one of options.MEASURED.
        usual: in place of what is usual for a gate: octahedral/rgba8 by JAX, or in an exact G-buffer.

    Raises:
        UsageError: an option or a value that there is not.
        MissingError: this machine lacks what they need.
    """
    return TABLES[table]({**checked_options(table, usual or {}), **checked_options(table, values)})


def with_their_options(table: str, values: Mapping[str, Any], limits: Iterable[Limit]) -> dict[str, Any]:
    """The options, and those without which a limited column is not measured: `flip`, `worst_case`, `codes`."""
    limited = {limit.column for limit in limits}
    known = fields_of(*MEASURED[table])
    asked = {name for name, field in known.items() if field.kind is bool and limited & {name, *field.option.columns}}
    return dict(values) | dict.fromkeys(asked, True)


def _quality(options: Mapping[str, Any]) -> list[Found]:
    chosen = {"encoding": "octahedral", "backend": "jax", **options}
    reading = Reading(**{name: chosen.pop(name) for name in fields_of(Reading) if name in chosen})
    cases = Request(**chosen, reading=reading).cases()
    return [Found(quality.measure(case), partial(quality.worst, case)) for case in cases]


def _render(options: Mapping[str, Any]) -> list[Found]:
    # A layout without a codec is measured as it is.
    usual: dict[str, Any] = {} if "layout" in options else {"encoding": "octahedral"}
    request = RenderRequest(**usual | dict(options))
    gl = require_device()
    if request.flip:
        require_flip()
    bench = Bench(gl, 0, request.flip)
    cases = request.cases(gl)
    rows = ranked([bench.measure(case)[0] for case in cases])
    return [Found(row, partial(bench.worst, case)) for row, case in zip(rows, cases, strict=True)]


TABLES: Mapping[str, Callable[[Mapping[str, Any]], list[Found]]] = {"quality": _quality, "render": _render}
