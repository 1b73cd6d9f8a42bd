"""The cost table with a cold, warm or damaged cache, and with parts that are missing, fail or hang."""

import contextlib
import io
import shutil
import sys

import pytest

from normalbench.bench.door.cli import app as cli
from normalbench.bench.door.run_options import RunOptions
from normalbench.bench.ground.options.option import fields_of
from normalbench.bench.ground.output import cache
from normalbench.bench.shaders.isa import compiler, driver_files, isa

EVERY = ["--isa", "--format", "json"]


WORDS = ["--encoding", "spheremap", "--family", "navi21", "--storage", "rgba8", "--stage", "fragment"]


SMALL = ["cost", *EVERY, *WORDS]


@pytest.fixture(scope="module")
def compiled_once(radv, tmp_path_factory):  # noqa: ARG001 (asks for the compilers)
    """A cache with everything that SMALL compiles, and the command's result."""
    folder, out = tmp_path_factory.mktemp("filled"), io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(out):
        patch.setenv("XDG_CACHE_HOME", str(folder))
        patch.setattr(sys, "argv", ["normalbench", *SMALL])
        status = cli.main()
    return folder, (status, out.getvalue(), "")


@pytest.fixture
def first(compiled_once, own_cache):
    """The result of SMALL, with everything that it compiles already in this test's cache."""
    folder, printed = compiled_once
    shutil.copytree(folder, own_cache)
    return printed


def test_fingerprint_depends_on_the_build_id_and_the_size(tmp_path):
    file, head = tmp_path / "libvulkan_radeon.so", bytes(range(256)) * 16
    file.write_bytes(head + b"code")
    first = compiler.fingerprint(file)
    file.write_bytes(b"\x00\x01" + head[:1] + head[3:] + b"code")
    other_id = compiler.fingerprint(file)
    file.write_bytes(head + b"code and more")
    assert len({first, other_id, compiler.fingerprint(file)}) == 3


def test_driver_environment_drops_the_users_driver_settings(monkeypatch, tmp_path):
    ours = {"RADV_DEBUG": "nocache", "RADV_PERFTEST": "x", "ACO_DEBUG": "x", "NIR_DEBUG": "x", "AMD_DEBUG": "x"}
    ours |= {"VK_INSTANCE_LAYERS": "x", "VK_LOADER_DRIVERS_SELECT": "x", "VK_ADD_DRIVER_FILES": "x", "MESA_EXTRA": "x"}
    for name, value in (ours | {"RADV_FORCE_FAMILY": "gfx1201", "HOME": "/home/somebody"}).items():
        monkeypatch.setenv(name, value)
    for family in ("navi21", None):
        told = isa._variables(family, family) if family else {}
        variables = driver_files.environment(tmp_path / "radeon.json", told)
        assert not set(ours) & set(variables) and variables.get("RADV_FORCE_FAMILY") == family
        assert variables["HOME"] == "/home/somebody" and variables["VK_DRIVER_FILES"] == str(tmp_path / "radeon.json")


def test_unwritable_cache_is_not_an_error(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    cache.write("00", {"a": 1})
    assert cache.read("00") is None


def test_the_help_of_run_lists_cost():
    assert "cost" in fields_of(RunOptions)["tables"].option.help


@pytest.mark.parametrize(
    "words, said",
    [
        (["--encoding", "nope"], "unknown encoding 'nope'"),
        (["--family", "gcn"], "unknown family 'gcn'; did you mean vega10? known: all, polaris10"),
        (["--stage", "vertex"], "unknown stage 'vertex'"),
        (["--operation", "sign"], "unknown operation 'sign'"),
        (["--storage", "13-13"], "unknown storage '13-13'"),
        (["--repeats", "1"], "--repeats 1"),
        (["--disassembly", "d", "--time"], "--disassembly requires --isa"),
    ],
)
def test_bad_input_is_a_one_line_error(run, monkeypatch, tmp_path, words, said):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("cost", *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err
    assert not list(tmp_path.iterdir())
