"""Virtual screens, for programs that do not draw without a screen."""

import os
import subprocess
from contextlib import contextmanager


@contextmanager
def screen():
    """Yield the DISPLAY name of a new screen; Xvfb takes a free number."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x1024x24"]
    with subprocess.Popen(command, pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        yield f":{number}"
        server.terminate()
