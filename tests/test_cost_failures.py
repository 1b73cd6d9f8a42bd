"""The cost table where a cache is cold, warm or damaged, and where something is missing, fails or never ends."""

import itertools
import json
import shutil
import sys

import pytest
from costing import glsl

from normalbench.bench import cache, cost, isa, isa_process, quality, spirv
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.device import NoDeviceError

EVERY = ["--isa", "--format", "json"]
WORDS = ["--encoding", "spheremap", "--family", "navi21", "--storage", "rgba8", "--stage", "fragment"]
SMALL = ["cost", *EVERY, *WORDS]


@pytest.mark.usefixtures("radv", "own_cache")
def test_two_runs_give_identical_rows_from_the_cache_or_without(run, own_cache):
    first = run(*SMALL)
    again = run(*SMALL)
    shutil.rmtree(own_cache)
    afresh = run(*SMALL)
    assert first[0] == 0 and first == again == afresh
    assert json.loads(first[1])[0]["driver"].startswith("Mesa ")


@pytest.mark.usefixtures("radv", "own_cache")
def test_the_second_run_compiles_nothing(run, monkeypatch):
    first = run(*SMALL)
    monkeypatch.setattr(isa_process, "CHILD", ["false"])
    monkeypatch.setattr(spirv, "_run", lambda *_: pytest.fail("compiled again"))
    assert run(*SMALL) == first


@pytest.mark.usefixtures("radv")
def test_a_damaged_cache_is_computed_again(run, own_cache):
    first = run(*SMALL)
    files, damages = list(own_cache.rglob("*.json")), (b"", b"{", b"[1]", b'{"key": "", "value": {}}', b"\xff\x00")
    assert len(files) > len(damages)
    for path, damage in zip(files, itertools.cycle(damages), strict=False):
        path.write_bytes(damage)
    assert run(*SMALL) == first
    assert all(path.read_bytes() not in damages for path in files)


def test_the_cache_is_no_error_where_it_cannot_be_written(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    cache.write("00", {"a": 1})
    assert cache.read("00") is None


CHILD = """
import os, sys, time
from normalbench.bench import isa_child
own, seen = isa_child.compiled, []
def compiled(driver, job, planes):
    seen.append(job)
    if len(job["code"]) == int(os.environ["BAD_SIZE"]):
        {what}
    return own(driver, job, planes)
isa_child.compiled = compiled
sys.exit(isa_child.main())
"""


@pytest.mark.usefixtures("radv", "own_cache")
@pytest.mark.parametrize(
    "what, reason",
    [
        ("os.abort()", "SIGABRT"),
        ("os.kill(os.getpid(), 11)", "SIGSEGV"),
        ("print('out of registers', file=sys.stderr); sys.exit(7)", "status 7: out of registers"),
        ("time.sleep(60)", "did not answer within"),
    ],
)
def test_a_driver_that_fails_on_a_shader_costs_that_row(run, monkeypatch, tmp_path, what, reason):
    """Jobs are told apart by their size: that of octahedral's encode is nobody else's."""
    script = tmp_path / "child.py"
    script.write_text(CHILD.format(what=what))
    (victim,) = cost.cases([ENCODINGS["octahedral"]], (), ["encode"])
    bad = cost.prepare(victim, "fragment")
    monkeypatch.setenv("BAD_SIZE", str(4 * ((len(bad.job.code) + 2) // 3)))
    monkeypatch.setattr(isa_process, "CHILD", [sys.executable, str(script)])
    monkeypatch.setattr(isa_process, "SECONDS", 3.0)
    words = ["--encoding", "xy,octahedral,spheremap", "--family", "vega10", "--storage", "rgba8", "--stage", "fragment"]
    status, out, err = run("cost", *EVERY, *words)
    rows = json.loads(out)
    lost = [row for row in rows if row["skipped"]]
    assert status == 0 and len(rows) == 10
    assert [(row["encoding"], row["operation"]) for row in lost] == [("octahedral", "encode")], lost
    assert reason in lost[0]["skipped"] and reason in err and err.count("\n") == 1, err


@pytest.mark.usefixtures("radv", "own_cache")
def test_a_driver_that_always_fails_is_given_up(run, monkeypatch):
    monkeypatch.setattr(isa_process, "CHILD", [sys.executable, "-c", "import os; os.abort()"])
    status, out, _ = run(*SMALL)
    (row, *others) = json.loads(out)
    assert status == 0 and row["family"] == "navi21" and "SIGABRT" in row["skipped"]
    assert all(other["family"] is None and other["instructions"] is None for other in others)


@pytest.mark.usefixtures("radv", "own_cache")
def test_a_family_that_this_mesa_refuses_has_one_row(run, monkeypatch):
    monkeypatch.setattr(isa, "FAMILIES", {"navi99": ("navi99", "gfx9999"), "navi21": ("navi21",)})
    status, out, err = run("cost", *EVERY, "--encoding", "xy", "--storage", "rgba8", "--stage", "fragment")
    rows = json.loads(out)
    assert status == 0
    assert [row["skipped"] for row in rows if row["family"] == "navi99"] == [
        "this Mesa knows no family navi99 or gfx9999"
    ]
    assert all(row["skipped"] is None for row in rows if row["family"] == "navi21")
    assert err.count("\n") == 1 and "navi99" in err


def without_driver(monkeypatch, _):
    monkeypatch.setattr(isa, "driver_file", lambda: None)


def without_loader(monkeypatch, tmp_path):
    (tmp_path / "vulkan.py").write_text("raise OSError('Cannot find Vulkan SDK version.')\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))


def without_bindings(monkeypatch, tmp_path):
    (tmp_path / "vulkan.py").write_text("raise ImportError('No module named vulkan')\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))


def without_optimiser(monkeypatch, _):
    own = spirv.version
    monkeypatch.setattr(spirv, "version", lambda tool: None if tool == spirv.OPTIMISER else own(tool))


def without_compiler(monkeypatch, _):
    monkeypatch.setattr(spirv, "version", lambda _: None)


@pytest.mark.usefixtures("radv", "own_cache")
@pytest.mark.parametrize(
    "take, package, column",
    [
        (without_driver, "mesa-vulkan-drivers", "spirv_instructions"),
        (without_loader, "libvulkan1", "spirv_instructions"),
        (without_bindings, "pip install vulkan", "spirv_instructions"),
        (without_optimiser, "spirv-tools", "instructions"),
        (without_compiler, "glslang-tools", "millions_per_second"),
    ],
)
def test_what_is_missing_is_one_line_and_the_other_columns_are_filled(
    run, monkeypatch, tmp_path, take, package, column
):
    take(monkeypatch, tmp_path)
    status, out, err = run(*SMALL, "--jax", "--repeats", "2", "--count", "1024")
    rows = json.loads(out)
    assert status == 3 and package in err and err.count("\n") == 1, err
    encoders = [row for row in rows if row["encoding"] and row[column] is not None]
    assert {(row["encoding"], row["operation"]) for row in encoders} == {("spheremap", o) for o in cost.OPERATIONS}
    assert any(row["skipped"] and package in row["skipped"] for row in rows) or package == "spirv-tools"


@pytest.mark.usefixtures("radv", "own_cache")
def test_a_users_shader_that_does_not_compile_costs_its_rows_and_is_named_with_file_and_line(tmp_path):
    bad = glsl(tmp_path, "bad", "n.xy * nonsense", "vec3(e, 0.0)", 2)
    chosen = cost.cases([bad, ENCODINGS["xy"]], (), cost.OPERATIONS)
    rows = [row for row, _ in cost.isa_rows(chosen, ["fragment"], ["navi21"], [], lambda _: None)]
    for row in rows:
        assert (row["encoding"] == "bad") == (row["skipped"] is not None), row
    assert f"{bad.glsl}:1" in rows[0]["skipped"] and "nonsense" in rows[0]["skipped"]


@pytest.mark.parametrize(
    "words, said",
    [
        (["--encoding", "nope"], "unknown encoding 'nope'"),
        (["--family", "gcn"], "unknown family 'gcn'; known: all, polaris10"),
        (["--stage", "vertex"], "unknown stage 'vertex'"),
        (["--operation", "sign"], "unknown operation 'sign'"),
        (["--storage", "13:13"], "unknown storage '13:13'"),
        (["--repeats", "1"], "--repeats 1"),
        (["--count", "0"], "--count 0"),
        (["--normals", "cube"], "unknown normal set 'cube'"),
        (["--error", "mse"], "unknown error 'mse'"),
        (["--plot", "p.gif"], "p.gif"),
        (["--plot", "p.png", "--storage", "12:12"], "--plot needs a storage"),
        (["--plot", "p.png", "--jax"], "--plot draws instructions or time"),
        (["--disassembly", "d", "--jax"], "--disassembly is of what compilers make"),
    ],
)
def test_bad_input_is_one_line(run, monkeypatch, tmp_path, words, said):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("cost", *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("radv")
def test_without_a_gl_device_time_is_missing_and_the_rest_is_there(run, monkeypatch):
    def missing():
        raise NoDeviceError("no GL 4.3 device; install a GL driver")

    monkeypatch.setattr(quality, "device", missing)
    status, out, err = run(*SMALL, "--time")
    rows = json.loads(out)
    assert status == 3 and err == "normalbench: no GL 4.3 device; install a GL driver\n"
    assert [row["skipped"] is None for row in rows] == [row["measure"] == "isa" for row in rows]
