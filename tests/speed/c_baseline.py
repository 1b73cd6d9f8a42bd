"""The row of the quality table in C (`row.c`), compiled for this machine if it has a C compiler."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from normalbench.bench.ground.native.library import NONE

SOURCE = Path(__file__).with_name("row.c")
FLAGS = ("-O3", "-march=native", "-ffast-math", "-fopenmp", "-fPIC", "-w")
# Not with -ffast-math: that links a start-up which makes the whole process take small numbers for 0 (GCC bug 55522).
LINK_FLAGS = ("-shared", "-fopenmp", "-lm")
# What of the encodings there is in C, and whether it reads view positions.
ENCODINGS = {"xyz": False, "spheremap": False, "octahedral": False, "spherical": False, "per_pixel_view": True}
BINS = 2**17
COMPILING_S = 60


def missing(name: str) -> str:
    """Return the reason why C has no figures for an encoding, or an empty text if it has."""
    if name not in ENCODINGS:
        return f"{SOURCE.name} has no {name}"
    return "" if shutil.which("cc") else NONE


def work(name: str, function: str, n: np.ndarray, view: np.ndarray) -> Callable[[], np.ndarray]:
    """Return a function that measures an encoding through 8-bit UNORM once, on all cores.

    Args:
        name: one of ENCODINGS.
        function: "row": the sum of the angles, the sum of their squares, and the largest angle, in degrees;
            "reading": the sum of all components.
        n, view: float32 of shape (count, 3).

    Raises:
        OSError, subprocess.SubprocessError: the encoding cannot be compiled.
    """
    call, figures = getattr(_library(name), function), np.zeros(3)
    planes = [np.ascontiguousarray(a.T, np.float32) for a in (n, view)]
    rows = [(ctypes.c_void_p * 3)(*(plane.ctypes.data for plane in each)) for each in planes]
    counts = [np.zeros(BINS, np.int64)] if function == "row" else []
    given = (*rows, ctypes.c_long(len(n)), *(ctypes.c_void_p(a.ctypes.data) for a in (figures, *counts)))

    def run(_kept=(planes, counts)) -> np.ndarray:
        call(*given)
        return figures

    return run


def _library(name: str) -> ctypes.CDLL:
    chosen = (f"-DENCODING={name}", f"-DVIEW={int(ENCODINGS[name])}")
    with TemporaryDirectory() as folder:
        compiled, linked = (str(Path(folder) / f"{name}{ending}") for ending in (".o", ".so"))
        _run("cc", *FLAGS, *chosen, "-c", str(SOURCE), "-o", compiled)
        _run("cc", compiled, "-o", linked, *LINK_FLAGS)
        return ctypes.CDLL(linked)


def _run(*command: str) -> None:
    subprocess.run(command, check=True, capture_output=True, timeout=COMPILING_S)
