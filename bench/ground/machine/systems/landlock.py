"""A wall around a process, which the process cannot remove: Landlock in Linux. Imports nothing heavy.

    python -I -S landlock.py r/usr/lib w/tmp/made x/usr/bin/cc -- /usr/bin/cc main.c

builds a wall around itself and becomes the command: see `command`.
https://docs.kernel.org/userspace-api/landlock.html

Denied, except for the named paths: reading files and listing folders; writing, creating, removing, renaming and
truncating files; and executing. Also denied: all TCP (from ABI 4 on), operations special to devices (ABI 5), signals
to processes and abstract sockets outside (ABI 6), and tracing processes outside. Even in a writable folder, nothing
can be moved to another folder and only files and folders can be created, so that a later reader of the folder finds
no link, pipe, socket or device.

Not denied: learning that a path exists, its status and the target of a link; changing the mode, owner, times and
attributes of the user's files; UDP; sockets in folders, such as the sockets of a desktop; anything that open
descriptors give access to. EXECUTE applies to `execve` only: the loader and `memfd_create` can run other bytes too,
behind the same wall.
"""

from __future__ import annotations

import ctypes
import os
import stat
import struct
import sys
from contextlib import suppress

# Below ABI 3 (Linux 6.2) a process could empty files outside: that is no wall.
LEAST = 3
# What a walled command keeps of the variables: others may hold secrets. The first folder to write is its TMPDIR.
VARIABLES = ("PATH", "LANG", "LC_ALL", "LD_LIBRARY_PATH", "LIBRARY_PATH", "CPATH", "C_INCLUDE_PATH", "COMPILER_PATH")

# linux/landlock.h, the same on all processors.
CREATE_RULESET, ADD_RULE, RESTRICT_SELF, VERSION, PATH_BENEATH = 444, 445, 446, 1, 1
EXECUTE, WRITE_FILE, READ_FILE, READ_DIR, REMOVE_DIR, REMOVE_FILE = (1 << bit for bit in range(6))
MAKE_DIR, MAKE_REG, TRUNCATE, IOCTL_DEV = 1 << 7, 1 << 8, 1 << 14, 1 << 15
OF_FILES = EXECUTE | WRITE_FILE | READ_FILE | TRUNCATE | IOCTL_DEV
READS = READ_FILE | READ_DIR
WRITES = READS | WRITE_FILE | TRUNCATE | MAKE_REG | MAKE_DIR | REMOVE_FILE | REMOVE_DIR
RIGHTS = {"r": READS, "w": WRITES, "x": READ_FILE | EXECUTE}
TCP, OUTSIDE, NO_NEW_PRIVILEGES = 0b11, 0b11, 38


def abi() -> int:
    """Return Landlock's version on this system; 0 if the system lacks Landlock or does not let this process use
    it."""
    return max(0, _called(CREATE_RULESET, None, 0, VERSION)) if sys.platform == "linux" else 0


def is_available() -> bool:
    """Whether `restrict` and `command` work here."""
    return abi() >= LEAST


def restrict(reads: list[str], writes: list[str], executes: list[str]) -> None:
    """Put a permanent wall around this process and all processes that it starts from now on.

    The wall applies to the calling thread only. A process with other threads is refused, because these threads would
    stay outside.

    Args:
        reads: files, and folders with their contents. Paths that do not exist are ignored, here and below.
        writes: folders to read and write in, and files such as /dev/null.
        executes: programs, and the library loaders that they name, which the kernel executes too.

    Raises:
        RuntimeError: the process has other threads.
        OSError: the kernel refuses; the caller must not run anything then.
    """
    # A folder has two links and one for each folder in it; behind a wall it could not be listed.
    if os.stat("/proc/self/task").st_nlink > 3:
        raise RuntimeError("a wall binds one thread, and this process has more")
    known = abi()
    handled = (1 << 16) - 1 if known >= 5 else (1 << 15) - 1
    asked = struct.pack("QQQ", handled, TCP if known >= 4 else 0, OUTSIDE if known >= 6 else 0)
    _checked(ctypes.CDLL(None, use_errno=True).prctl(NO_NEW_PRIVILEGES, *map(ctypes.c_ulong, (1, 0, 0, 0))))
    rules = _checked(_called(CREATE_RULESET, asked, len(asked), 0))
    for kind, paths in {"r": reads, "w": writes, "x": executes}.items():
        for path in paths:
            _allow(rules, path, RIGHTS[kind] & handled)
    _checked(_called(RESTRICT_SELF, rules, 0))
    os.close(rules)


def forget_variables() -> None:
    """Remove all environment variables except VARIABLES and Python's from this process: the others may hold
    secrets."""
    for name in [*os.environ]:
        if name not in VARIABLES and not name.startswith("PYTHON"):
            del os.environ[name]


def command(words: list[str], reads: list[str], writes: list[str], executes: list[str]) -> list[str]:
    """Return the command that builds a wall around itself and then becomes the command `words`, whose first word is a
    path that is also in `executes`; see `restrict`. The command keeps only VARIABLES of the environment, and its
    status is 126 if `words` cannot be run."""
    rules = [kind + path for kind, paths in (("r", reads), ("w", writes), ("x", executes)) for path in paths]
    return [sys.executable, "-I", "-S", __file__, *rules, "--", *words]


def _allow(rules: int, path: str, rights: int) -> None:
    with suppress(OSError):
        place = os.open(path, getattr(os, "O_PATH", 0))
        try:
            is_folder = stat.S_ISDIR(os.fstat(place).st_mode)
            rule = struct.pack("=Qi", rights if is_folder else rights & OF_FILES, place)
            _checked(_called(ADD_RULE, rules, PATH_BENEATH, rule, 0))
        finally:
            os.close(place)


def _called(number: int, *arguments: bytes | int | None) -> int:
    given = [value if isinstance(value, bytes) else ctypes.c_void_p(value) for value in arguments]
    return ctypes.CDLL(None, use_errno=True).syscall(ctypes.c_long(number), *given)


def _checked(result: int) -> int:
    if result < 0:
        raise OSError(number := ctypes.get_errno(), os.strerror(number))
    return result


if __name__ == "__main__":
    end = sys.argv.index("--")
    given = {kind: [word[1:] for word in sys.argv[1:end] if word[0] == kind] for kind in RIGHTS}
    kept = {name: os.environ[name] for name in VARIABLES if name in os.environ}
    folder = next(filter(os.path.isdir, given["w"]), "/nowhere")
    try:
        restrict(given["r"], given["w"], given["x"])
        os.execve(sys.argv[end + 1], sys.argv[end + 1 :], kept | {"TMPDIR": folder})
    except OSError as error:
        print(f"{sys.argv[end + 1]}: {error.strerror}", file=sys.stderr)
        sys.exit(126)
