"""The manual's GPU page, which `python -m tests.gpu_page` writes from the rows in `docs/measured`."""

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

How do real GPUs differ from the figures of this manual?

Two NVIDIA GPUs, an H100 and an H200 (driver 580.159, OpenGL 4.3 through EGL, Linux), were compared on {measured} with
the software rasteriser on which this manual's figures were measured. The rows are in
[`measured/nvidia.json`](measured/nvidia.json).

## Rounding

{stores}

Direct3D specifies this for all hardware: conversion to a smaller float rounds toward zero, and conversion to UNORM or
SNORM may give any integer within 0.6 ([data conversion rules][rules]). If every fraction from 0.5 to 0.56 were rounded
down, the mean squared error of UNORM would be 4% larger, which is 0.2 dB. Half floats lose 6 dB, so use
`--rounding truncate` for Direct3D, unless your shader rounds first.

The figures of this program do not depend on the device: if it does not round as requested, the shader rounds first.
{agree}

Quotients, roots and sines are not rounded to nearest, so about two codes in a thousand differ by one step. Direct3D and
this GPU treat numbers below 2^-126 as 0, so `normalize(n.xy + 1e-20)` is infinite at the pole.

## Encoding and decoding times

The table shows nanoseconds per megapixel on the H100, minus the time of an empty shader (`normalbench cost --time`).
Only 4 of the GPU's 132 multiprocessors run fragment shaders (NVIDIA H100 whitepaper, 2022), so the times only rank
encodings:

{cost}

## Frame times

The table shows milliseconds per frame of 1024 x 768 pixels, with 64 lights and shadows, on the H100
(`normalbench sweep`):

{frames}

Compare how the time of each pipeline grows, but do not rank pipelines: their layouts differ, and the shader rounds each
target.

## Half arithmetic

The table shows the RMS angle in degrees over the sphere if the encoder and the decoder compute in 16 bits
([half](half.md)). Emulation rounds every step. The GPU keeps more digits in some steps. All encodings are of the whole
sphere:

{half}

## Lost GPUs

A driver may lose its GPU silently and return arbitrary values. After each step this program reads back a texel of a
random colour. If the colour is wrong, the command ends with one line and discards the step's rows.

[rules]: https://learn.microsoft.com/en-us/windows/win32/direct3d10/d3d10-graphics-programming-guide-resources-data-conversion
"""


def text() -> str:
    """Return the text of the whole page."""
    rows = json.loads(ROWS.read_text(encoding="utf-8"))
    parts = {name: part(rows) for name, part in PARTS.items()}
    return PAGE_TEXT.format(measured=rows["measured"], **parts)


def _table(head: Sequence[str], lines: Iterable[Sequence[Any]]) -> str:
    every = [head, ["---"] + ["---:"] * (len(head) - 1), *lines]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in every)


def _stores(rows: dict[str, Any]) -> str:
    rounds = {name.split()[-1]: rounding for name, rounding in rows["machine"].items() if name.startswith("GL rounds")}
    cut = [name for name, rounding in rounds.items() if rounding.startswith("truncate")]
    assert cut == ["rg16f", "rgba16f", "r11g11b10f"] and rounds["rgba8"].startswith("neither"), rounds
    probed = {row["format"]: row for row in rows["stores"]}
    down = max(row.get("fraction_that_went_down", 0.0) for row in probed.values())
    share = max(row.get("one_lower", 0) / row["numbers"] for row in probed.values() if "numbers" in row)
    assert probed["depth16"]["ties_up"] < 0.05 and 0.4 < probed["depth24"]["ties_up"] < 0.6
    lines = [
        (
            "UNORM, SNORM",
            f"nearest, but {100 * share:.0f}% of numbers round down although their fraction is 0.50 to {down:.2f}",
        ),
        ("half floats, R11G11B10F", "truncated"),
        ("16-bit depth", "nearest; ties round down"),
        ("24-bit depth", "nearest; ties round either way"),
        ("integers that are read", "divided by the scale; llvmpipe multiplies by the reciprocal, 2^-23 apart"),
    ]
    return _table(("format", "rounding on an H200"), lines).replace("---:", "---")


def _agree(rows: dict[str, Any]) -> str:
    figures: dict[tuple[str, ...], dict[str, float]] = {}
    for row in rows["quality"]:
        key = tuple(row[name] for name in ("encoding", "storage", "rounding", "normals"))
        figures.setdefault(key, {})[row["backend"]] = row["psnr_db"]
    apart = [abs(by["glsl"] - by["jax"]) for by in figures.values() if len(by) == 2]
    bound = math.ceil(1e4 * max(apart)) / 1e4
    by_both = [row for row in rows["whole"] if "psnr_db_by_llvmpipe" in row]
    off = math.ceil(1e2 * max(abs(row["psnr_db"] - row["psnr_db_by_llvmpipe"]) for row in by_both)) / 1e2
    return (
        f"On the H200, {len(apart)} GLSL rows of `quality` are within {bound:.4f} dB of the JAX rows. Images with\n"
        f"the whole layouts of {len(by_both)} engines are within {off:.2f} dB of the software rasteriser's images."
    )


def _cost(rows: dict[str, Any]) -> str:
    costs = {(row.get("encoding"), row["operation"]): row for row in rows["cost"]}
    lines = [
        (
            f"`{name}`",
            *(f"{abs(costs[name, operation]['ns_per_megapixel']):,.0f}" for operation in ("encode", "decode")),
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
