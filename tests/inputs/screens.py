"""Screens, for programs that do not draw without one."""

import os
import subprocess
from contextlib import contextmanager


@contextmanager
def screen():
    """A screen of its own, by the name that DISPLAY has: Xvfb takes a number that is free."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x1024x24"]
    with subprocess.Popen(command, pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as said:
            number = said.readline().strip()
        yield f":{number}"
        server.terminate()
