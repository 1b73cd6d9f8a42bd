"""A Python that lacks what Windows lacks, as far as another system can show it."""

import subprocess
import sys

# Modules and names that CPython has on POSIX systems alone.
WITHOUT = """
import os, signal, sys
class Missing:
    def find_spec(self, name, path=None, target=None):
        if name in ("fcntl", "resource", "pwd", "grp", "termios"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Missing())
for name in ("fcntl", "resource", "pwd", "grp", "termios"):
    sys.modules.pop(name, None)
for name in ("SIGALRM", "SIGKILL", "SIGHUP", "SIGCHLD", "SIGQUIT", "setitimer", "alarm", "pthread_kill"):
    delattr(signal, name)
for name in ("fork", "killpg", "setsid", "geteuid", "getuid", "setpgid"):
    delattr(os, name)
sys.platform = "win32"
"""


def on_windows(code: str) -> subprocess.CompletedProcess[str]:
    """What a program does there."""
    return subprocess.run([sys.executable, "-c", WITHOUT + code], capture_output=True, text=True)
