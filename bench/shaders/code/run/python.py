"""Python with NumPy: the file is imported from its path, in a process of its own, which limits itself."""

from __future__ import annotations

import platform
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from ....ground.machine import children
from .interface import Interface, Ran, Run, Runner
from .sources import folder, run_apart


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file as a module that nothing else can import. Running it raises ShaderError where it raises or lacks a
    function."""
    with folder() as place:

        def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
            np.savez(place / "given.npz", n=n, view=view, texels=texels)
            places = (",".join(interface.value), ",".join(interface.settings))
            structure = (interface.structure, ",".join(interface.fields))
            facts = (interface.prefix, *places, str(interface.sign_bits), *structure)
            run_apart(path, children.python(f"{__package__}.python_child", str(path.resolve()), str(place), *facts))
            with np.load(place / "made.npz") as made:
                return _run_result(made, interface, len(n))

        yield run


def _run_result(made: np.lib.npyio.NpzFile, interface: Interface, count: int) -> Ran:
    """What the functions gave. What does not depend on its normal, a function gives once."""
    sizes = (interface.size, interface.words, interface.size, interface.result, 4, interface.size)
    given = [_in_rows(made[name], size) for name, size in zip(Ran._fields, sizes, strict=True)]
    return Ran(*(np.broadcast_to(one, (count, size)) for one, size in zip(given, sizes, strict=True)))


def _in_rows(made: np.ndarray, size: int) -> np.ndarray:
    """An array of scalars as rows of one number."""
    return made[..., None] if size == 1 else made


def how() -> str:
    """Python and NumPy."""
    return f"Python {platform.python_version()}, NumPy {np.__version__}"


RUNNER = Runner(prepared, how)
