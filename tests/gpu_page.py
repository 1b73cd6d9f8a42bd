"""The manual's page of a GPU: `python -m tests.gpu_page` writes it from the rows in `docs/measured`."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from normalbench.encodings.catalogue import ENCODINGS

DOCS = Path(__file__).parents[1] / "docs"
PAGE, ROWS = DOCS / "gpu.md", DOCS / "measured" / "nvidia.json"
CODECS = (
    "xyz_renormalised",
    "xyz_largest",
    "xy_sign",
    "spherical",
    "spheremap",
    "stereographic",
    "octahedral",
    "signed_octahedral",
    "equal_area_octahedral",
    "spherical_fibonacci",
    "octahedral_precise",
)
PAGE_TEXT = """# On a GPU

What does a GPU do otherwise than the software rasteriser that this manual's figures are from?

Measured on {measured} on an NVIDIA H100 and an H200, driver 580.159, OpenGL 4.3 through EGL, on Linux. The rows with
their device are in [`measured/nvidia.json`](measured/nvidia.json).

## What is stored

{stores}

Direct3D says so for all hardware: floats are rounded toward zero to a smaller float, and a number may become any whole
number of UNORM or SNORM within 0.6 ([data conversion rules][rules]). If each fraction from 0.5 to 0.56 went down, the
mean squared error of UNORM would be 4 % larger, which is 0.2 dB. A code in half floats loses 6 dB: its figures for
Direct3D are those of `--rounding truncate`, unless the shader rounds it first.

What this program measures does not depend on it. Where a device does not round as asked, the shader rounds before it
writes. {agree}

Between the ends of a BC5 block in ascending order an H200 goes 0.3735 and 0.6265 of the way, where the specification
says 2/5 and 3/5: up to 7 of 255 off. `normalbench maps` decodes by the specification.

Quotients, roots and sines are not rounded to nearest: about two codes in a thousand are the next one. Direct3D takes a
number below 2^-126 for 0, and so does this GPU: `normalize(n.xy + 1e-20)` is infinite at the pole, and
[`doctor`](bring-your-own.md) says so.

## What a code costs

Nanoseconds a megapixel on the H100, less an empty shader (`normalbench cost --time`). Only 4 of its 132 multiprocessors
run fragment shaders (NVIDIA H100 whitepaper, 2022), so compare codes with each other:

{cost}

## What a frame costs

Milliseconds of a frame of 1024 x 768 pixels with 64 lights and shadows on the H100 (`normalbench sweep`):

{frames}

Read how a pipeline grows, and do not rank pipelines by it. Each keeps a layout of its own, and the shader rounds each
target, which an engine leaves to the target. Few multiprocessors draw behind the whole bandwidth of the chip.

## What half arithmetic costs

RMS angle in degrees over the sphere where the encoder and the decoder compute in 16 bits ([half](half.md)): by
emulation, which rounds every step, and on the GPU, which keeps more digits of some steps and takes its own roots and
quotients. Codes for the whole sphere:

{half}

## When a GPU is lost

A driver may lose its GPU and go on without a word; what OpenGL gives back then is anything. After each step this
program clears a texel to a random colour and reads it back. If that fails, the command ends with one line, and the
step's rows are not kept.

[rules]: https://learn.microsoft.com/en-us/windows/win32/direct3d10/d3d10-graphics-programming-guide-resources-data-conversion
"""


def text() -> str:
    """The whole page."""
    rows = json.loads(ROWS.read_text(encoding="utf-8"))
    parts = {name: part(rows) for name, part in PARTS.items()}
    return PAGE_TEXT.format(measured=rows["measured"], **parts)


def _table(head: Sequence[str], lines: Iterable[Sequence[Any]]) -> str:
    every = [head, ["---"] + ["---:"] * (len(head) - 1), *lines]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in every)


def _stores(rows: dict[str, Any]) -> str:
    rounds = {name.split()[-1]: said for name, said in rows["machine"].items() if name.startswith("GL rounds")}
    cut = [name for name, said in rounds.items() if said.startswith("truncate")]
    assert cut == ["rg16f", "rgba16f", "r11g11b10f"] and rounds["rgba8"].startswith("neither"), rounds
    probed = {row["format"]: row for row in rows["stores"]}
    down = max(row.get("fraction_that_went_down", 0.0) for row in probed.values())
    share = max(row.get("one_lower", 0) / row["numbers"] for row in probed.values() if "numbers" in row)
    assert probed["depth16"]["ties_up"] < 0.05 and 0.4 < probed["depth24"]["ties_up"] < 0.6
    lines = [
        (
            "UNORM, SNORM",
            f"the nearest whole number, but {100 * share:.0f} % of numbers go to the one below, of a fraction up to "
            f"{down:.2f}",
        ),
        ("half floats, R11G11B10", "cut off"),
        ("depth of 16 bits", "nearest; of two that are as near, the lower one"),
        ("depth of 24 bits", "nearest; of two that are as near, either"),
        ("what comes back of a whole number", "divided by the scale; llvmpipe takes the reciprocal, 2^-23 apart"),
    ]
    return _table(("format", "what an H200 does"), lines).replace("---:", "---")


def _agree(rows: dict[str, Any]) -> str:
    found: dict[tuple[str, ...], dict[str, float]] = {}
    for row in rows["quality"]:
        key = tuple(row[name] for name in ("encoding", "storage", "rounding", "normals"))
        found.setdefault(key, {})[row["backend"]] = row["psnr_db"]
    apart = [abs(by["glsl"] - by["jax"]) for by in found.values() if len(by) == 2]
    bound = math.ceil(1e4 * max(apart)) / 1e4
    by_both = [row for row in rows["whole"] if "psnr_db_by_llvmpipe" in row]
    off = math.ceil(1e2 * max(abs(row["psnr_db"] - row["psnr_db_by_llvmpipe"]) for row in by_both)) / 1e2
    return (
        f"{len(apart)} rows of `quality` by GLSL on the H200 are within {bound:.4f} dB of those by JAX, and\n"
        f"images through {len(by_both)} engines' whole layouts within {off:.2f} dB of the software rasteriser's."
    )


def _cost(rows: dict[str, Any]) -> str:
    found = {(row.get("encoding"), row["operation"]): row for row in rows["cost"]}
    lines = [
        (
            f"`{name}`",
            *(f"{abs(found[name, operation]['ns_per_megapixel']):,.0f}" for operation in ("encode", "decode")),
        )
        for name in CODECS
    ]
    return _table(("encoding", "encode", "decode"), lines)


def _frames(rows: dict[str, Any]) -> str:
    frames = {(row["pipeline"], row["objects"]): row["ms_frame"] for row in rows["sweep"] if row["shadow"]}
    counts = sorted({count for _, count in frames})
    lines = [
        (f"`{name}`", *(f"{frames[name, count]:.1f}" for count in counts))
        for name in ("prepass", "hybrid", "deferred", "inferred", "forward")
    ]
    return _table(("objects", *counts), lines)


def _half(rows: dict[str, Any]) -> str:
    lines = []
    for row in rows["half"]:
        by, on = row["rms_deg_emulated"], row["rms_deg"]
        if ENCODINGS[row["encoding"]].domain == "sphere":
            lines.append(
                (f"`{row['encoding']}/{row['storage']}`", f"{by:.3f}", f"{on:.3f}", f"{100 * (on / by - 1):+.0f} %")
            )
    return _table(("codec", "by emulation", "on an H200", "change"), lines)


PARTS = {"stores": _stores, "agree": _agree, "cost": _cost, "frames": _frames, "half": _half}

if __name__ == "__main__":
    PAGE.write_text(text(), encoding="utf-8")
