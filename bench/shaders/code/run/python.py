"""Python with NumPy: the file is imported from its path, in a process of its own, which limits itself."""

from __future__ import annotations

import platform
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .....gbuffer.gl.shader import ShaderError
from ....ground.machine import children
from .interface import Interface, Ran, Run, Runner
from .sources import SECONDS, folder


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file as a module that nothing else can import. Running it raises ShaderError where it raises or lacks a
    function."""
    with folder() as place:

        def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
            np.savez(place / "given.npz", n=n, view=view, texels=texels)
            facts = (interface.prefix, str(int(interface.takes_view)), str(interface.sign_bits))
            _run(path, children.python(f"{__package__}.python_child", str(path.resolve()), str(place), *facts))
            with np.load(place / "made.npz") as made:
                return _ran(made, interface, len(n))

        yield run


def _run(path: Path, command: list[str]) -> None:
    try:
        done = children.finished(command, SECONDS)
    except subprocess.TimeoutExpired as error:
        raise ShaderError(f"{path}: it did not end within {SECONDS} s") from error
    if done.returncode:
        raise ShaderError(f"{path}: it {children.how_it_ended(done)}")


def _ran(made: np.lib.npyio.NpzFile, interface: Interface, count: int) -> Ran:
    """What the functions gave. What does not depend on its normal, a function gives once."""
    sizes = (interface.size, interface.words, interface.size, 3, 4, interface.size)
    given = [made[name] for name in Ran._fields]
    given[1] = given[1].reshape(*given[1].shape[: given[1].ndim - (interface.words > 1)], interface.words)
    return Ran(*(np.broadcast_to(one, (count, size)) for one, size in zip(given, sizes, strict=True)))


def how() -> str:
    """Python and NumPy."""
    return f"Python {platform.python_version()}, NumPy {np.__version__}"


RUNNER = Runner(prepared, how)
