"""What setuptools builds lies in a folder that goes with the build: nothing is left in a checkout."""

import atexit
from tempfile import TemporaryDirectory

from setuptools import setup

folder = TemporaryDirectory(prefix="normalbench-build-")
atexit.register(folder.cleanup)
setup(options={"build": {"build_base": folder.name}, "egg_info": {"egg_base": folder.name}})
