"""Count the engine shader files that are read unchanged: `python -m tests.real_files FOLDER` prints a line per file.

A file is measured in RG16, or in RGBA16 if its code has three numbers, on 2^16 directions of the sphere. Its mean
angle is compared with those of the catalogue's encodings, which other tests compare with float64: CODE is an encoding
whose mean is within 1%. Files without a shader's extension are ignored.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from normalbench.bench.ground.user_files import ENDINGS

SETTING = ("--storage", "rg16,rgba16", "--normals", "sphere", "--backend", "glsl", "--count", "65536")
WITHIN, SECONDS = 0.01, 200


def rows_of(encoding: str) -> tuple[list[Mapping[str, Any]], str]:
    """Return the rows of an encoding, none if it is refused, and the last line that was printed to stderr."""
    command = [sys.executable, "-m", "normalbench", "quality", "--encoding", encoding, *SETTING, "--format", "json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return [], f"it did not end within {SECONDS} s"
    lines = done.stderr.strip().splitlines()
    return json.loads(done.stdout) if done.returncode == 0 else [], lines[-1] if lines else ""


def known_means() -> dict[tuple[str, str], float]:
    """Return the mean angles of the catalogue by encoding and storage."""
    rows, message = rows_of("all")
    assert rows, message
    return {(row["encoding"], row["storage"]): row["angle_mean_deg"] for row in rows if row["angle_mean_deg"]}


def like(row: Mapping[str, Any], known: Mapping[tuple[str, str], float]) -> str:
    """Return the catalogue's encoding with the same mean in the same storage; an empty text if none matches."""
    mean = row["angle_mean_deg"] or 0.0
    apart = {name: abs(mean / angle - 1) for (name, storage), angle in known.items() if storage == row["storage"]}
    far, name = min(((far, name) for name, far in apart.items()), default=(WITHIN, ""))
    return name if far < WITHIN else ""


def main(folder: Path) -> None:
    """Print a line for each file, with its figures or the reason for its refusal, and the count of measured files."""
    known, measured = known_means(), 0
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in ENDINGS)
    for path in files:
        rows, message = rows_of(str(path))
        if not rows:
            print(f"{path.name}: refused: {message.replace(f'{folder}/', '')}", flush=True)
            continue
        measured += 1
        row = rows[0]
        figures = f"mean {row['angle_mean_deg']:.6g} degrees, largest {row['angle_max_deg']:.6g}"
        code = like(row, known)
        print(f"{path.name}: {row['storage']}: {figures}{f', as {code}' if code else ''}", flush=True)
    print(f"{measured} of {len(files)} are measured")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
