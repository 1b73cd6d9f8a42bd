"""Files that may be replaced: files that normalbench wrote, unless the command reads them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

from .errors import UsageError

# How much is read of either end of a file, in bytes.
MOST = 1 << 16
PAGE, ARRAY = b'<meta name="generator" content="normalbench">', b"\x93NUMPY"
PNG, SVG, PDF = b"Software\0normalbench", b"<dc:title>normalbench</dc:title>", b"/Creator (normalbench)"
# What a file of normalbench has near one of its ends, and what that file is called. The first mark decides.
MARKS: Mapping[bytes, str] = MappingProxyType(
    {
        PAGE: "page",
        ARRAY: "NumPy array",
        PNG: "picture",
        SVG: "picture",
        PDF: "picture",
        b'\ntitle = "normalbench budget, ': "layout",
        b"keepPicture(": "script",
        b"## normalbench: ": "report",
    }
)
# By the ending of a plot's name.
PLOTS: Mapping[str, bytes] = MappingProxyType({".png": PNG, ".svg": SVG, ".pdf": PDF})
# What gives the files that this command reads; see `bench/door/cli/app.py`.
reads: list[Callable[[], Iterable[Path]]] = []


def check_replaceable(path: Path, mark: bytes = b"") -> None:
    """Raise UsageError if an existing file is an input of the command, or lacks the mark of the file that replaces
    it.

    Also raises OSError.

    Args:
        mark: one of MARKS; empty for any file.
    """
    if not path.is_file():
        return
    if any(other.exists() and path.samefile(other) for files in reads for other in files()):
        raise UsageError(f"{path}: this is an input of the command; name another file")
    old = _ends(path)
    if mark not in old and not is_empty(old):
        raise not_ours(path, MARKS[mark])


def check_alike(path: Path, new: Path) -> None:
    """Raise UsageError if a file must not be replaced by a new file: see `check_replaceable`. Without a mark, two
    files are alike if their first bytes match, and two texts if their first lines match. Also raises OSError."""
    old, ends = _ends(path), _ends(new)
    mark = next((mark for mark in MARKS if mark in ends), b"")
    check_replaceable(path, mark)
    if not (mark or is_empty(old) or _beginning(old) == _beginning(ends)):
        raise not_ours(path, "file")


def not_ours(path: Path, what: str) -> UsageError:
    """Return the error for a file that normalbench did not write."""
    return UsageError(f"{path}: not a {what} written by normalbench; name another file, or delete this one")


def is_empty(data: bytes) -> bool:
    """Whether a file's content is blank, so that nothing is lost if the file is replaced."""
    return not data.strip()


def _ends(path: Path) -> bytes:
    """Return the first and the last MOST bytes of a file, because matplotlib writes its name at the end of a PDF. A
    short file is returned whole."""
    with path.open("rb") as file:
        first = file.read(MOST)
        file.seek(max(file.seek(0, 2) - MOST, len(first)))
        return first + file.read()


def _beginning(data: bytes) -> bytes:
    """Return the beginning that files of the same kind share: the first bytes, the bracket of JSON, or the first
    line."""
    if b"\0" in data:
        return data[:4]
    return data[:1] if data[:1] in (b"{", b"[") else data.partition(b"\n")[0]
