"""Measurements of the manual's tables by the command line in this process, and conversions of the printed rows to the
tables' lines."""

import json
import os
import re
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from unittest.mock import patch

from .table import Measured, Row, Table

ROOT = Path(__file__).parents[2]


def measure(table: Table, is_again: bool = False) -> Measured:
    """Measure a table. With `is_again`, use its quicker commands if it has any."""
    rows = (is_again and table.again) or table.rows
    return table.measured(rows() if callable(rows) else [row for command in rows for row in rows_of(command)])


def rows_of(command: str) -> list[Row]:
    """Return the rows that a command of normalbench prints."""
    return json.loads(printed(f"{command} --format json"))


def printed(command: str) -> str:
    """Return the output of a command of normalbench."""
    from normalbench.bench.door.cli import app

    out, err, words = StringIO(), StringIO(), ["normalbench", *command.split()]
    # As wide as a page, whatever runs the test.
    wide = patch.dict(os.environ, {"COLUMNS": "120"})
    with wide, redirect_stdout(out), redirect_stderr(err), patch.object(sys, "argv", words):
        assert app.main() == 0, f"{command}: {err.getvalue()}"
    return out.getvalue()


def answers() -> list[Row]:
    """Return each line that `pick` prints, with its storage."""
    _, *parts = re.split(r"^(?=(\w+), on \w+: take )", printed("pick"), flags=re.M)
    answered = zip(parts[::2], parts[1::2], strict=True)
    return [{"storage": storage, "said": line} for storage, part in answered for line in part.rstrip().split("\n")]


def simulated() -> list[Row]:
    """Return simulated runs on many workers, from the step times of a record."""
    command = [sys.executable, "-m", "tests.speed", "simulate"]
    return json.loads(subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout)


def published() -> list[Row]:
    """Return figures of articles and engines. Fails if one differs without a reason."""
    from published.rows import rows, unexplained

    measured = rows()
    assert not unexplained(measured), "\n".join(unexplained(measured))
    return measured


def for_every_storage(rows: list[Row]) -> list[Row]:
    """Return rows in which each row without a storage is repeated for every storage of its encoding."""
    of = [(row["encoding"], row["storage"]) for row in rows if row["encoding"] and row["storage"]]
    return [
        row | {"storage": storage}
        for encoding, storage in dict.fromkeys(of)
        for row in rows
        if row["encoding"] == encoding and row["storage"] in (storage, None)
    ]


def of_the_article(rows: list[Row]) -> list[Row]:
    """Return rows with the article's figure."""
    from normalbench.bench.measures.metrics.published import PSNR_DB

    return [row | {"article_db": PSNR_DB.get(row["encoding"])} for row in rows]


def with_limits(rows: list[Row]) -> list[Row]:
    """Return rows with the bound of two bytes for each domain, which `quality` prints only for people."""
    from normalbench.bench.measures.metrics.code_limits import HEMISPHERE, SPHERE, code_limit

    names = {"angle_mean_deg": "mean_deg", "angle_rms_deg": "rms_deg", "angle_sup_deg": "max_deg"}
    return rows + [
        {"encoding": "limit", "domain": domain, "effective_bits": 16.0}
        | {name: getattr(code_limit(2**16, area), figure) for name, figure in names.items()}
        for domain, area in (("sphere", SPHERE), ("hemisphere", HEMISPHERE))
    ]


def parameters_named(rows: list[Row]) -> list[Row]:
    """Return rows with the result of tuning: parameters or a table."""
    for row in rows:
        row["parameters"] = f"`{row['tuned_encoding'].removeprefix(row['encoding'])[1:].removesuffix('=FILE')}`"
    return rows


def arithmetic_apart(rows: list[Row]) -> list[Row]:
    """Return rows with the encoding's name, and separately the arithmetic that the name may end with."""
    parts = ((row, (row["encoding"] or "").partition(":arithmetic=")) for row in rows)
    return [row | {"encoding": name, "arithmetic": arithmetic or "float"} for row, (name, _, arithmetic) in parts]


def verdicts_of_mixes(rows: list[Row]) -> list[Row]:
    """Return a row for each encoding: its verdicts and the worst figures behind them."""
    from normalbench.bench.tables.mix.verdict import lines

    return list(lines(rows))


def in_thousandths(rows: list[Row]) -> list[Row]:
    """Return the errors of effects, in 1/1000."""
    return [row | {name: row[name] and 1e3 * row[name] for name in ("effect_rms", "method_rms")} for row in rows]


def exact_named(rows: list[Row]) -> list[Row]:
    """Return rows of effects in which an exact storage or depth is named "exact"."""
    return [row | {name: row[name] or "exact" for name in ("storage", "depth")} for row in rows]


def most_differing(rows: list[Row]) -> list[Row]:
    """Return a row for each encoding: for each storage, the largest number of texels that differ in any language."""
    ran = sorted((row for row in rows if "differing" in row), key=lambda row: row["differing"])
    return [
        {"encoding": encoding} | {row["storage"]: row["differing"] for row in ran if row["encoding"] == encoding}
        for encoding in dict.fromkeys(row["encoding"] for row in rows)
    ]
