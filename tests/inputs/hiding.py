"""A Python start-up module that hides names that a system lacks from the program, and adds names that only it has.

Other packages still see all of Linux, because they are installed for Linux here.
"""

import builtins
import json
import sys
import types
import warnings
from contextlib import suppress
from pathlib import Path

TOLD = json.loads((Path(__file__).parent / "lacking.json").read_text(encoding="utf-8"))
ROOM = "normalbench.bench.ground.machine.systems"
GONE = set(TOLD["gone"])


def _of_windows():
    """Return the names that only Windows has and that the program uses, by module."""
    import ctypes
    import fcntl
    import os
    import signal

    class Kernel:
        """kernel32: jobs that each hold a process."""

        def __init__(self):
            self.held = {}

        def __getattr__(self, name):
            def call(*given):
                return self.called(name, [getattr(value, "value", value) for value in given])

            setattr(self, name, call)
            return call

        def called(self, name, given):
            if name == "OpenProcess":
                return given[2]
            if name == "AssignProcessToJobObject":
                self.held[given[0]] = given[1]
            if name == "CreateJobObjectW":
                return 1000 + len(self.held)
            if name == "TerminateJobObject":
                with suppress(ProcessLookupError):
                    os.killpg(self.held.pop(given[0]), signal.SIGKILL)
            if name == "WaitForSingleObject":
                return 0x102 if Path("/proc", str(given[0])).exists() else 0
            return 1

    def popen(*words, creationflags=0, **how):
        return subprocess.Popen(*words, start_new_session=bool(creationflags), **how)

    def c_library(name, *rest, **more):
        return ctypes.CDLL(None if name == "ucrtbase" else name, *rest, **more)

    import subprocess

    msvcrt = types.ModuleType("msvcrt")
    msvcrt.LK_NBLCK = 2
    msvcrt.locking = lambda file, *_: fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    sys.modules["msvcrt"] = msvcrt
    kernel = Kernel()
    return {
        "signal": {"SIGBREAK": signal.SIGUSR1},
        "subprocess": {"Popen": popen, "CREATE_NEW_PROCESS_GROUP": 0x200},
        "ctypes": {
            "WinDLL": lambda *_, **__: kernel,
            "CDLL": c_library,
            "WinError": OSError,
            "get_last_error": lambda: 0,
        },
        "os": {"O_BINARY": 0},
    }


class Seen(types.ModuleType):
    """A module as the program sees it."""

    def __init__(self, real, hidden, added):
        super().__init__(real.__name__)
        self.__dict__.update(_real=real, _hidden=hidden, _added=added)

    def __getattr__(self, name):
        if name in self._added:
            return self._added[name]
        if name in self._hidden:
            raise AttributeError(f"module {self.__name__!r} has no attribute {name!r} on {TOLD['system']}")
        return getattr(self._real, name)

    def __setattr__(self, name, value):
        setattr(self._real, name, value)


_seen = {}
_import = builtins.__import__


def _imported(name, globals=None, locals=None, fromlist=(), level=0):
    importer = (globals or {}).get("__name__", "")
    if not importer.startswith("normalbench."):
        return _import(name, globals, locals, fromlist, level)
    if level == 0 and name in GONE:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    module = _import(name, globals, locals, fromlist, level)
    if level == 0 and name == "sys" and importer.startswith(ROOM):
        return _sys
    return _seen.get(name, module) if level == 0 else module


def _hide():
    added = _of_windows() if TOLD["system"] == "win32" else {}
    for name in {*TOLD["lacking"], *added}:
        real = __import__(name, fromlist=["*"])
        _seen[name] = Seen(real, set(TOLD["lacking"].get(name, ())), added.get(name, {}))


_hide()
_sys = Seen(sys, set(), {"platform": TOLD["system"]})
builtins.__import__ = _imported
# Text that is read or written by whatever encoding the system has.
warnings.filterwarnings("ignore", category=EncodingWarning)
warnings.filterwarnings("error", category=EncodingWarning, module=r"normalbench\.")
