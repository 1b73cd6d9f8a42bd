"""How many shader files of engines are read as they lie: `python -m tests.real_files FOLDER` prints a line for each.

A file is measured in RG16, or in RGBA16 if its code has three numbers, on 2^16 directions of the sphere. Its mean angle
is compared with those of the catalogue's encodings, which other tests hold to float64: CODE is one whose mean it has
within 1 %. Files whose names end as no shader's does are passed over.
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
    """The rows of an encoding, none where it is refused; and the last line of what was said."""
    command = [sys.executable, "-m", "normalbench", "quality", "--encoding", encoding, *SETTING, "--format", "json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return [], f"it did not end within {SECONDS} s"
    said = done.stderr.strip().splitlines()
    return json.loads(done.stdout) if done.returncode == 0 else [], said[-1] if said else ""


def known_means() -> dict[tuple[str, str], float]:
    """By encoding and storage, the mean angles of the catalogue."""
    rows, said = rows_of("all")
    assert rows, said
    return {(row["encoding"], row["storage"]): row["angle_mean_deg"] for row in rows if row["angle_mean_deg"]}


def like(row: Mapping[str, Any], known: Mapping[tuple[str, str], float]) -> str:
    """The encoding of the catalogue that has the same mean in the same storage; empty where none has."""
    mean = row["angle_mean_deg"] or 0.0
    found = {name: abs(mean / one - 1) for (name, storage), one in known.items() if storage == row["storage"]}
    far, name = min(((far, name) for name, far in found.items()), default=(WITHIN, ""))
    return name if far < WITHIN else ""


def main(folder: Path) -> None:
    """Print a line for each file: measured with its figures, or refused and why; and how many were measured."""
    known, measured = known_means(), 0
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in ENDINGS)
    for path in files:
        rows, said = rows_of(str(path))
        if not rows:
            print(f"{path.name}: refused: {said.replace(f'{folder}/', '')}", flush=True)
            continue
        measured += 1
        row = rows[0]
        figures = f"mean {row['angle_mean_deg']:.6g} degrees, largest {row['angle_max_deg']:.6g}"
        code = like(row, known)
        print(f"{path.name}: {row['storage']}: {figures}{f', as {code}' if code else ''}", flush=True)
    print(f"{measured} of {len(files)} are measured")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
