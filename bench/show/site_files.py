"""Writing a site into a folder without changing files that belong to anybody else.

A marker file lists the files that this program wrote there. The next site replaces these files, and removes those
that are not part of it; all other files stay unchanged.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ...encodings.codecs.files import file_json
from ..ground.output.errors import UsageError
from ..ground.output.writing import check_folder, clear_away, partial_of, whole_file

MARKER = ".normalbench-site.json"
# What a site's own files are called; a marker that lists others was not written by this program.
OWN = re.compile(r"(index|choose|layouts)\.html|(codecs|devices)/[a-z0-9_-]+\.html")
INDEX, FOLDERS = "index.html", ("codecs", "devices")


def write_site(folder: Path, files: Mapping[str, str]) -> None:
    """Write a site's files, given as text by relative path, in place of an earlier site's files.

    Raises:
        UsageError: a file of that name is not from an earlier site, the marker is damaged, or the site cannot be
            written. The folder is unchanged, unless moving the finished files into it fails.
    """
    before = _files_before(folder)
    check_folder(folder)
    for path in files:
        if path not in before and (folder / path).exists():
            raise UsageError(f"{folder / path} is not from an earlier site; delete it, or name another folder")
    try:
        with _partial_folder(folder) as partial:
            _write(partial, files, sorted({*before, *files}))
            _put(partial, folder, files)
        _clear(folder, set(before) - set(files), files)
    except OSError as error:
        raise UsageError(f"cannot write {folder}: {error.strerror or error}") from error


def _files_before(folder: Path) -> list[str]:
    """Return the paths of the files that this program wrote to a folder earlier; empty if the folder has no marker
    file. Raises UsageError if the folder cannot be used, or if its marker is damaged."""
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"{folder} is not a folder; name a folder")
    # Behind a link lies somebody else's folder.
    if any((folder / name).is_symlink() for name in (MARKER, INDEX, *FOLDERS)):
        raise UsageError(f"{folder} has a symbolic link where the site's files go; name another folder")
    if not (folder / MARKER).exists():
        return []
    try:
        files = file_json(folder / MARKER)["files"]
        if not all(isinstance(name, str) and OWN.fullmatch(name) for name in files):
            raise ValueError("it lists files that are not part of a site")
    except (OSError, ValueError, TypeError, KeyError) as error:
        reason = (
            error if isinstance(error, OSError | ValueError) and not isinstance(error, KeyError) else "no list of files"
        )
        raise UsageError(f"{folder / MARKER}: {reason}; delete it, or name another folder") from None
    return files


@contextmanager
def _partial_folder(folder: Path) -> Iterator[Path]:
    """Create a temporary folder next to `folder`, on the same disk; yield its path, and delete it afterwards."""
    folder = folder.resolve()
    folder.parent.mkdir(parents=True, exist_ok=True)
    clear_away(folder)
    partial = partial_of(folder)
    try:
        partial.mkdir()
        yield partial
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def _write(folder: Path, files: Mapping[str, str], listed: list[str]) -> None:
    for path, text in {**files, MARKER: _marker_text(listed)}.items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8", newline="\n")


def _marker_text(files: list[str]) -> str:
    return json.dumps({"made_by": "normalbench site", "files": files}, indent=1) + "\n"


def _put(partial: Path, folder: Path, files: Mapping[str, str]) -> None:
    """Move the written files into place: all at once if the folder is empty, otherwise the index last."""
    if not folder.exists() or not any(folder.iterdir()):
        place = folder.resolve()
        if place.exists():
            # Windows puts nothing in the place of a folder.
            place.rmdir()
        partial.replace(place)
        return
    for path in (MARKER, *(path for path in files if path != INDEX), INDEX):
        (folder / path).parent.mkdir(exist_ok=True)
        (partial / path).replace(folder / path)


def _clear(folder: Path, stale: set[str], files: Mapping[str, str]) -> None:
    """Delete an earlier site's files that the new site does not have, then remove them from the marker."""
    for path in stale:
        (folder / path).unlink(missing_ok=True)
    if stale:
        with whole_file(folder / MARKER) as partial:
            partial.write_text(_marker_text(sorted(files)), encoding="utf-8", newline="\n")
