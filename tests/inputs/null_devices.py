"""What a process finds that is told of a GPU that is not there."""

import json
import os
import subprocess
import sys

# errno of each try, 0 where it works, and the driver's version.
TRIES = """
import fcntl, json, os
def tried(what):
    try:
        what()
    except OSError as error:
        return error.errno
    return 0
zero, null = os.open("/dev/zero", os.O_RDWR), os.open("/dev/null", os.O_RDWR)
version = bytearray(64)
print(json.dumps([
    tried(lambda: fcntl.ioctl(zero, 0xC0406400, version)),
    tried(lambda: fcntl.ioctl(null, 0xC0406400, bytearray(64))),
    tried(lambda: os.open("/dev/dri/renderD128", os.O_RDWR)),
    list(version[:12:4]),
]))
"""
NO_DEVICE = 19  # ENODEV


def tried(told: dict[str, str]) -> list:
    """What TRIES finds in a process with these variables."""
    asked = [sys.executable, "-c", TRIES]
    done = subprocess.run(asked, capture_output=True, text=True, env=os.environ | told, check=True)
    return json.loads(done.stdout)
