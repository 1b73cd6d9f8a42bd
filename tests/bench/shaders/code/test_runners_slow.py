"""Hand-written files, run in every language and compared with the same functions in NumPy."""

import json
import os
import re
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from languages import RUN

from normalbench.bench.ground.compilers.text import Text
from normalbench.bench.ground.machine.systems import landlock
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.code.run import c, essl, interface, runner
from normalbench.bench.shaders.code.run.interface import Interface, Ran
from normalbench.bench.shaders.translator.writer import PUBLIC
from normalbench.gbuffer.gl.device import NoDeviceError
from normalbench.gbuffer.gl.shader import ShaderError

FOLDER = Path(__file__).parents[3] / "inputs" / "code"


STEPS = np.array([[[3.0, 0.5], [5.0, 0.25]]], np.float32)


SPHEREMAP = Interface("spheremap_rg8", 2, 0, 1)


SCALED = Interface("scaled_rg32f", 3, 1, 2, ("view.xyz",), {"scaled_steps": STEPS})


def file_of(what: Interface, language: str) -> Path:
    return FOLDER / f"{what.prefix}.{language}"


def given(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return unit normals including the axes, views in sixteenths, and texels."""
    random = np.random.default_rng(7)
    n = random.normal(size=(count, 3))
    n = (n / np.linalg.norm(n, axis=1, keepdims=True)).astype(np.float32)
    n[:6] = np.concatenate([np.eye(3), -np.eye(3)])
    view = (random.integers(-16, 16, (count, 3)) / 16).astype(np.float32)
    return n, view, random.random((count, 4), np.float32)


def by_numpy(what: Interface, n: np.ndarray, view: np.ndarray, texels: np.ndarray) -> Ran:
    """Return the results of the same functions in NumPy."""
    module = runpy.run_path(str(FOLDER / f"{what.prefix}.py"))
    six = {name: module[f"{what.prefix}_{name}"] for name in PUBLIC}
    besides = (view,) if what.settings else ()
    codes = six["encode"](n, *besides)
    sign = (codes[:, -1],) if what.sign_bits else ()
    words = six["pack"](codes)
    unpacked = six["unpack"](words, *sign)
    back = six["from_target"](texels, *sign)
    decoded = six["decode"](unpacked, *besides)
    return Ran(codes, words.reshape(len(n), -1), unpacked, decoded, six["to_target"](codes), back)


def ran(language: str, what: Interface, arrays) -> Ran:
    try:
        return runner(language).run(file_of(what, language), what, *arrays)
    except (MissingError, NoDeviceError) as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error))


@pytest.mark.parametrize("language", RUN)
def test_a_plain_codec_matches_numpy(language):
    """Spheremap in RG8: the same words, and numbers within 4 units in the last place of 1."""
    arrays = given(4096)
    expected, output = by_numpy(SPHEREMAP, *arrays), ran(language, SPHEREMAP, arrays)
    differ = np.flatnonzero((expected.words != output.words).any(axis=1))
    assert not len(differ), f"{len(differ)} words differ, the first at {arrays[0][differ[0]]}"
    for name, a, b in zip(Ran._fields, expected, output, strict=True):
        assert a.shape == b.shape, name
        worst = np.abs(a.astype(np.float64) - b).max()
        assert worst <= 4 * 2.0**-23, f"{name} differs by {worst}"


@pytest.mark.parametrize("language", RUN)
def test_views_tables_signs_and_words_reach_the_functions(language):
    """A codec that takes a view, a table, a sign and two words gives the same words and signs in every language."""
    arrays = given(1000)
    expected, output = by_numpy(SCALED, *arrays), ran(language, SCALED, arrays)
    for name, a, b in zip(Ran._fields, expected, output, strict=True):
        differ = np.count_nonzero(a != b)
        assert a.shape == b.shape and not differ, f"{differ} {name} differ"


@pytest.mark.parametrize("language", RUN)
def test_blocks_are_put_together_in_order(language, monkeypatch):
    """A run in blocks of 300 equals the run in one block, bit for bit, and empty input gives empty output."""
    arrays = given(1000)
    whole = ran(language, SPHEREMAP, arrays)
    monkeypatch.setattr(interface, "BLOCK", 300)
    for name, a, b in zip(Ran._fields, whole, ran(language, SPHEREMAP, arrays), strict=True):
        assert np.array_equal(a, b), name
    none = ran(language, SPHEREMAP, [array[:0] for array in arrays])
    assert none.words.shape == (0, 1) and none.decoded.shape == (0, 3)


@pytest.mark.parametrize("language", RUN)
def test_broken_file_is_a_one_line_error_that_names_it(language, tmp_path):
    """A file that does not compile is a ShaderError of one line, not a crash."""
    ran(language, SPHEREMAP, given(8))
    broken = tmp_path / "broken.txt"
    broken.write_text("float broken() { return unknown_name; }\n")
    with pytest.raises(ShaderError) as error:
        runner(language).run(broken, SPHEREMAP, *given(8))
    assert "\n" not in str(error.value) and "broken.txt" in str(error.value), str(error.value)


@pytest.fixture
def no_judge(monkeypatch):
    """The text filter, disabled: code that it would refuse is compiled."""
    monkeypatch.setattr(c, "judged_text", lambda text, *_: Text(text, is_own=False))


# What a file may do, and how the process that it is in ends.
ENDS = {
    "reads what is not there": ("return *(volatile float *)8;", "SIGSEGV"),
    "never ends": ("for (volatile int i = 0;; ++i) ; return 0.0f;", "SIGXCPU|SIGKILL|did not end"),
    # One page of each block is touched: a busy machine does not reach the limit of seconds first.
    "wants all memory": ("for (;;) *(volatile char *)calloc(1u << 28, 1) = 1;", "SIGSEGV|SIGKILL"),
}


@pytest.mark.usefixtures("no_judge")
@pytest.mark.parametrize("what", ENDS)
def test_crashing_user_code_ends_only_its_own_process(what, tmp_path, monkeypatch):
    """A one-line error says how the process ended, and the calling process survives."""
    ran("c", SPHEREMAP, given(8))
    monkeypatch.setitem(c.LIMITS, "RUN_SECONDS", 1)
    body, how = ENDS[what]
    head = "#include <stdlib.h>\n" if "calloc" in body else ""
    text = file_of(SPHEREMAP, "c").read_text()
    name = re.search(r"\bspheremap_rg8_encode\(\w+ (\w+)\) \{", text)
    assert name, text
    trap = f"static float trap(void) {{ {body} }}\n"
    hurt = text.replace(name[0], f"{name[0]} if ({name[1]}.x > -2.0f) {name[1]}.x = trap();")
    before, mark, rest = hurt.partition("\nstatic inline ")
    (tmp_path / "hurt.txt").write_text(f"{head}{before}\n{trap}{mark}{rest}")
    with pytest.raises(ShaderError, match=how) as error:
        runner("c").run(tmp_path / "hurt.txt", SPHEREMAP, *given(8))
    assert "\n" not in str(error.value) and "hurt.txt" in str(error.value)


# Whatever it opens or starts it ends the process.
TRAPS = ('fopen("/etc/passwd", "r")', 'fopen("/tmp/escaped", "w")', 'popen("exit 0", "r") && system("exit 0") == 0')


FOREIGN = replace(SPHEREMAP, is_ours=False)


walled = pytest.mark.skipif(
    not landlock.is_available() and not os.environ.get("CI"), reason="this kernel has no Landlock"
)


@walled
@pytest.mark.parametrize("trap", TRAPS)
def test_user_code_cannot_open_files_or_start_processes(trap, tmp_path, request):
    """The text filter refuses such code. Without it, the sandbox blocks attempts that would otherwise succeed."""
    expected = ran("c", SPHEREMAP, given(8))
    before, mark, rest = file_of(SPHEREMAP, "c").read_text().partition("\nstatic inline")
    assert mark
    head = f"#include <stdio.h>\n#include <stdlib.h>\n{before}\n"
    tries = f"__attribute__((constructor)) static void tries(void) {{ if ({trap}) abort(); }}\n"
    (tmp_path / "tries.txt").write_text(f"{head}{tries}{mark}{rest}")
    with pytest.raises(ShaderError, match=r"is not supported"):
        runner("c").run(tmp_path / "tries.txt", FOREIGN, *given(8))
    request.getfixturevalue("no_judge")
    with pytest.raises(ShaderError, match="SIGABRT"):
        runner("c").run(tmp_path / "tries.txt", SPHEREMAP, *given(8))
    output = runner("c").run(tmp_path / "tries.txt", FOREIGN, *given(8))
    assert all(np.array_equal(a, b) for a, b in zip(expected, output, strict=True))


@walled
def test_user_code_finds_its_tables_in_the_sandbox():
    arrays = given(100)
    for a, b in zip(ran("c", SCALED, arrays), ran("c", replace(SCALED, is_ours=False), arrays), strict=True):
        assert np.array_equal(a, b)


def test_user_code_does_not_run_without_a_sandbox(monkeypatch):
    """The catalogue's own code runs without a sandbox."""
    monkeypatch.setattr(landlock, "abi", lambda: 0)
    ran("c", SPHEREMAP, given(8))
    with pytest.raises(MissingError, match="Landlock: none; C generated from your files is not run here"):
        runner("c").run(file_of(SPHEREMAP, "c"), FOREIGN, *given(8))


def test_missing_sandbox_is_reported_in_a_users_row(run, monkeypatch, tmp_path):
    """The `doctor` command also reports the missing sandbox."""
    monkeypatch.setattr(landlock, "abi", lambda: 0)
    (tmp_path / "mine.glsl").write_text(
        "vec2 mine_encode(vec3 n, vec3 view) { return n.xy; }\n"
        "vec3 mine_decode(vec2 e, vec3 view) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }\n"
    )
    words = ("code", str(tmp_path / "mine.glsl"), "--storage", "rg8", "--to", "c", "--check", "--format", "json")
    status, out, _ = run(*words)
    (row,) = json.loads(out)
    assert (status, row["verdict"]) == (0, "not run")
    assert row["says"] == "not run here: Landlock: none; C generated from your files is not run here"
    assert "no: Landlock: none; C generated from your files is not run here" in run("doctor", "--format", "json")[1]


def test_compiler_wrapper_script_is_not_run_in_the_sandbox(monkeypatch, tmp_path):
    """Some systems wrap their compiler in a script; the error says why nothing runs."""
    (tmp_path / "cc").write_text('#!/bin/sh\nexec /usr/bin/cc "$@"\n')
    (tmp_path / "cc").chmod(0o755)
    ran("c", SPHEREMAP, given(8))
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    with pytest.raises(MissingError, match="C generated from your files is not run here: with Landlock, cc: "):
        runner("c").run(file_of(SPHEREMAP, "c"), FOREIGN, *given(8))


def test_naga_crash_is_a_one_line_error(tmp_path):
    """Naga crashes on a `select` between vectors by a constant; only naga's own process ends."""
    ran("wgsl", SPHEREMAP, given(8))
    foreign = replace(SPHEREMAP, is_ours=False)
    assert len(runner("wgsl").run(file_of(SPHEREMAP, "wgsl"), foreign, *given(8)).words) == 8
    panics = (
        "fn p() -> vec3f { return select(vec3f(vec2f(2.0, 1.0), 1.0), vec3f(1.0), FLIP); }\nconst FLIP: bool = true;\n"
    )
    (tmp_path / "panics.wgsl").write_text(file_of(SPHEREMAP, "wgsl").read_text() + panics)
    with pytest.raises(ShaderError, match=r"panics\.wgsl: naga crashed \(SIGABRT\)"):
        runner("wgsl").run(tmp_path / "panics.wgsl", foreign, *given(8))


@pytest.mark.parametrize("language", RUN)
def test_runner_reports_the_version_of_its_tool(language):
    """`how` is one line with a version."""
    ran(language, SPHEREMAP, given(8))
    line = runner(language).how()
    assert "\n" not in line and any(c.isdigit() for c in line), line


@pytest.mark.parametrize(("language", "tool"), [("c", "gcc"), ("hlsl", "glslang-tools"), ("slang", "slangtorch")])
def test_a_missing_tool_is_reported_with_the_package_to_install(language, tool, monkeypatch):
    """Without compilers on the path a runner says what to install."""
    from normalbench.bench.shaders.isa import spirv

    # Before anything is hidden: a module that is imported meanwhile would keep what hides it.
    own_runner = runner(language)
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(spirv, "version", lambda _: None)
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(MissingError, match=tool):
        own_runner.run(file_of(SPHEREMAP, language), SPHEREMAP, *given(8))


def test_glsl_es_is_not_run_if_opengl_does_not_support_it(monkeypatch):
    ran("essl", SPHEREMAP, given(8))
    monkeypatch.setattr(essl, "COMPATIBLE", "ARB_no_such_thing")
    with pytest.raises(MissingError, match=r"does not support GLSL ES 3\.1: it lacks ARB_no_such_thing"):
        runner("essl").run(file_of(SPHEREMAP, "essl"), SPHEREMAP, *given(8))
