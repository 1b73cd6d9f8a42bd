"""`normalbench budget`: comparison with exhaustive search, target rules, minimum precision, a rendered layout."""

import itertools
import json
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from fitting import fit
from languages import require_runner
from test_budget import USUAL, falling, problem

from normalbench.bench.ground.machine.webgpu import adapters
from normalbench.bench.tables.budget import attributes as held
from normalbench.bench.tables.budget.bins import BINS, WEBGPU, WEBGPU_BYTES, webgpu_cost
from normalbench.bench.tables.budget.solve import Rules, fewest_bytes, solved
from normalbench.bench.tables.budget.table import TABLE
from normalbench.gbuffer.layouts.layout import read_layout
from normalbench.reports.sheets import Role


def test_solver_agrees_with_exhaustive_search():
    """Three attributes with codes of several sizes are placed in unequal targets, for 50 random limits and errors."""
    attributes = [
        replace(held.SEEN["normal"], codes=tuple(c for c in held.SEEN["normal"].codes if c.bits[0] in (10, 12, 14))),
        replace(held.SEEN["roughness"], codes=held.SEEN["roughness"].codes[1:4]),
        replace(held.SEEN["metallic"], codes=held.SEEN["metallic"].codes[::2]),
    ]
    bins = [replace(BINS[name], copies=1) for name in ("rgb10a2", "r8", "rg8", "r32_uint_fields")]
    possible = []
    for codes in itertools.product(*(attribute.codes for attribute in attributes)):
        for homes in itertools.product(bins, repeat=len(codes)):
            if fit(codes, homes):
                possible.append((codes, sum(home.bytes for home in set(homes))))
    assert len(possible) > 100
    rng = np.random.default_rng(7)
    for seed in range(50):
        limit = int(rng.integers(3, 11))
        errors = falling(seed, attributes)
        pair = frozenset((rng.choice(attributes[0].codes).key, rng.choice(attributes[1].codes).key))
        beyond = {name: float(rng.uniform(0, 1) * errors[min(pair)][name]) for name in ("class 0", "class 1")}
        asked = replace(problem(Rules(limit, 4), attributes, errors, bins), together={pair: beyond})
        fitting = [codes for codes, size in possible if size <= limit]
        solution = solved(asked)
        if not fitting:
            assert solution is None, (limit, solution)
            continue

        def worst(codes, asked=asked, pair=pair, beyond=beyond):
            more = beyond if pair <= {code.key for code in codes} else dict.fromkeys(beyond, 0.0)
            return max(more[name] + sum(asked.error(code, name) for code in codes) for name in asked.classes)

        best = min(map(worst, fitting))
        assert fewest_bytes(asked) == min(size for _, size in possible)
        # Of those within 0.2 dB the plainest is taken, and what nobody sees is as good as exact.
        assert solution is not None
        assert best <= solution.worst_of(asked.classes) * (1 + 1e-6) <= max(best * 10**0.0202, 1e-6), (limit, seed)


def test_answer_does_not_depend_on_the_order_of_sets():
    """Each process hashes strings differently, but the simplest of equal layouts is the same in all processes."""
    lines = (
        "import test_budget as t",
        "found = t.solved(t.problem(t.USUAL))",
        "print(sorted((p.code.name, p.bin.name, p.copy) for p in found.placed))",
    )
    own = {"PYTHONHASHSEED": "4", "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    asked = [sys.executable, "-c", "; ".join(lines)]
    told = subprocess.run(asked, env={**os.environ, **own}, capture_output=True, text=True, check=True).stdout
    solution = solved(problem(USUAL))
    assert told.strip() == str(sorted((p.code.name, p.bin.name, p.copy) for p in solution.placed))


def test_a_rendered_layout_matches_its_prediction(gl, run, tmp_path):
    """The errors agree within half a decibel, and the written file describes the same layout."""
    folder = tmp_path / "layouts"
    asked = ["--scene", "ramps", "--size", "160x120", "--bytes", "14", "--format", "json", "--layouts", str(folder)]
    status, out, _ = run("budget", *asked)
    (row,) = json.loads(out)
    assert status == 0 and row["skipped"] is None and row["bytes_per_pixel"] <= 14
    for name in ("db", "worst_db"):
        measured = row["psnr_db" if name == "db" else name]
        assert abs(row[f"predicted_{name}"] - measured) < 0.5, f"{name}: {row}"
    layout = read_layout(folder / "budget_14.toml")
    assert layout.bytes_per_pixel == row["bytes_per_pixel"] and gl
    assert row["targets"] == "; ".join(f"{target.format}: {target.holds}" for target in layout.targets)
    # What is no number would make a run unreadable: compare and the page take these columns for figures.
    figures = {column.name: row[column.name] for column in TABLE.columns if column.role is Role.FIGURE}
    assert not {name for name, value in figures.items() if value is not None and not isinstance(value, (int, float))}


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    ("kept", "size", "named"),
    [
        ("normal", 4, {"normal"}),
        ("normal,roughness", 4, {"normal", "roughness"}),
        ("normal,base_color", 8, {"normal", "base_color"}),
    ],
)
def test_attributes_that_are_not_stored_are_exact_and_take_no_bytes(run, kept, size, named):
    """Normal and roughness alone share one 32-bit word, and the rendered error matches the prediction."""
    asked = ("--scene", "studio", "--size", "160x120", "--bytes", str(size), "--format", "json")
    status, out, _ = run("budget", "--hold", kept, *asked)
    (row,) = json.loads(out)
    assert status == 0 and row["bytes_per_pixel"] <= size, row
    assert abs(row["predicted_worst_db"] - row["worst_db"]) < 0.5, row
    words = {"normal", "base_color", "roughness", "metallic", "f0", "ao"}
    assert {word for word in words if word in row["targets"]} == named, row["targets"]


@pytest.mark.usefixtures("gl")
def test_integer_targets_are_used_if_no_other_targets_are_allowed(run):
    """This holds even if no other layout is possible, so that no gain can be measured."""
    asked = ["--scene", "ramps", "--size", "160x120", "--bytes", "20", "--read-alone", "none", "--format", "json"]
    status, out, err = run("budget", *asked, "--formats", "rgba32_uint,rg16f")
    assert status == 0, err
    (row,) = json.loads(out)
    assert row["targets"].startswith("rgba32_uint: ") and row["psnr_db"] > 50


# What WebGPU calls the formats that it renders to.
WEBGPU_NAMES = {
    "r8": "r8unorm",
    "rg8": "rg8unorm",
    "rgba8": "rgba8unorm",
    "srgb8_a8": "rgba8unorm-srgb",
    "rgb10a2": "rgb10a2unorm",
    "r11g11b10f": "rg11b10ufloat",
    "rg16f": "rg16float",
    "rgba16f": "rgba16float",
    "r8_uint": "r8uint",
    "r16_uint": "r16uint",
    "r32_uint": "r32uint",
    "rgba8_uint": "rgba8uint",
    "rg16_uint": "rg16uint",
    "rgba16_uint": "rgba16uint",
    "rg32_uint": "rg32uint",
    "rgba32_uint": "rgba32uint",
}


def _webgpu_device():
    """Return a device with WebGPU's own limit, which may be below this machine's; skip the test without a device."""
    require_runner("wgsl")
    return adapters()[0].request_device_sync(
        required_limits={"max-color-attachment-bytes-per-sample": WEBGPU_BYTES},
        required_features=["rg11b10ufloat-renderable"],
    )


def _refusal(gpu, formats) -> str:
    """Return why WebGPU creates no pipeline that renders to these formats, or an empty string if it does."""
    import wgpu

    names = [WEBGPU_NAMES[name] for name in formats]
    kinds = ["vec4u" if name.endswith("uint") else "vec4f" for name in names]
    members = ", ".join(f"@location({index}) made_{index}: {kind}" for index, kind in enumerate(kinds))
    text = f"""
        struct Made {{ {members} }}
        @vertex fn corner() -> @builtin(position) vec4f {{ return vec4f(); }}
        @fragment fn pixel() -> Made {{ var made: Made; return made; }}
    """
    module = gpu.create_shader_module(code=text)
    try:
        gpu.create_render_pipeline(
            layout=gpu.create_pipeline_layout(bind_group_layouts=[]),
            vertex={"module": module, "entry_point": "corner"},
            fragment={"module": module, "entry_point": "pixel", "targets": [{"format": name} for name in names]},
        )
    except wgpu.GPUError as error:
        return str(error)
    return ""


def test_wgpu_accepts_targets_up_to_32_bytes_and_refuses_more():
    """Up to 8 random targets are tried; the error of a refusal states the bytes that wgpu counts."""
    gpu, rng = _webgpu_device(), np.random.default_rng(11)
    assert WEBGPU_NAMES.keys() == WEBGPU.keys()
    drawn = [list(rng.choice(list(WEBGPU), size)) for size in rng.integers(4, 9, 120)]
    # One byte first, in the middle and last; just at the limit, and just above it.
    known = [["rgba8"] * 4, ["rgba8"] * 4 + ["r8"], ["r8"] + ["r32_uint"] * 7, ["rgba8", "r8", "rgb10a2", "rgba16f"]]
    counts = {True: 0, False: 0}
    for formats in (*known, *drawn):
        cost, refusal = webgpu_cost(formats), _refusal(gpu, formats)
        assert cost is not None and bool(refusal) == (cost > WEBGPU_BYTES), f"{formats}: {cost} bytes; {refusal}"
        assert not refusal or f"color attachments {cost} exceeds" in refusal, f"{formats}: {cost} bytes; {refusal}"
        counts[bool(refusal)] += 1
    assert min(counts.values()) > 20


@pytest.mark.usefixtures("gl")
def test_a_run_gives_its_scenes_to_the_budget(run, tmp_path):
    """The run checks the scenes before it measures; room cannot judge layouts."""
    status, _, err = run("run", "--tables", "budget", "--scene", "room", "--output", str(tmp_path / "run"))
    assert status != 0 and "room: no metallic-roughness materials" in err, err
