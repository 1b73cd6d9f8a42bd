"""GLSL of OpenGL ES: compiled and run by an OpenGL ES 3.1 context, in a process of its own next to the desktop's."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import numpy as np

from .....gbuffer.gl.shader import ShaderError
from ....ground.machine import children
from ....ground.machine.systems.people import how_to_install
from ....ground.output.errors import MissingError
from .interface import Interface, Ran, Run, Runner, ran_of, rows_of
from .sources import SECONDS, EmittedSource, folder

WRAPPER = Path(__file__).with_suffix(".comp")
CHILD = "normalbench.bench.shaders.code.run.gles"
# The statuses that the process ends with where there is no context, and where the shader does not compile.
NO_CONTEXT, REFUSED = 3, 4
INSTALL = f"install a driver ({how_to_install('libegl1 libgles2 libgl1-mesa-dri')})"


@contextmanager
def prepared(path: Path, interface: Interface) -> Iterator[Run]:
    """The file, which every call compiles anew in a process of its own. Raises MissingError, ShaderError."""
    source = EmittedSource(WRAPPER, path, interface)
    with folder() as place:
        (place / "code.comp").write_text(source.text, encoding="utf-8", newline="\n")
        for name, table in interface.tables.items():
            np.save(place / f"{name}.table.npy", _rgba_table(table))

        def run(n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
            if not len(n):
                return ran_of(np.zeros((0, 4), np.float32), np.zeros((0, 4), np.uint32), interface)
            np.save(place / "given.npy", rows_of(n, view, texels))
            _finished(place, source)
            return ran_of(np.load(place / "made.npy"), np.load(place / "words.npy"), interface)

        yield run


def _rgba_table(table: np.ndarray) -> np.ndarray:
    height, width, channels = table.shape
    return np.concatenate([table, np.zeros((height, width, 4 - channels))], axis=2, dtype=np.float32)


def _finished(place: Path, source: EmittedSource | None) -> str:
    """What the process prints. Raises MissingError, ShaderError."""
    done = children.finished(children.python(CHILD, str(place)), SECONDS)
    said = (done.stderr.strip().splitlines() or [f"it ended with status {done.returncode}"])[-1]
    if done.returncode == NO_CONTEXT:
        raise MissingError(f"no OpenGL ES 3.1 context: {said}; {INSTALL}")
    if done.returncode:
        raise ShaderError(source.explain(said) if source and done.returncode == REFUSED else f"OpenGL ES: {said}")
    return done.stdout


@cache
def how() -> str:
    """The context's renderer and version. Raises MissingError."""
    with folder() as place:
        said = json.loads(_finished(place, None))
    return f"{said['renderer'].split(' (')[0]} ({said['version'].split(' Mesa')[0]})"


RUNNER = Runner(prepared, how)
