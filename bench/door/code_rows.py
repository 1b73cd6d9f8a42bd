"""Parts of `code` that codecs and layouts share: verifying files, tabulating the verdicts and writing files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

from ...gbuffer.gl.device import NoDeviceError
from ...gbuffer.gl.shader import ShaderError
from ..ground.output.errors import MissingError, UsageError, tell
from ..ground.output.progress import progress
from ..ground.output.writing import check_folder, check_is_folder, say, whole_file
from ..keep.row_files import check_rows, write
from ..shaders.code import verify
from ..shaders.code.emit import LANGUAGES
from ..shaders.code.files import Code
from ..shaders.code.run import runner
from ..shaders.code.whole import verify as layout_verify
from ..shaders.code.whole.emit import GBufferCode
from ..tables.table import Row

# What is said of a file that was run, or could not be.
VERIFIED, DIFFERS, NOT_RUN = "verified", "differs", "not run"
# What is run in place of a language that is not, the first that can be.
WITNESSES = ("c", "glsl")
# Of the rows that `code --check` writes; for people each language is a column.
COLUMNS = (
    *("encoding", "storage", "rounding", "layout", "bytes_per_pixel", "language", "verdict", "values", "texels"),
    *("differing", "steps", "run_by", "says", *LANGUAGES),
)


CodeT = TypeVar("CodeT", Code, GBufferCode)


def compared(
    agreement: Callable[[], verify.Agreement | layout_verify.Agreement], language: str, more: Sequence[str] = ()
) -> Row:
    """Run a file with `agreement`, and return a row with its "verdict" (VERIFIED, DIFFERS or NOT_RUN) and "says", a
    description. If the file ran, the row also has "values", "differing", "steps" and "run_by".

    Args:
        agreement: a function that runs the file and compares its results.
        more: names of other columns, which are attributes of the agreement."""
    try:
        agrees, how = agreement(), runner(language).how()
    except (MissingError, NoDeviceError) as error:
        return {"verdict": NOT_RUN, "says": f"not run here: {error}"}
    except ShaderError as error:
        return {"verdict": DIFFERS, "says": f"does not run: {error}"}
    row: Row = {"verdict": VERIFIED if agrees.holds else DIFFERS, "values": agrees.count}
    row |= {name: getattr(agrees, name) for name in (*more, "differing", "steps")}
    return row | {"run_by": how, "says": f"{agrees.says}; run by {how}"}


def witness(codes: Iterable[CodeT], verified: Callable[[CodeT], Row]) -> list[tuple[CodeT, Row]]:
    """Return the first code that can be run here, with its row, in a list; an empty list if no code can be run."""
    rows = ((code, verified(code)) for code in codes)
    return list(islice((pair for pair in rows if pair[1]["verdict"] != NOT_RUN), 1))


def check_place(output: Path | None, count: int) -> None:
    """Raise UsageError if `count` files cannot be written to the folder `output` or, for None, to standard output."""
    check_is_folder(output, "code writes into")
    if output and output.suffix in {language.ending for language in LANGUAGES.values()}:
        raise UsageError(f"{output}: code writes files into a folder; name a folder, or print one file with > {output}")
    if output:
        check_folder(output)
    elif count > 1:
        raise UsageError("several files need a folder; name one with -o")


def save(code: Code | GBufferCode, head: Sequence[str], output: Path | None) -> None:
    """Write the files to a folder and report their paths, or write the text to standard output. Raises UsageError if
    there are several files and no folder."""
    files = code.files(head)
    if output is None and len(files) > 1:
        raise UsageError(f"{code.name} comes with lookup table files; name a folder with -o")
    if output is None:
        say(code.text(head))
        return
    for name, data in files.items():
        with whole_file(output / name) as partial:
            partial.write_bytes(data)
        tell(f"{output / name}")


def check_codes(
    codes: Sequence[CodeT],
    verified: Callable[[CodeT], Row],
    about: Sequence[str],
    format: str,
    output: Path | None,
) -> int:
    """Write a table of how each code was verified. Return the exit status: 1 if any code differs.

    Args:
        verified: a function that returns a code's row.
        about: the columns that name the codec or the layout.
    """
    check_rows(output, COLUMNS)
    rows: list[Row] = []
    with progress(len(codes)) as tick:
        for code in codes:
            rows.append(verified(code))
            tick(code.name)
    for line in dict.fromkeys(row["says"] for row in rows if row["verdict"] == NOT_RUN):
        tell(line)
    failed = [(code, row) for code, row in zip(codes, rows, strict=True) if row["verdict"] == DIFFERS]
    for code, row in failed:
        tell(f"{code.name}: {row['says']}")
    write(_by_language(rows, about) if format in ("table", "markdown") else rows, format, output, ())
    return int(bool(failed))


def _by_language(rows: Sequence[Row], about: Sequence[str]) -> list[Row]:
    """Return one row per codec or layout: the columns `about`, and for each language "equal", the number of values
    that differ, or a verdict other than VERIFIED."""
    lines: dict[tuple[Any, ...], Row] = {}
    for row in rows:
        line = {name: row[name] for name in about}
        lines.setdefault(tuple(line.values()), line)[row["language"]] = _in_short(row)
    return list(lines.values())


def _in_short(row: Row) -> str:
    if row["verdict"] != VERIFIED:
        return row["verdict"]
    return f"{row['differing']} of {row['values']}" if row["differing"] else "equal"
