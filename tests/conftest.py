"""Strict JAX settings, and the OpenGL device. If CI is set, tests that need a missing OpenGL driver fail."""

import fcntl
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from compiled import COMPILED

# XLA compiles each program once for all tests, their processes and the next run.
os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(COMPILED / "jax"))
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0")
os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES", "-1")
# As the program does; without it OpenBLAS waits for work in a loop that takes a whole core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# llvmpipe draws in the thread that asks: threads of four processes would wait for one another on two cores.
os.environ.setdefault("LP_NUM_THREADS", "0")
# On a busy machine any run may take long enough to say how far it is.
os.environ.setdefault("NORMALBENCH_NO_PROGRESS", "1")

import jax
import kept_runs
import pytest
import seconds
import shared_rows
from languages import SHORT
from slowly import is_drawn
from tiers import TIERS, is_in, tier_of

from normalbench.bench.door import run_code
from normalbench.bench.door.cli import app as cli
from normalbench.bench.ground.compilers import tools as compilers
from normalbench.bench.ground.machine.memory import (
    give_back_what_a_table_needed,
    give_back_what_is_freed,
    have_few_heaps,
    keep_what_is_imported,
    look_for_garbage_seldom,
)
from normalbench.bench.ground.options.gpu_families import ANV, HASVK, RADV
from normalbench.bench.keep import answers
from normalbench.bench.measures.metrics import published
from normalbench.bench.run import measuring
from normalbench.bench.shaders.isa import driver_files, isa, null_device, spirv
from normalbench.bench.shaders.isa.nvidia import tools
from normalbench.gbuffer.gl.device import NoDeviceError, device

# What a process of the tests may hold on to between two tests, in bytes.
LARGE = 1_200_000_000
# By how much more than that, or than what was left the last time, before memory is given back again: it takes seconds.
GROWN = 200_000_000
pytest_plugins = ["pytester"]
jax.config.update("jax_numpy_rank_promotion", "raise")
jax.config.update("jax_numpy_dtype_promotion", "strict")


def pytest_addoption(parser):
    parser.addoption("--tier", choices=TIERS, default=TIERS[0], help="which tests: quick ones, slow ones too, or all")
    parser.addoption("--firefox", action="store_true", help="open pages in Firefox: pytest tests/reports --firefox")
    parser.addoption("--seconds", type=Path, metavar="FILE", help="write the seconds of each test file into FILE")


def pytest_configure(config):
    if os.environ.get("CI"):
        config.option.normalbench_require_gl = True
    if path := config.option.seconds:
        config.pluginmanager.register(seconds.Seconds(path.absolute()))


def pytest_ignore_collect(collection_path, config):
    """Leave out files of tiers that were not requested, unless the command line names them."""
    if is_in(collection_path, config.option.tier):
        return None
    named = {Path(word.partition("::")[0]).absolute() for word in config.args}
    return None if collection_path in named else True


# What takes seconds to begin with.
LONG_FIXTURES = frozenset(
    {"browser", "gl_browser", "browser_path", "results", "scheduler", "radv", "intel", "nvidia", "vendor_rows"}
)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items, config):
    """Skip tests that Firefox cannot run, and deselect tests that are not drawn for this commit."""
    for item in items:
        if config.option.firefox and (mark := item.get_closest_marker("chromium")):
            item.add_marker(pytest.mark.skip(reason=mark.args[0]))
    if config.option.tier != TIERS[-1] and not any("::" in word for word in config.args):
        _leave_out_undrawn(items, config)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Fail a test in a quick file if it opens a browser, starts workers or asks for a vendor's compilers."""
    if tier_of(item.path) == TIERS[0] and (asked := LONG_FIXTURES.intersection(item.fixturenames)):
        pytest.fail(f"it asks for {', '.join(asked)}: move it to a file test_..._slow.py", pytrace=False)


def _leave_out_undrawn(items, config):
    """Deselect tests that are not drawn for this commit."""
    marks = [(item, item.get_closest_marker("drawn")) for item in items]
    undrawn = {item for item, mark in marks if mark and not is_drawn(item.nodeid, *mark.args)}
    config.hook.pytest_deselected(items=list(undrawn))
    items[:] = [item for item in items if item not in undrawn]


def pytest_collection_finish():
    """Exclude all existing objects from garbage collection and set memory limits, as a run does."""
    look_for_garbage_seldom()
    keep_what_is_imported()
    have_few_heaps()


@pytest.fixture(scope="session")
def held():
    """A one-item list: the bytes that this process may hold before it gives memory back; the next fixture sets it."""
    return [LARGE]


@pytest.fixture(autouse=True)
def memory_is_given_back(held):
    """Memory given back after a test. A command would keep it for the next step, but tests would hold gigabytes."""
    yield
    if _resident_bytes() > held[0]:
        for give_back in (give_back_what_is_freed, give_back_what_a_table_needed):
            if _resident_bytes() > LARGE:
                give_back()
        held[0] = max(LARGE, _resident_bytes() + GROWN)


def _resident_bytes() -> int:
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0


@pytest.fixture(scope="session", autouse=True)
def spirv_is_kept():
    """SPIR-V compiled once, like XLA's programs, because tests with an empty cache would compile it repeatedly."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(compilers, "_piped", kept_runs.kept(compilers._piped, COMPILED / "spirv"))
        yield


@pytest.fixture(scope="session")
def gl():
    try:
        return device()
    except NoDeviceError as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error))


@pytest.fixture
def rows_are_shared(monkeypatch, shared_folder):
    """Rows measured once for all tests that use this fixture; not for tests that change how something is measured."""
    monkeypatch.setattr(measuring.Here, "measure", shared_rows.shared(measuring.Here.measure, shared_folder / "rows"))


@pytest.fixture
def run(monkeypatch, capsys):
    """The command line in this process: a function from arguments to status, output and errors."""
    monkeypatch.setattr(run_code, "LANGUAGES", SHORT)
    # What one test changes in this process decides no answer of another.
    monkeypatch.setattr(answers, "key_of_answer", lambda *_: "")

    def command(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["normalbench", *arguments])
        status = cli.main()
        return status, *capsys.readouterr()

    return command


@pytest.fixture(scope="session")
def radv():
    """Mesa's compiler for AMD GPUs and the SPIR-V tools; if CI is set, tests fail on a machine without them."""
    _need([RADV], {spirv.COMPILER: spirv.NO_COMPILER, spirv.OPTIMISER: spirv.NO_OPTIMISER})


@pytest.fixture(scope="session")
def intel(radv):  # noqa: ARG001 (asks for the other compilers)
    """Intel's compilers, and the compiler that builds their null device."""
    _need([ANV, HASVK], {null_device.COMPILER: null_device.NO_COMPILER})


@pytest.fixture(scope="session")
def nvidia(radv):  # noqa: ARG001 (asks for the other compilers)
    """NVIDIA's CUDA compiler, which users install themselves; without it the tests are skipped, even in CI."""
    if reason := tools.missing():
        pytest.skip(reason)


def _need(libraries: list[str], tools: dict[str, str]) -> None:
    """Skip the test if a driver or a tool is missing; if CI is set, fail instead."""
    missing = [driver_files.no_driver(library) for library in libraries if isa.driver_file(library) is None]
    missing += [reason for tool, reason in tools.items() if not shutil.which(tool)]
    if missing and not os.environ.get("CI"):
        pytest.skip(missing[0])
    assert not missing


PICTURED = ",".join((*published.PICTURED, "octahedral_precise", "spheremap_classic"))
SMALL_RUN = ("run", "--tables", "quality", "--encoding", PICTURED, "--storage", "rgba8", "--count", "65536")


@pytest.fixture(scope="session")
def shared_folder(tmp_path_factory):
    """A folder that all processes of this pytest run share."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session")
def once(shared_folder):
    """A function `once(name, do)` that calls `do` once for all workers; if `do` fails, the next worker calls it."""

    def done_once(name, do):
        with (shared_folder / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not (path := shared_folder / f"{name}.json").exists():
                path.write_text(json.dumps(do()))
        return json.loads(path.read_text())

    return done_once


@pytest.fixture(scope="session")
def results(once, tmp_path_factory):
    """A run of the quality table from the command line: its folder, and its output to stdout and stderr.

    All workers share the run.
    """

    def made():
        folder = tmp_path_factory.mktemp("made") / "results"
        command = [sys.executable, "-m", "normalbench", *SMALL_RUN, "-o", str(folder)]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        warned = re.sub(r"^normalbench: \d+ s, .*\n", "", done.stderr, flags=re.M)  # how far it was
        return str(folder), done.stdout, warned

    folder, *outputs = once("results", made)
    return Path(folder), *outputs


@pytest.fixture(scope="session")
def browser_path(request):
    """The browser that opens reports; if CI is set, tests that need it fail on a machine without it."""
    name = "firefox-esr" if request.config.option.firefox else "chromium"
    path = shutil.which(name)
    if not path and not os.environ.get("CI"):
        pytest.skip(f"no {name} to open reports in; install it (Debian: apt-get install {name})")
    assert path, f"no {name}"
    return path


@pytest.fixture
def own_cache(monkeypatch, tmp_path):
    """An empty cache folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache"


OPENED: list[str] | None = None


def _listen(event: str, arguments: tuple) -> None:
    watched = event in ("open", "socket.connect", "socket.getaddrinfo", "urllib.Request")
    if OPENED is not None and watched and not str(arguments[0]).startswith(os.environ["JAX_COMPILATION_CACHE_DIR"]):
        OPENED.append(str(arguments[0]))


sys.addaudithook(_listen)


@pytest.fixture
def opened():
    """Every file opened and every address requested while a test runs."""
    global OPENED
    OPENED = []
    yield OPENED
    OPENED = None
