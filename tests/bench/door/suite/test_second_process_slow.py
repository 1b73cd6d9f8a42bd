"""A run with two processes: the answer comes first, rows and files are the same, and no process outlives the run."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import test_second_process

from normalbench.bench.ground.machine.children import environment
from normalbench.bench.keep.runs import read_run
from normalbench.bench.run import piped
from normalbench.bench.show import report
from normalbench.bench.tables.registry import TABLES

cores = test_second_process.cores


# The first process measures `effects`, the second one the others.
CODE = ("--encoding", "octahedral", "--storage", "rg8", "--normals", "axes", "--backend", "jax")


SMALL = ("run", "--tables", "mix,effects,quality", "--effect", "water", *CODE)


@pytest.mark.usefixtures("gl")
def test_two_processes_give_the_same_results_as_one_process(run, tmp_path, cores):
    """Rows and files match a run in one process, and tables are printed in order."""
    printed = {}
    for count in (1, 2):
        cores(count)
        status, printed[count], err = run(*SMALL, "-o", str(tmp_path / str(count)))
        assert status == 0 and err == "", err
    alone, two = (read_run(tmp_path / str(count)).tables for count in (1, 2))
    assert {name: alone[name] for name in sorted(alone)} == {name: two[name] for name in sorted(two)}
    files = [{str(p.relative_to(tmp_path / n)) for p in (tmp_path / n).rglob("*")} for n in ("1", "2")]
    assert files[0] == files[1] and "report.html" in files[1]
    assert len(list((tmp_path / "1/charts").glob("*.svg"))) == report.CHARTS_OF_A_RUN
    assert (tmp_path / "1/charts/mix.png").read_bytes() == (tmp_path / "2/charts/mix.png").read_bytes()
    assert printed[1].replace(f"{tmp_path}/1", "") == printed[2].replace(f"{tmp_path}/2", "")


@pytest.mark.usefixtures("gl")
def test_the_first_process_measures_the_rows_of_a_dead_process(run, tmp_path, cores, monkeypatch):
    """A dead second process costs time but no rows; its last message is shown."""
    cores(2)
    monkeypatch.setattr(piped, "python", lambda _: [sys.executable, "-c", "raise SystemExit('broken')"])
    status, _, err = run(*SMALL, "-o", str(tmp_path / "run"))
    assert status == 0 and read_run(tmp_path / "run").finished, err
    assert set(read_run(tmp_path / "run").tables) == {"mix", "effects", "quality"}
    assert err == "normalbench: broken\n"


@pytest.mark.usefixtures("gl")
def test_an_error_in_the_second_process_is_an_error_of_the_run(run, tmp_path, cores):
    """The error is one line with the same status, and measured rows are kept; here a folder has a file's name."""
    cores(2)
    folder = tmp_path / "run"
    assert run("run", "--tables", "mix", *CODE, "-o", str(folder))[0] == 0
    (folder / TABLES["quality"].files["live"] / "octahedral-rg8.json").mkdir(parents=True)
    status, _, err = run(*SMALL, "-o", str(folder))
    lines = err.splitlines()
    assert status == 2 and len(lines) == 2 and "resuming" in lines[0] and f"cannot write {folder}/live" in lines[1], err
    assert set(read_run(folder).tables) == {"mix", "quality", "effects"}


def children_of(process: int) -> set[int]:
    """Return the processes that a process has started."""
    return {int(word) for path in Path(f"/proc/{process}/task").glob("*/children") for word in path.read_text().split()}


def is_there(process: int) -> bool:
    try:
        return "\nState:\tZ" not in Path(f"/proc/{process}/status").read_text()
    except OSError:
        return False


@pytest.mark.drawn(3)
@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("ended", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_process_outlives_a_run(tmp_path, ended):
    """The second process ends with the first process; the same command resumes with the rows of both processes."""
    signalled = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -signal.SIGKILL}
    words = ("run", "--tables", "effects,depth", "-o", "ended")
    command = [sys.executable, "-m", "normalbench", *words]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        rows, until = tmp_path / "ended/rows.jsonl", time.monotonic() + 120
        while not (rows.exists() and b'"table": "depth"' in rows.read_bytes()):
            assert time.monotonic() < until and process.poll() is None, "no row of the second process"
            time.sleep(0.05)
        others = children_of(process.pid)
        process.send_signal(ended)
        _, err = process.communicate(timeout=30)
    assert process.returncode == signalled[ended]
    if ended != signal.SIGKILL:
        kept, (line, *rest) = rows.read_bytes().count(b"\n"), err.splitlines()
        assert line.startswith(f"normalbench: {kept} of "), err
        assert line.endswith("steps were saved; to resume, run the same command"), err
        assert rest == (["normalbench: interrupted"] if ended == signal.SIGINT else []), err
        assert {path.name for path in rows.parent.iterdir()} == {"rows.jsonl", "run.json"}
    until = time.monotonic() + 10
    while any(map(is_there, others)) and time.monotonic() < until:
        time.sleep(0.05)
    assert others and not any(map(is_there, others)), "the second process is still there"
    assert any(step["table"] == "depth" for step in read_run(tmp_path / "ended").steps)


def test_each_chart_is_drawn_once(run, tmp_path, monkeypatch):
    """A chart's two files come from one drawing."""
    drawn = []
    kept = report._write_chart
    monkeypatch.setattr(report, "_write_chart", lambda one, folder: drawn.append(one.name) or kept(one, folder))
    assert run("run", "--tables", "quality", *CODE, "-o", str(tmp_path / "run"))[0] == 0
    assert sorted(drawn) == sorted({path.stem for path in (tmp_path / "run/charts").iterdir()})


def measured(folder: Path, *more: str, **variables: str) -> str:
    """Measure one codec in another process, with its caches in a folder; return the output."""
    words = ("quality", "--encoding", "octahedral", "--storage", "rg8", "--normals", "axes", "--backend", "jax")
    own = {name: value for name, value in environment().items() if not name.startswith("JAX_")}
    command = [sys.executable, "-m", "normalbench", *words, *more, "--format", "json"]
    done = subprocess.run(
        command, env=own | {"XDG_CACHE_HOME": str(folder)} | variables, capture_output=True, text=True
    )
    assert done.returncode == 0 and not done.stderr, done.stderr
    return done.stdout


def programs(folder: Path) -> dict[str, int]:
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("normalbench/programs/*/*-cache")}


def test_a_second_process_compiles_nothing(tmp_path):
    """The second process finds every program in the cache, and prints the same output."""
    first, files = measured(tmp_path), programs(tmp_path)
    assert files, "nothing was kept"
    assert measured(tmp_path) == first and programs(tmp_path) == files
    damaged = next(tmp_path.glob("normalbench/programs/*/*-cache"))
    damaged.write_bytes(damaged.read_bytes()[:100])
    assert measured(tmp_path) == first, "a damaged program"


def test_compiled_programs_need_not_be_kept(tmp_path):
    measured(tmp_path, "--no-cache")
    assert not [*tmp_path.iterdir()], "without the cache nothing is kept"
