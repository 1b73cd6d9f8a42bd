"""The cost table with a cold, warm or damaged cache, and with parts that are missing, fail or hang."""

import itertools
import json
import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import pytest
import test_cost_failures
from costing import glsl
from test_cost_failures import EVERY, SMALL

from normalbench.bench.door.run import asked_of
from normalbench.bench.door.run_options import RunOptions
from normalbench.bench.ground.compilers import tools as compilers
from normalbench.bench.ground.machine import devices
from normalbench.bench.ground.options import gpu_families as families
from normalbench.bench.ground.output import cache
from normalbench.bench.shaders.isa import isa, spirv
from normalbench.bench.shaders.isa import process as isa_process
from normalbench.bench.tables.cost import measure as cost
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.gl.device import NoDeviceError

compiled_once = test_cost_failures.compiled_once
first = test_cost_failures.first


SAYS = "import json; print(json.dumps({'loaded': json.loads(%r)}))"


def test_driver_is_identified_by_its_loaded_libraries(monkeypatch, tmp_path):
    """A driver is identified by its fingerprint and LLVM's; without the driver's fingerprint nothing is cached."""
    fingerprints = []
    for files in (
        {"/lib/libvulkan_radeon.so": "a", "/lib/libLLVM.so": "b"},
        {"/lib/libLLVM.so": "b", "/lib/libvulkan_radeon.so": "a"},
        {"/lib/libvulkan_radeon.so": "a2", "/lib/libLLVM.so": "b"},
        {"/lib/libvulkan_radeon.so": "a", "/lib/libLLVM.so": "b2"},
        {"/lib/libLLVM.so": "b"},
        {},
    ):
        monkeypatch.setattr(isa_process, "CHILD", [sys.executable, "-c", SAYS % json.dumps(files)])
        isa._loaded.cache_clear()
        fingerprints.append(isa._loaded(tmp_path / "radeon.json"))
    isa._loaded.cache_clear()
    first, same, driver, llvm, *unknown = fingerprints
    assert first == same and len({first, driver, llvm}) == 3 and unknown == ["", ""]


def test_cached_instructions_need_no_import_of_jax_or_pandas(first):
    """The table takes two seconds; importing JAX would add another."""
    program = (
        "import sys; from normalbench.bench.door.cli.app import main; main();"
        "print({'jax', 'pandas', 'matplotlib'} & set(sys.modules) or 'light')"
    )
    done = subprocess.run([sys.executable, "-c", program, *SMALL], capture_output=True, text=True, check=True)
    assert done.stdout == f"{first[1]}light\n", done.stdout[-200:]


@pytest.mark.usefixtures("radv", "own_cache")
def test_two_runs_give_identical_rows_with_or_without_the_cache(run, own_cache):
    first = run(*SMALL)
    again = run(*SMALL)
    shutil.rmtree(own_cache)
    afresh = run(*SMALL)
    assert first[0] == 0 and first == again == afresh
    assert json.loads(first[1])[0]["driver"].startswith("Mesa ")


def test_the_second_run_compiles_nothing(run, first, monkeypatch):
    monkeypatch.setattr(isa_process, "CHILD", ["false"])
    monkeypatch.setattr(compilers, "_piped", lambda *_: pytest.fail("compiled again"))
    assert run(*SMALL) == first


def test_damaged_cache_entries_are_computed_again(run, first, own_cache):
    damages = (b"", b"{", b"[1]", b'{"key": "", "value": {}}', b"\xff\x00")
    # Commands of other tests keep answers, which are not read here.
    files = [path for path in own_cache.rglob("*.json") if "said" not in json.loads(path.read_text())["value"]]
    assert len(files) > len(damages)
    for path, damage in zip(files, itertools.cycle(damages), strict=False):
        path.write_bytes(damage)
    assert run(*SMALL) == first
    assert all(path.read_bytes() not in damages for path in files)


def in_the_cache(folder, kind: str) -> list[tuple[str, dict]]:
    """Return the cached (key, value) pairs of a kind, `spirv` or `isa`."""
    mark = {"isa": "kernels", "spirv": "binary"}[kind]
    entries = [json.loads(path.read_text()) for path in folder.rglob("*.json")]
    return [(kept["key"], kept["value"]) for kept in entries if mark in kept["value"]]


WRONG = [
    ("isa", {"kernels": "none"}),
    ("isa", {"kernels": []}),
    ("isa", {"kernels": [{"simd_width": 64, "statistics": {"Instructions": "12"}, "assembly": ""}]}),
    ("isa", {"kernels": [{"simd_width": 64, "statistics": {}, "assembly": None}]}),
    ("isa", {"kernels": [{"simd_width": "64", "statistics": {}, "assembly": ""}]}),
    ("isa", {"version": None}),
    ("isa", {"more": 1}),
    ("spirv", {"binary": "A"}),
    ("spirv", {"binary": "AAAA"}),
    ("spirv", {"binary": "A" * 400}),
    ("spirv", {"binary": 7}),
    ("spirv", {"instructions": "12"}),
]


READ = {"isa": isa._as_compiled, "spirv": spirv._as_module}


@pytest.mark.parametrize("kind, wrong", WRONG)
def test_intact_but_wrong_cache_entries_are_not_read(compiled_once, kind, wrong):
    kept = in_the_cache(compiled_once[0], kind)
    assert kept
    for _, value in kept:
        assert READ[kind](value) and READ[kind](value | wrong) is None


@pytest.mark.parametrize("kind, wrong", WRONG)
def test_intact_but_wrong_cache_entries_are_computed_again(run, first, own_cache, kind, wrong):
    """Each wrong entry has the right key and a valid digest."""
    kept = in_the_cache(own_cache, kind)
    assert kept
    for key, value in kept:
        cache.write(key, value | wrong)
    assert run(*SMALL) == first
    assert dict(in_the_cache(own_cache, kind)) == dict(kept)


def test_cache_entries_changed_after_writing_are_computed_again(run, first, own_cache):
    files = [path for path in own_cache.rglob("*.json") if '"Instructions": ' in path.read_text()]
    for path in files:
        path.write_text(path.read_text().replace('"Instructions": ', '"Instructions": 1'))
    assert files and run(*SMALL) == first


@pytest.mark.usefixtures("radv", "own_cache")
def test_another_driver_causes_recompilation(run, monkeypatch):
    """Two builds of Mesa may give different results under the same file name and date."""
    monkeypatch.setattr(isa, "_loaded", lambda _: "one build")
    first = run(*SMALL)
    monkeypatch.setattr(isa_process, "CHILD", [sys.executable, "-c", "raise SystemExit(9)"])
    assert run(*SMALL) == first
    monkeypatch.setattr(isa, "_loaded", lambda _: "another build")
    _, out, _ = run(*SMALL)
    assert "status 9" in json.loads(out)[0]["skipped"]


@pytest.mark.usefixtures("radv", "own_cache")
def test_rows_of_a_driver_named_without_its_folder_are_cached(run, monkeypatch, tmp_path):
    """A driver description may omit the folder; the loader then searches for the library as the system does."""
    described = json.loads(isa.driver_file().read_text())
    described["ICD"]["library_path"] = Path(described["ICD"]["library_path"]).name
    (tmp_path / "radeon.json").write_text(json.dumps(described))
    monkeypatch.setattr(isa, "driver_file", lambda *_: tmp_path / "radeon.json")
    first = run(*SMALL)
    assert first[0] == 0 and all(row["skipped"] is None for row in json.loads(first[1]))
    monkeypatch.setattr(isa_process, "CHILD", ["false"])
    assert run(*SMALL) == first


@pytest.mark.usefixtures("radv", "own_cache")
@pytest.mark.parametrize("tool", [spirv.COMPILER, spirv.OPTIMISER])
def test_another_version_of_a_tool_causes_recompilation(run, monkeypatch, tool):
    first, own, ran = run(*SMALL), spirv.version, []
    piped = compilers._piped
    monkeypatch.setattr(compilers, "_piped", lambda *given: ran.append(Path(given[0][0]).name) or piped(*given))
    assert run(*SMALL) == first and not ran
    monkeypatch.setattr(spirv, "version", lambda asked: "Version 99.1" if asked == tool else own(asked))
    _, out, _ = run(*SMALL)
    assert tool in ran and "99.1" in json.loads(out)[0]["compiler"]


@pytest.mark.usefixtures("radv", "own_cache")
def test_no_temporary_files_are_left(run, monkeypatch, tmp_path):
    """This holds however a process ends, because its temporary files have no names."""
    root = tmp_path / "temporary"
    root.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(root))
    seen = []
    own = isa_process._Heard.following
    monkeypatch.setattr(isa_process._Heard, "following", lambda heard: seen.append(list(root.iterdir())) or own(heard))
    assert run(*SMALL)[0] == 0
    assert seen and not any(seen) and not list(root.iterdir())


CHILD = """
import os, sys, time
from normalbench.bench.shaders.isa import child as isa_child
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
        ("time.sleep(60)", "did not respond within"),
    ],
)
def test_a_driver_failure_on_a_shader_loses_only_that_row(run, monkeypatch, tmp_path, what, reason):
    """The child recognises the job by its size, which is unique to encoding `octahedral`."""
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
def test_a_driver_that_always_fails_is_no_longer_used(run, monkeypatch):
    monkeypatch.setattr(isa_process, "CHILD", [sys.executable, "-c", "import os; os.abort()"])
    status, out, _ = run(*SMALL)
    (row, *others) = json.loads(out)
    assert status == 0 and row["family"] == "navi21" and "SIGABRT" in row["skipped"]
    assert all(other["family"] is None and other["instructions"] is None for other in others)


@pytest.mark.usefixtures("radv", "own_cache")
def test_a_family_that_this_mesa_refuses_has_one_row(run, monkeypatch):
    known = families.FAMILIES["navi21"]
    unknown = {"navi99": replace(known, names=("navi99", "gfx9999")), "navi21": known}
    monkeypatch.setattr(isa, "FAMILIES", unknown)
    monkeypatch.setattr(families, "CHOICES", {"radeon": tuple(unknown)})
    status, out, err = run("cost", *EVERY, "--encoding", "xy", "--storage", "rgba8", "--stage", "fragment")
    rows = json.loads(out)
    assert status == 0
    assert [row["skipped"] for row in rows if row["family"] == "navi99"] == [
        "this Mesa version does not know family navi99 or gfx9999"
    ]
    assert all(row["skipped"] is None for row in rows if row["family"] == "navi21")
    assert err.count("\n") == 1 and "navi99" in err


def without_driver(monkeypatch, _):
    monkeypatch.setattr(isa, "driver_file", lambda *_: None)


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
        (without_compiler, "glslang-tools", ""),
    ],
)
def test_missing_tool_is_a_one_line_error_and_other_columns_are_filled(
    run, monkeypatch, tmp_path, take, package, column
):
    take(monkeypatch, tmp_path)
    status, out, err = run(*SMALL)
    rows = json.loads(out)
    assert status == 3 and package in err and err.count("\n") == 1, err
    encoders = [row for row in rows if row["encoding"] and column and row[column] is not None]
    assert {(row["encoding"], row["operation"]) for row in encoders} == {
        ("spheremap", operation) for operation in cost.OPERATIONS if column
    }
    assert any(row["skipped"] and package in row["skipped"] for row in rows) or package == "spirv-tools"


@pytest.mark.usefixtures("radv", "own_cache")
def test_broken_user_shader_loses_only_its_rows_and_reports_file_and_line(tmp_path):
    bad = glsl(tmp_path, "bad", "n.xy * nonsense", "vec3(e, 0.0)", 2)
    chosen = cost.cases([bad, ENCODINGS["xy"]], (), cost.OPERATIONS)
    rows = [row for row, _ in cost.isa_rows(chosen, ["fragment"], ["navi21"], [], lambda _: None)]
    for row in rows:
        assert (row["encoding"] == "bad") == (row["skipped"] is not None), row
    assert f"{bad.glsl}:1" in rows[0]["skipped"] and "nonsense" in rows[0]["skipped"]


@pytest.mark.usefixtures("radv", "own_cache")
def test_compiler_crash_is_a_one_line_error(run, monkeypatch):
    crashed = subprocess.CompletedProcess([], -11, b"", b"")
    monkeypatch.setattr(compilers, "_piped", lambda *_: crashed)
    status, out, err = run("cost", *EVERY, "--encoding", "xy,octahedral", "--family", "navi21", "--storage", "rgba8")
    assert status == 0 and all(row["skipped"] for row in json.loads(out))
    assert err == "normalbench: rows without figures: glslangValidator ended with status -11 and no message\n"


@pytest.mark.usefixtures("radv")
@pytest.mark.parametrize(
    "take, package",
    [(without_driver, "mesa-vulkan-drivers"), (without_loader, "libvulkan1"), (without_compiler, "glslang-tools")],
)
def test_run_without_compilers_skips_cost_and_fails_if_only_cost_is_requested(
    run, monkeypatch, tmp_path, capsys, take, package
):
    take(monkeypatch, tmp_path)
    isa._loaded.cache_clear()
    try:
        status, out, err = run("run", "--tables", "cost", "-o", str(tmp_path / "run"))
        assert (status, out) == (3, "") and package in err and err.count("\n") == 1, err
        assert not (tmp_path / "run").exists()
        assert {ask.table.name for ask in asked_of(RunOptions(tables="cost,depth"), tmp_path)} == {"depth"}
    finally:
        isa._loaded.cache_clear()
    stderr = capsys.readouterr().err
    assert stderr.startswith("normalbench: left out: cost: ") and package in stderr and stderr.count("\n") == 1


@pytest.mark.usefixtures("radv")
def test_missing_opengl_device_skips_only_the_timed_rows(run, monkeypatch):
    def missing():
        raise NoDeviceError("no OpenGL 4.3 device; install an OpenGL driver")

    monkeypatch.setattr(devices, "device", missing)
    status, out, err = run(*SMALL, "--time")
    rows = json.loads(out)
    assert status == 3 and err == "normalbench: no OpenGL 4.3 device; install an OpenGL driver\n"
    assert [row["skipped"] is None for row in rows] == [row["measure"] == "isa" for row in rows]
