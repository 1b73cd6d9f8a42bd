"""normalbench in Python: every table as a function, and codecs for arrays.

    import normalbench as nb

    nb.quality(encoding="octahedral", storage=["rg8", "rgb10a2"])   # a pandas DataFrame
    nb.encode("octahedral/rg8", normals)                            # the codes, as numbers and as integers
    nb.decode("octahedral/rg8", codes)                              # the decoded normals
    nb.pack("granite", surface)                                     # the contents of a layout's targets
    nb.unpack("granite", targets)                                   # the unpacked surfaces

Each table of the command line is a function with the same name and options; `help(nb.quality)` lists the options.
Heavy modules are imported only when they are needed.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

# In an editable install this file lies in bench/door/api, and the rooms of the package are those of the checkout.
_ROOT = Path(__file__).parents[3]
if Path(__file__).parent == _ROOT / "bench" / "door" / "api":
    __path__.append(str(_ROOT))

_HOMES = {
    "encode": ".bench.door.python.codecs",
    "decode": ".bench.door.python.codecs",
    "encoding": ".bench.door.python.codecs",
    "pack": ".bench.door.python.layouts",
    "unpack": ".bench.door.python.layouts",
    "Codes": ".bench.door.python.codecs",
    "Encoding": ".encodings.codecs.encoding",
    "Storage": ".encodings.storages.storage",
    "Codec": ".encodings.codecs.codec",
}


def _tables() -> Any:
    return import_module(".bench.tables.registry", __name__).TABLES


def __getattr__(name: str) -> Any:
    if name in _HOMES or (not name.startswith("_") and name in _tables()):
        import_module(".bench.ground.machine.system", __name__).prepare()
    if name in _HOMES:
        return getattr(import_module(_HOMES[name], __name__), name)
    if not name.startswith("_") and name in _tables():
        return import_module(".bench.door.python.tables", __name__).function_of(name)
    raise AttributeError(f"normalbench has no {name!r}; available: {', '.join(__dir__())}")


def __dir__() -> list[str]:
    return sorted([*_HOMES, *_tables()])
