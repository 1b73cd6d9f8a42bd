"""Outputs of tools, kept for all tests, their processes and the next run.

glslang takes 50 ms to start, and tests of an empty cache give it the same few shaders again and again. Its output
follows from the program's file, its options and its input: these are the key.
"""

import base64
import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from normalbench.bench.ground.output.cache import key_of
from normalbench.bench.run.measuring import file_digest

Run = Callable[..., subprocess.CompletedProcess[bytes]]


def kept(run: Run, folder: Path) -> Run:
    """Return a `tools._piped` that keeps results; it takes a command, its input and an output descriptor."""

    def kept_run(command: list[str], given: bytes, *files: int) -> subprocess.CompletedProcess[bytes]:
        tool = shutil.which(command[0])
        if not tool or len(files) > 1:
            return run(command, given, *files)
        path = folder / _key(tool, command[1:], given, files)
        try:
            outputs = {name: base64.b64decode(text) for name, text in json.loads(path.read_text()).items()}
        except (OSError, ValueError):
            done = run(command, given, *files)
            written = os.pread(files[0], os.fstat(files[0]).st_size, 0) if files else b""
            if done.returncode == 0:
                parts = {"out": done.stdout, "err": done.stderr, "written": written}
                write_json(path, {name: base64.b64encode(data).decode() for name, data in parts.items()})
            return done
        if files:
            os.pwrite(files[0], outputs["written"], 0)
        return subprocess.CompletedProcess(command, 0, outputs["out"], outputs["err"])

    return kept_run


def _key(tool: str, words: list[str], given: bytes, files: tuple[int, ...]) -> str:
    named = [word.replace(f"/dev/fd/{file}", "/dev/fd/file") for word in words for file in files or (-1,)]
    return key_of(_fingerprint(tool), json.dumps(named), given)


@cache
def _fingerprint(tool: str) -> str:
    """Return a program's name and its file's digest. If the file is replaced, only the next process notices."""
    return f"{Path(tool).name} {file_digest(Path(tool)).hex()}"


def write_json(path: Path, value: Any) -> None:
    """Write a value as JSON, whole or not at all: threads and processes may write the same file at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, encoding="utf-8", delete=False) as file:
        json.dump(value, file)
    Path(file.name).replace(path)
