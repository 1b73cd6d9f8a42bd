"""Python with NumPy: the file is imported from its path."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import numpy as np

from .....gbuffer.gl.shader import ShaderError
from .interface import FUNCTIONS, Interface, Ran, Run, Runner


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file as a module that nothing else can import. Raises ShaderError where it raises or lacks a function."""
    module = _imported(path)
    try:
        six = {name: getattr(module, f"{interface.prefix}_{name}") for name in FUNCTIONS}
    except AttributeError as error:
        raise ShaderError(f"{path}: {error}") from error

    def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
        rays = (view,) if interface.takes_view else ()
        code = six["encode"](n, *rays)
        sign = (code[..., -1],) if interface.sign_bits else ()
        words = six["pack"](code)
        unpacked = six["unpack"](words, *sign)
        decoded, back = six["decode"](unpacked, *rays), six["from_target"](texels, *sign)
        return Ran(code, words.reshape(len(n), interface.words), unpacked, decoded, six["to_target"](code), back)

    yield run


def _imported(path: Path) -> Any:
    spec = spec_from_file_location("normalbench_code", path)
    if not spec or not spec.loader:
        raise ShaderError(f"{path}: it is not a file of Python")
    module = module_from_spec(spec)
    # No folder of bytecode next to a user's file.
    kept, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # whatever the file raises
        raise ShaderError(f"{path}: {type(error).__name__}: {error}") from error
    finally:
        sys.dont_write_bytecode = kept
    return module


def how() -> str:
    """Python and NumPy."""
    return f"Python {platform.python_version()}, NumPy {np.__version__}"


RUNNER = Runner(prepared, how)
