"""The manual's page of a GPU: `python -m tests.gpu_page` writes it from the rows in `docs/measured`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

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
number of UNORM or SNORM within 0.6 ([data conversion rules][rules]). So a code in half floats loses what
`--rounding truncate` says, unless the shader rounds it first.

What this program measures does not depend on it. Where a device does not round as asked, the shader rounds before it
writes. {agree}

Quotients, roots and sines are not rounded to nearest. About two codes in a thousand are the next one. A number below
2^-126 is 0: `normalize(n.xy + 1e-20)` is infinite at the pole on this GPU, and [`doctor`](bring-your-own.md) says so.

## What a code costs

Nanoseconds a megapixel on the H100, less an empty shader (`normalbench cost --time`). Only two of its 66 pairs of
multiprocessors run fragment shaders (NVIDIA H100 whitepaper, 2022), so compare codes with each other:

{cost}

## What a frame costs

Milliseconds of a frame of 1024 x 768 pixels with 64 lights and shadows on the H100 (`normalbench sweep`):

{frames}

## What half arithmetic costs

RMS angle in degrees where the encoder and the decoder compute in 16 bits ([half](half.md)), by emulation, which rounds
every step, and on the GPU, which keeps more digits of some steps and takes its own roots and quotients:

{half}

## How fast JAX is there

{jax}

## When a GPU is lost

A driver may lose its GPU and go on without a word; what it draws then is anything. After each step this program draws a
random colour and reads it back. If that fails, the command ends with one line, and the step's rows are not kept.

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
    lines = [
        ("UNORM, SNORM", "the nearest whole number, but of a fraction up to 0.56 sometimes the lower one"),
        ("half floats, R11G11B10", "cut off"),
        ("depth of 16 bits", "nearest; of two that are as near, the lower one"),
        ("depth of 24 and 32 bits", "nearest"),
        ("what comes back of a whole number", "divided by the scale; llvmpipe takes the reciprocal, 2^-23 apart"),
    ]
    return _table(("format", "what an H200 does"), lines).replace("---:", "---")


def _agree(rows: dict[str, Any]) -> str:
    found: dict[tuple[str, ...], dict[str, float]] = {}
    for row in rows["quality"]:
        key = tuple(row[name] for name in ("encoding", "storage", "rounding", "normals"))
        found.setdefault(key, {})[row["backend"]] = row["psnr_db"]
    apart = [abs(by["glsl"] - by["jax"]) for by in found.values() if len(by) == 2]
    return f"{len(apart)} rows of `quality` by GLSL on the H200 are within {max(apart):.4f} dB of those by JAX."


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
        if on < 1:
            lines.append(
                (f"`{row['encoding']}/{row['storage']}`", f"{by:.3f}", f"{on:.3f}", f"{100 * (on / by - 1):+.0f} %")
            )
    return _table(("codec", "by emulation", "on an H200", "more"), lines)


def _jax(rows: dict[str, Any]) -> str:
    rates = {(row["encoding"], row["operation"]): row["millions_per_second"] for row in rows["jax"]}
    usual = [rate for (name, _), rate in rates.items() if name != "best_fit_searched"]
    return (
        f"The H100 encodes or decodes {min(usual):,.0f} to {max(usual):,.0f} million normals a second\n"
        "(`normalbench cost --jax` with JAX for CUDA): the time is that of reading and writing them. The slowest,\n"
        f"`best_fit_searched`, encodes {rates['best_fit_searched', 'encode']:,.0f} million."
    )


PARTS = {"stores": _stores, "agree": _agree, "cost": _cost, "frames": _frames, "half": _half, "jax": _jax}

if __name__ == "__main__":
    PAGE.write_text(text(), encoding="utf-8")
