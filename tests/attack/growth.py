"""How time and memory grow with the size of a file.

    python tests/attack/growth.py [KIND,...]

Each reader reads files of four sizes, each ten times the size before, in a process of its own. The output is seconds
of processor time and MiB beyond those of the smallest file, and the exponents of both from each size to the next: 1
is linear. Exit status: 1 if the last exponent of either is above 1.05.
"""

from __future__ import annotations

import json
import math
import re
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:1] = [str(HERE.parent), str(HERE.parent / "inputs")]

import numpy as np  # noqa: E402 # the folders above hold what follows
from written import ply, png_bytes, write_exr, write_image  # noqa: E402

from normalbench.bench.door.gates.baseline import read_baseline  # noqa: E402
from normalbench.bench.keep.runs import read_run  # noqa: E402
from normalbench.bench.keep.schema import SCHEMA  # noqa: E402
from normalbench.bench.subjects.normals.captures import Reading, capture  # noqa: E402
from normalbench.gbuffer.gl.shader import Source  # noqa: E402
from normalbench.gbuffer.layouts.layout import read_layout  # noqa: E402
from normalbench.gbuffer.layouts.words import LayoutError  # noqa: E402
from normalbench.gbuffer.scenes.files.read import read_mesh_file  # noqa: E402

MOST = 1.05
# Below these a size takes too little to tell its growth.
LEAST_S, LEAST_MIB = 0.2, 8.0


def normals(count: int, dtype: type = np.float32) -> np.ndarray:
    """Return an image of one row, the shape that is hardest for a reader."""
    n = np.random.default_rng(0).normal(size=(1, count, 3))
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    if np.issubdtype(dtype, np.integer):
        return np.round((n * 0.5 + 0.5) * np.iinfo(dtype).max).astype(dtype)
    return n.astype(dtype)


def square(count: int, dtype: type) -> np.ndarray:
    side = math.isqrt(count)
    return normals(side * side, dtype).reshape(side, side, 3)


def exr(path: Path, count: int) -> None:
    planes = np.moveaxis(square(count, np.float32), -1, 0)
    write_exr(path, dict(zip(("N.X", "N.Y", "N.Z"), planes, strict=True)))


def grid(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices and faces of a hilly square of about `count` triangles."""
    side = max(math.isqrt(count // 2), 1)
    u, v = np.meshgrid(*[np.linspace(-1, 1, side + 1)] * 2)
    first = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    quads = np.stack([first, first + 1, first + side + 2, first, first + side + 2, first + side + 1], axis=1)
    return np.stack([u, v, 0.2 * np.sin(3 * u + v)], axis=-1).reshape(-1, 3), quads.reshape(-1, 3)


def obj(path: Path, count: int) -> None:
    vertices, faces = grid(count)
    with path.open("w") as file:
        np.savetxt(file, vertices, "v %.5f %.5f %.5f")
        np.savetxt(file, faces + 1, "f %d %d %d")


def text_ply(path: Path, count: int) -> None:
    vertices, faces = grid(count)
    path.write_bytes(ply("ascii", faces.tolist(), vertices.astype(np.float32), vertices.astype(np.float32)))


def rows(path: Path, count: int) -> None:
    path.mkdir()
    (path / "run.json").write_text(json.dumps({"schema": SCHEMA}))
    row = {"encoding": "octahedral", "storage": "rg8", "psnr_db": 47.5, "angle_mean_deg": 0.3, "count": 65536}
    line = json.dumps({"table": "quality", "key": {"encoding": "octahedral"}, "rows": [row] * 10})
    (path / "rows.jsonl").write_text(f"{line}\n" * (count // 10))


def baseline(path: Path, count: int) -> None:
    entries = [{"table": "quality", "key": {"seed": seed}, "row": {"psnr_db": 1.5}} for seed in range(count)]
    path.write_text(json.dumps(entries))


def gates(path: Path, count: int) -> None:
    path.write_text('[[gate]]\nencoding = "xyz"\npsnr_db = "at least 1"\n' * min(count, 1000))


def shader(path: Path, count: int) -> None:
    path.write_text("#version 430\n" + "float f(float x) { return x; } // a line\n" * count)


def layout(path: Path, count: int) -> None:
    targets = '[[targets]]\nformat = "rgba8"\nholds = "normal.x:11 normal.y:11 power:10"\n' * count
    path.write_text(f'encoding = "octahedral"\n{targets}')


def read_refused_layout(path: Path) -> None:
    try:
        read_layout(path)
    except LayoutError:
        return


def read_capture(path: Path) -> None:
    capture(path, Reading(normalise=True))


Write, Read = Callable[[Path, int], object], Callable[[Path], object]
# By kind: the file's ending, its smallest size, how it is written and read.
READERS: dict[str, tuple[str, int, Write, Read]] = {
    "png row": (".png", 1000, lambda p, n: p.write_bytes(png_bytes(normals(n, np.uint16))), read_capture),
    "png": (".png", 30_000, lambda p, n: p.write_bytes(png_bytes(square(n, np.uint8))), read_capture),
    "npy row": (".npy", 30_000, lambda p, n: np.save(p, normals(n)), read_capture),
    "exr": (".exr", 30_000, exr, read_capture),
    "tiff": (".tif", 30_000, lambda p, n: write_image(p, square(n, np.uint16)), read_capture),
    "obj": (".obj", 1000, obj, read_mesh_file),
    "ply": (".ply", 1000, text_ply, read_mesh_file),
    "rows": ("", 1000, rows, read_run),
    "baseline": (".json", 100, baseline, read_baseline),
    "shader": (".glsl", 100, shader, Source),
    "layout": (".toml", 10, layout, read_refused_layout),
}
TIMES = 4
# The least of these is what the reading takes; the rest is what else the machine does.
TURNS = 3


def measured(kind: str, path: Path) -> tuple[float, float]:
    """Return the seconds and MiB that reading a file takes in a process of its own."""
    command = [sys.executable, __file__, "--read", kind, str(path)]
    readings = [json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout) for _ in range(TURNS)]
    seconds, mebibytes = map(min, zip(*readings, strict=True))
    return seconds, mebibytes


def read_alone(kind: str, path: Path) -> None:
    read = READERS[kind][3]
    # The peak of what follows: a process inherits that of who started it.
    Path("/proc/self/clear_refs").write_text("5")
    began = time.process_time()
    read(path)
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    peak = re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())
    seconds = time.process_time() - began + children.ru_utime + children.ru_stime
    print(json.dumps([seconds, (int(peak[1]) + children.ru_maxrss) / 1024 if peak else 0.0]))


def exponent(small: float, large: float, least: float) -> float:
    """Return the exponent of a quantity that grew while the size grew tenfold; 0 if it is too small to tell."""
    return math.log10(large / max(small, least)) if large > least else 0.0


def grown(kind: str, folder: Path) -> bool:
    """Print how a reader grows; return whether it grows too fast."""
    ending, smallest, write, _ = READERS[kind]
    readings: list[tuple[float, float]] = []
    for power in range(TIMES):
        path = folder / f"{kind.replace(' ', '-')}-{power}{ending}"
        write(path, smallest * 10**power)
        readings.append(measured(kind, path))
        if path.is_file():
            path.unlink()
    base = readings[0]
    times, memory = ([max(reading[i] - base[i], 0.0) for reading in readings] for i in (0, 1))
    exponents = [
        [exponent(a, b, least) for a, b in pairwise(values)]
        for values, least in ((times, LEAST_S), (memory, LEAST_MIB))
    ]
    shown = ["  ".join(f"{value:7.2f}" for value in values) for values in (times, memory, *exponents)]
    print(f"{kind:9} s {shown[0]}   MiB {shown[1]}   exponents {shown[2]} |{shown[3]}", flush=True)
    return max(series[-1] for series in exponents) > MOST


def main() -> int:
    """Measure the readers and return the exit status."""
    if sys.argv[1:2] == ["--read"]:
        read_alone(sys.argv[2], Path(sys.argv[3]))
        return 0
    kinds = sys.argv[1].split(",") if sys.argv[1:] else list(READERS)
    with tempfile.TemporaryDirectory() as folder:
        return int(sum([grown(kind, Path(folder)) for kind in kinds]) > 0)


if __name__ == "__main__":
    sys.exit(main())
