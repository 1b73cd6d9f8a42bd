"""Device files for tests. Their figures are real rows of the catalogue, altered: none of these devices was measured.

`real_rows.json` says where its rows come from. An altered device truncates some formats where the emulation rounds,
or computes with half-precision normals, as a GPU with other rounding or precision would.
"""

import json
from pathlib import Path

RECORDED = json.loads((Path(__file__).parent / "real_rows.json").read_text())
NORMALS = RECORDED["normals"]
CHROMIUM = (
    "Mozilla/5.0 (X11; Linux x86_64) AppleWebKit/537.36 (KHTML, like Gecko) HeadlessChrome/156.0.0.0 Safari/537.36"
)
FIREFOX = "Mozilla/5.0 (X11; Linux x86_64; rv:153.0) Gecko/20100101 Firefox/153.0"
SAFARI = "Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/605.1.15 Version/18.1 Safari/605.1.15"
SWIFTSHADER = "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)"
GEFORCE = "ANGLE (NVIDIA, NVIDIA GeForce RTX 4090 (0x00002684) Direct3D11 vs_5_0 ps_5_0, D3D11)"
MALI = "ANGLE (ARM, Mali-G78, OpenGL ES 3.2)"
APPLE = "ANGLE (Apple, ANGLE Metal Renderer: Apple M2, Unspecified Version)"
# Ten altered devices: GPU, browser, the targets that it truncates, whether its arithmetic is of half precision, and how
# many milliseconds it takes for each bit of a code; 0 where it has no clock.
TEN = (
    (SWIFTSHADER, CHROMIUM, (), False, 0.05),
    (GEFORCE, CHROMIUM, (), False, 0.0004),
    (GEFORCE, FIREFOX, (), False, 0.0),
    (APPLE, SAFARI, ("RG16F",), False, 0.001),
    (MALI, CHROMIUM, ("RGB10_A2",), False, 0.01),
    ("Adreno (TM) 740", CHROMIUM, ("RG16F", "RGB10_A2"), False, 0.008),
    ("PowerVR Rogue GE8320", CHROMIUM, (), True, 0.03),
    ("ANGLE (Intel, Mesa Intel(R) UHD Graphics 620 (KBL GT2), OpenGL 4.6)", FIREFOX, (), False, 0.006),
    ("AMD Radeon RX 6600 (radeonsi, navi23, LLVM 15.0.7, DRM 3.49, 6.1.0)", FIREFOX, (), False, 0.0007),
    ("Apple GPU", SAFARI, ("RG16F",), False, 0.0),
)


def codec_rows(truncated=(), half=False, ms_per_bit=0.05) -> list[dict]:
    """Return real rows, with the rows of some targets truncated or all rows in half precision."""
    return [
        _row(row, "mediump" if half else "truncates" if row["target"] in truncated else "run", ms_per_bit)
        for row in RECORDED["rows"]
    ]


def _row(row: dict, how: str, ms_per_bit: float) -> dict:
    figures = row.get(how, row["run"])
    same = {"equal": NORMALS, "one_step": 0, "further": 0}
    about = {name: row[name] for name in ("encoding", "storage", "target")} | {
        "rounding": "nearest",
        "normals": NORMALS,
    }
    time = len(row["encoding"]) * row["bits"] * ms_per_bit / 10
    times = {"encode_ms": round(time, 4) or None, "decode_ms": round(time * 0.8, 4) or None}
    timer = {"timer": "EXT_disjoint_timer_query_webgl2" if ms_per_bit else None}
    return about | same | figures | {"run_mean_deg": row["run"]["mean_deg"]} | times | timer


def content(renderer=SWIFTSHADER, browser=CHROMIUM, truncated=(), half=False, ms_per_bit=0.05, **more) -> dict:
    """Return the content of a device file."""
    about = {"normalbench_device": 1, "renderer": renderer, "vendor": "a vendor", "browser": browser}
    about |= {"made": "2026-11-23T15:00:00Z", "program": "0.1.0", "sources": "0123456789abcdef"}
    facts = {"rounds RGB10_A2": "down" if "RGB10_A2" in truncated else "nearest", "filters RG16F": "yes"}
    facts |= {"highp mantissa bits": 23, "mediump mantissa bits": 10 if half else 23}
    return about | {"codecs": codec_rows(truncated, half, ms_per_bit), "facts": facts} | more


def write(path: Path, **more) -> Path:
    """Write a device file; see `content`."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content(**more)), encoding="utf-8")
    return path


def write_ten(folder: Path) -> list[Path]:
    """Write the ten altered devices."""
    names = ("renderer", "browser", "truncated", "half", "ms_per_bit")
    return [write(folder / f"{i}.json", **dict(zip(names, device, strict=True))) for i, device in enumerate(TEN)]
