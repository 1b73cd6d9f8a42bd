"""What setuptools builds lies in a folder that goes with the build: nothing is left in a checkout but, of an editable
install, what editors are told of `import normalbench`."""

import atexit
import sys
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import TemporaryDirectory

from setuptools import setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).parent
API = ROOT / "bench" / "door" / "api"


def stub():
    """Return the functions of all tables with their options, as type checkers and editors read them."""
    # What is imported here is not compiled into a checkout.
    sys.dont_write_bytecode = True
    spec = spec_from_file_location("normalbench", API / "__init__.py", submodule_search_locations=[str(API)])
    package = module_from_spec(spec)
    sys.modules["normalbench"] = package
    spec.loader.exec_module(package)
    return import_module("normalbench.bench.door.python.stub").stub()


class Build(build_py):
    """Write the stub next to the package's first file."""

    def run(self):
        super().run()
        place = API if self.editable_mode else Path(self.build_lib) / "normalbench"
        (place / "__init__.pyi").write_text(stub(), encoding="utf-8", newline="\n")


folder = TemporaryDirectory(prefix="normalbench-build-")
atexit.register(folder.cleanup)
setup(
    options={"build": {"build_base": folder.name}, "egg_info": {"egg_base": folder.name}}, cmdclass={"build_py": Build}
)
