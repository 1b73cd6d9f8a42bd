"""`normalbench sweep`: its output, the rows that it keeps, and refused requests."""

import queue
import signal
import sys
from types import SimpleNamespace

import pytest

from normalbench.bench.door.cli import app as cli
from normalbench.bench.run.measuring import beside
from normalbench.bench.tables.sweep import measure as sweep
from normalbench.bench.tables.sweep.charts import charts, frame_label

pytestmark = pytest.mark.usefixtures("gl")


SMALL = ["--size", "96x72", "--lights", "4", "--repeats", "1"]


SWEEP = ["sweep", *SMALL, "--objects", "3,5", "--pipeline", "prepass,hybrid"]


def test_a_bar_label_gives_the_time_and_whether_it_is_too_noisy():
    frame = {"pipeline": "hybrid", "clock": "wall", "ms_frame": 3.0, "ms_frame_spread": 0.5, "ms_lights": 2.0}
    assert frame_label(frame) == "2, too noisy to compare"
    assert frame_label(frame | {"ms_frame_spread": 0.2}) == "2"


def test_pipelines_of_the_same_name_have_separate_bars():
    """With and without a shadow map, pipelines once shared a name in the page's chart, and their bars overlapped."""
    frame = {"pipeline": "hybrid", "clock": "wall", "objects": 100, "ms_frame": 3.0, "ms_frame_spread": 0.5}
    (chart,) = charts([frame | {"shadow": shadow, "ms_lights": 2.0} for shadow in (True, False)])
    assert chart.y.names == ("hybrid with shadow map", "hybrid without shadow map")


def test_rows_of_another_sweep_are_neither_used_nor_deleted(run, tmp_path, monkeypatch):
    """A layout that changes under the same name makes another sweep."""
    monkeypatch.chdir(tmp_path)
    layout = "encoding = 'octahedral'\n[[targets]]\nformat = '{}'\nholds = 'normal.x normal.y'\n"
    measure, rows = sweep.measure, []

    def stopping(device, point):
        if rows:
            raise SystemExit(143)
        rows.append(measure(device, point))
        return rows[0]

    command = (
        "sweep",
        *SMALL,
        "--pipeline",
        "prepass",
        "--objects",
        "3,5",
        "--layout",
        "mine.toml",
        "-o",
        "new/rows.csv",
    )
    (tmp_path / "new").mkdir()
    (tmp_path / "mine.toml").write_text(layout.format("rg8"))
    monkeypatch.setattr(sweep, "measure", stopping)
    with pytest.raises(SystemExit):
        run(*command)
    journal = tmp_path / "new" / ".rows.csv.rows"
    kept = journal.read_text()
    (tmp_path / "mine.toml").write_text(layout.format("rg16f"))
    status, _, err = run(*command)
    assert status == 2 and "has 1 steps of a different sweep command" in err and journal.read_text() == kept
    (tmp_path / "mine.toml").write_text(layout.format("rg8"))
    monkeypatch.setattr(sweep, "measure", measure)
    assert run(*command)[0] == 0 and not journal.exists()


def test_two_sweeps_do_not_share_an_output(run, tmp_path):
    with beside(tmp_path / "rows.csv", {}):
        status, _, err = run(*SWEEP, "-o", str(tmp_path / "rows.csv"))
    assert status == 2 and "another process is writing" in err and err.count("\n") == 1


@pytest.mark.parametrize(
    "arguments, said",
    [
        (["--objects", "100,x"], "comma-separated"),
        (["--objects", "0"], "numbers from 1"),
        (["--objects", "9" * 5000], "numbers from 1"),
        (["--samples", "0"], "--samples 0: out of range; use 1 to 64"),
        (["--scale", "2"], "use 0.05 to 1"),
        (["--layout", ""], "no layout named"),
        (["--objects", ""], "numbers from 1"),
        (["--size", "0x0"], "WIDTHxHEIGHT"),
        (["--plot", "plot.jpg"], "unsupported plot format; use one of .png, .svg, .pdf"),
        (["--plot", "."], "is a folder"),
        (["--pipeline", "none"], "unknown pipeline 'none'"),
        (["-o", "."], "is a folder"),
        (["--layout", "normal_depth", "--pipeline", "hybrid"], "hybrid needs"),
    ],
)
def test_bad_sweep_is_a_one_line_error_and_nothing_is_written(run, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("sweep", *arguments)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err
    assert not list(tmp_path.iterdir())


def test_a_delayed_interruption_does_not_end_the_program_twice(monkeypatch):
    """An interruption during an import is delayed, and is dropped if another interruption ends the program first."""
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    monkeypatch.setattr(cli, "ending", [])
    before = signal.getsignal(signal.SIGALRM)
    importing = SimpleNamespace(f_code=SimpleNamespace(co_filename="<frozen importlib._bootstrap>"), f_back=None)
    try:
        cli._end(signal.SIGINT, importing)
        with pytest.raises(KeyboardInterrupt):
            cli._end(signal.SIGINT, None)
        assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
        signal.raise_signal(signal.SIGALRM)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


class Interrupted:
    """An object that is interrupted as it is freed, where Python swallows exceptions."""

    def __del__(self):
        cli._end(signal.SIGTERM, None)


def test_an_interruption_swallowed_by_a_callback_ends_a_waiting_program(monkeypatch):
    """A worker that waits for its next job takes no step at which the interruption would be raised again."""
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    monkeypatch.setattr(cli, "ending", [])
    before = signal.getsignal(signal.SIGALRM)
    try:
        Interrupted()
        with pytest.raises(SystemExit) as ended:
            queue.SimpleQueue().get(timeout=20)
        assert ended.value.code == cli.TERMINATED
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
