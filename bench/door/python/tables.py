"""Tables as functions: the options of a table's command in, a pandas DataFrame out."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np
import pandas as pd

from ....encodings.codecs.encoding import Encoding
from ....encodings.storages.storage import Storage
from ....reports.charts.drawings import of
from ...ground.options.option import checked_options, fields_of
from ...ground.options.words import Given
from ...ground.output.errors import UsageError
from ...run.measuring import Nothing, asked, measured
from ...run.workers.places import place
from ...run.workers.words import HELP, check_place
from ...subjects.normals.captures import OFF_UNIT_SHARE, UNIT_WITHIN
from ...subjects.normals.normal_sets import NORMAL_SETS, from_arrays
from ...tables.registry import TABLES
from ...tables.table import Measured, Table


class Rows(pd.DataFrame):
    """A table's rows, one per line of the data frame. A notebook shows them with the table's charts.

    `attrs` has the table's name, and each column's unit and definition.
    """

    _metadata = ["measured"]  # noqa: RUF012 # pandas reads a list

    @property
    def _constructor(self) -> type[pd.DataFrame]:
        """The type of results that pandas derives from these rows: a plain data frame."""
        return pd.DataFrame

    def charts(self) -> list[Any]:
        """Return the table's charts as a list of matplotlib figures; empty if the table has no charts."""
        table, done = self.measured
        return [drawing.draw() for drawing in _drawings(table, done)]

    def _repr_html_(self) -> str:
        table, done = self.measured
        return str(super()._repr_html_()) + "".join(map(_svg, _drawings(table, done)))


def _drawings(table: Table, done: Measured) -> list[Any]:
    return list(map(of, table.work.charts([dict(row) for row in done.rows])))


def _svg(drawing: Any) -> str:
    from io import StringIO

    from ....reports.charts.plots import save

    text = StringIO()
    save(drawing.draw(), (text, "svg"))  # pyright: ignore[reportArgumentType] # matplotlib writes to either
    return text.getvalue()[text.getvalue().index("<svg") :]


@cache
def function_of(name: str) -> Callable[..., Rows]:
    """Return a table's function, which takes options as keyword arguments, and lists instead of comma-separated
    names."""
    table = TABLES[name]

    def call(*, on: str | None = None, **options: Any) -> Rows:
        given = {key: _typed(key, value) for key, value in options.items()}
        chosen = table.options(**checked_options(table.options, given))
        check_place(on)
        with place(on) as where:
            return _framed(table, measured(asked(table, chosen), Nothing(), where))

    known = fields_of(table.options)
    parameters = [inspect.Parameter(n, inspect.Parameter.KEYWORD_ONLY, default=f.default) for n, f in known.items()]
    parameters.append(inspect.Parameter("on", inspect.Parameter.KEYWORD_ONLY, default=None))
    call.__name__ = call.__qualname__ = name
    call.__signature__ = inspect.Signature(parameters, return_annotation=Rows)  # pyright: ignore[reportFunctionMemberAccess]
    arguments = "".join(f"\n    {n}: {f.option.help}" for n, f in known.items()) + f"\n    on: {HELP}"
    call.__doc__ = f"{table.help}\n\nArgs:{arguments}\n\nReturns:\n    a pandas DataFrame with one line per row.\n"
    return call


def _framed(table: Table, done: Measured) -> Rows:
    rows = Rows(list(done.rows))
    columns = {name: column for name in rows.columns if (column := table.column(name))}
    rows.attrs = {
        "table": table.name,
        "units": {name: column.unit for name, column in columns.items() if column.unit},
        "definitions": {name: column.says for name, column in columns.items()},
    }
    object.__setattr__(rows, "measured", (table, done))
    return rows


def _typed(key: str, value: Any) -> Any:
    """Return an argument in the form that its option takes: a list, a mapping, an encoding or a storage as a tuple of
    names and Given values, a pair for `size` as "WxH", and other values unchanged."""
    if isinstance(value, Mapping):
        return tuple(Given(name, _value(key, name, array)) for name, array in value.items())
    several = value if isinstance(value, list | tuple) else [value]
    if key == "size" and len(several) == 2 and all(isinstance(side, int) for side in several):
        return f"{several[0]}x{several[1]}"
    if isinstance(value, list | tuple | Encoding | Storage):
        return tuple(Given(word.name, word) if isinstance(word, Encoding | Storage) else str(word) for word in several)
    return value


def _check_unit(name: str, array: np.ndarray) -> None:
    """Raise UsageError if an array does not hold finite floats, or too many of its vectors do not have length 1. Zero
    vectors, for the background, are ignored, but not all vectors may be zero."""
    if not np.issubdtype(array.dtype, np.floating):
        raise UsageError(f"normals: {name} has type {array.dtype}; give floats in [-1, 1]")
    if not np.isfinite(array).all():
        raise UsageError(f"normals: {name} contains NaN or infinity; set these normals to 0 to leave them out")
    lengths = np.linalg.norm(array.reshape(-1, 3).astype(np.float64), axis=1)
    off = np.mean(abs(lengths[lengths > 0] - 1) > UNIT_WITHIN) if (lengths > 0).any() else 1.0
    if off > OFF_UNIT_SHARE:
        raise UsageError(f"normals: {off:.1%} of {name} are not unit vectors; normalise or unpack them")


def _depths(name: str, array: np.ndarray) -> np.ndarray:
    if array.ndim != 2 or not array.size or not (np.issubdtype(array.dtype, np.floating) or array.dtype.kind == "u"):
        description = f"type {array.dtype} and shape {array.shape}"
        raise UsageError(f"depths: {name} has {description}; give floats or unsigned integers of shape (height, width)")
    return array


def _value(key: str, name: str, value: Any) -> Any:
    """Return an option's value for a named array: for normals, (..., 3), a set to measure on; for depths, (height,
    width), the array unchanged. Raises UsageError for any other array."""
    array = np.asarray(value)
    if key == "depths":
        return _depths(name, array)
    if key != "normals" or array.ndim < 2 or array.shape[-1] != 3 or not array.size:
        raise UsageError(f"{key}: {name} must be an array of normals of shape (count, 3) or (height, width, 3)")
    if name in NORMAL_SETS:
        raise UsageError(f"normals: {name} is a built-in set; use another name")
    _check_unit(name, array)
    array = array.astype(np.float32)
    flat = array.reshape(-1, 3)
    shape: tuple[int, int] | None = (array.shape[0], array.shape[1]) if array.ndim == 3 else None
    view = np.tile(np.array([0, 0, -1], np.float32), (len(flat), 1))
    covered = np.any(flat != 0, axis=-1)
    return from_arrays(name, f"the caller's {name}", flat, view, covered, shape)
