"""Writing of results: a file is written whole or not at all, and a failure is reported in one line."""

from __future__ import annotations

import glob
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ....reports import tables
from ....reports.charts import plots
from ..machine.systems.files import is_closed_pipe, moved_over
from ..machine.systems.processes import is_running
from .errors import UsageError, hear
from .replacing import PLOTS, check_alike, check_replaceable

# Of a run's rows, facts and tables.
RUN, OWN_SUFFIXES = "run.json", (".json", ".jsonl", ".csv")
NOT_PAGES = (".pdf", ".png", ".svg", ".md", ".csv", ".json")
FILE_SUFFIXES = (*NOT_PAGES, ".jpg", ".jpeg", ".exr", ".html", ".txt")


def check_writable(path: Path, makes_folder: bool = False, mark: bytes = b"") -> None:
    """Raise UsageError if a file of this name cannot be written; called before anything is measured.

    Args:
        makes_folder: whether a missing folder will be made.
        mark: the mark that an existing file must have, see `check_replaceable`.
    """
    try:
        if path.is_dir():
            raise UsageError(f"{path} is a folder; name a file")
        if is_special(path):
            return
        _check_own(target_of(path))
        check_replaceable(path, mark)
        # Asked of what it will be called while it is written, so that a name that is too long is noticed.
        partial_of(path).exists()
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror or error}") from error
    folder = target_of(path).parent
    if not (makes_folder or folder.is_dir()):
        raise UsageError(f"cannot write {path}: folder {path.parent} does not exist")
    check_folder(folder)


def _check_own(path: Path) -> None:
    """Raise UsageError if a file belongs to a run, because only the run may write it."""
    is_own = path.suffix in OWN_SUFFIXES and (path.parent / RUN).exists() and path.exists()
    if is_own:
        raise UsageError(f"{path} belongs to the run in its folder; name another file")


def partial_of(path: Path) -> Path:
    """Return the name of a file or folder while it is being written; no two processes share it."""
    return path.with_name(f".{path.name}.{os.getpid()}.partial")


def check_folder(folder: Path) -> None:
    """Raise UsageError if no file can be made in a folder, or the folder cannot be made. Leaves nothing behind."""
    there = folder
    while not there.exists() and there != there.parent:
        if there.is_symlink():
            # To make a folder of this name would only say that the name is taken.
            why = f"{there} is a link to {there.readlink()}, which does not exist"
            raise UsageError(f"cannot write to {folder}: {why}; fix the link, or name another folder")
        there = there.parent
    try:
        with tempfile.TemporaryFile(dir=there):
            pass
    except OSError as error:
        raise UsageError(f"cannot write to {folder}: {error.strerror or error}") from error


def target_of(path: Path) -> Path:
    """Return the file to write, with all links resolved. Raises UsageError if the links form a loop."""
    try:
        return path.resolve()
    except (OSError, RuntimeError) as error:
        raise UsageError(f"cannot write to {path}: its links form a loop; name another file") from error


def is_special(path: Path) -> bool:
    """Whether a path is an existing pipe, device or other special file, which is written to and never replaced."""
    return path.exists() and not path.is_file()


def clear_away(path: Path) -> None:
    """Remove the partial files and folders that killed processes left behind for a path. Raises OSError."""
    for partial in path.parent.glob(f".{glob.escape(path.name)}.*.partial"):
        number = partial.name.split(".")[-2]
        if number.isdecimal() and not is_running(int(number)):
            shutil.rmtree(partial) if partial.is_dir() else partial.unlink(missing_ok=True)


@contextmanager
def whole_file(path: Path, is_checked: bool = False) -> Iterator[Path]:
    """Yield a path to write to, which becomes `path` if all goes well and is deleted otherwise.

    Missing folders are made. A link's target is written, not the link.

    Args:
        is_checked: whether the caller knows that an existing file may be replaced.

    Raises:
        UsageError: the file cannot be written, or a different kind of file has its name.
    """
    path = target_of(path)
    partial = path if is_special(path) else partial_of(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        clear_away(path)
        yield partial
        if partial != path:
            # Files of a run are replaced as it goes on, also those of earlier versions, which had no marks.
            is_known = is_checked or any((folder / RUN).exists() for folder in path.parents[:2])
            if is_known or not path.exists():
                check_replaceable(path)
            else:
                check_alike(path, partial)
            moved_over(partial, path)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        if partial != path:
            partial.unlink(missing_ok=True)


def check_page(path: Path | None) -> None:
    """Raise UsageError if a page's name has the extension of a different kind of file; None is allowed."""
    if path and path.suffix.lower() in NOT_PAGES:
        raise UsageError(f"{path}: the page is HTML; name it {path.with_suffix('.html')}")


def check_is_folder(path: Path | None, what: str) -> None:
    """Raise UsageError if a folder is named like a file, or a file has its name; None is allowed."""
    if path and not path.is_dir() and (path.is_file() or path.suffix.lower() in FILE_SUFFIXES):
        free = path.with_suffix("") if path.suffix else path.with_name(f"{path.name}-folder")
        raise UsageError(f"{path}: {what} a folder; name one, such as {free.name or 'pictures'}")


def check_plot(path: Path | None) -> None:
    """Raise UsageError or PlotError if a plot of this name cannot be written; None is allowed."""
    if path:
        # A folder is said to be one, whatever its name ends in.
        check_writable(path, mark=PLOTS.get(path.suffix.lower(), b""))
        plots.check_format(path)


def save_plot(path: Path, figure: Any) -> None:
    """Write a figure in the format given by the file's extension. Raises UsageError if the file cannot be written."""
    with whole_file(path) as partial:
        plots.save(figure, (partial, path.suffix[1:].lower()))


def say(text: str) -> None:
    """Write text to standard output; names of files in it cannot change the state of the terminal.

    It is not an error if the program at the other end has closed the pipe.
    """
    hear(False, text)
    try:
        sys.stdout.write(tables.visible(text))
        sys.stdout.flush()
    except OSError as error:
        if not is_closed_pipe(error):
            raise
        abandon_output()


def abandon_output() -> None:
    """Discard all later output: Python flushes once more at exit, and would report an error."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def write_text(make: Callable[[], str], output: Path | None, is_checked: bool = False) -> None:
    """Write text to a file or to standard output. The text is made only after the check that the file can be written.

    Args:
        make: a function that returns the text.
        is_checked: see `whole_file`.

    Raises:
        UsageError: the file cannot be written.
    """
    if output:
        check_writable(output)
    text = make()
    if not output:
        say(text)
        return
    with whole_file(output, is_checked) as partial:
        partial.write_text(text, encoding="utf-8", newline="\n")


def files_of(folder: Path) -> dict[str, Path]:
    """Return a folder's own files by name, without links; empty if the folder cannot be read."""
    try:
        return {path.name: path for path in folder.iterdir() if path.is_file() and not path.is_symlink()}
    except OSError:
        return {}


def without(rows: Sequence[dict[str, Any]], hidden: Collection[str]) -> list[dict[str, Any]]:
    """Return copies of the rows without the hidden columns."""
    return [{column: value for column, value in row.items() if column not in hidden} for row in rows]
