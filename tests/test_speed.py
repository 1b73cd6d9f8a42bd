"""The programs of `python -m tests.speed`: consistent measurements, ratios, exponents, and the simulation."""

import json
import shutil

import numpy as np
import pytest
from speed import __main__ as program
from speed import c_baseline, growth, simulate, throughput, timing
from speed.simulate import Costs, Load, simulated
from speed.throughput import WHOLE

from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.tables.registry import TABLES

needs_c = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")


FREE = Costs(start=0, task=0, row=0, byte=0)


@needs_c
def test_the_c_program_does_not_flush_small_numbers_to_zero():
    """A library that is linked with -ffast-math would flush them to zero in the whole process."""
    data = throughput.normals(WHOLE)
    c_baseline.work("xyz", "reading", data.n, data.view)()
    assert np.float64(5e-324) * 1 > 0 and np.float32(1e-45) * np.float32(1) > 0


def test_a_command_reports_wall_and_processor_seconds(capsys):
    program.main(["commands", "--only", "help"])
    (row,) = json.loads(capsys.readouterr().out)
    assert row["typed"] == "normalbench --help" and 0.05 < row["wall_s"] < 30 and 0.05 < row["processor_s"] < 30, row
    assert row["cores"] >= 1 and row["load"] >= 0 and row["byte_code"] in (True, False)


def test_the_exponent_is_the_slope_on_a_log_log_scale():
    """Computed by hand: 2 for 3 x^2, 0 for a constant, and 1.5 for 1, 10 and 1000 seconds at sizes 1, 10 and 100."""
    assert timing.exponent([1, 2, 4], [3, 12, 48]) == pytest.approx(2)
    assert timing.exponent([5, 50], [7, 7]) == pytest.approx(0)
    assert timing.exponent([1, 10, 100], [1, 10, 1000]) == pytest.approx(1.5)
    assert timing.exponent([5, 5], [1, 2]) is None


def test_each_row_has_the_exponent_from_the_next_smaller_size(monkeypatch):
    """Sizes are rounded to available sizes, and each is timed once; here the time is the square root of the size."""
    kind = growth.Kind("", lambda size: size**0.5, (1,), 1, 10**9)
    monkeypatch.setattr(growth, "KINDS", {"codes": kind})
    rows = growth.rows("codes", (2**20, 60000, 65536))
    assert [row["size"] for row in rows] == [2**16, 2**20]
    assert rows[0]["exponent"] is None and rows[1]["exponent"] == pytest.approx(0.5)
    assert rows[0]["microseconds_each"] == pytest.approx(1e6 / 2**8)


@pytest.mark.usefixtures("gl")
def test_timed_work_has_the_requested_size(monkeypatch):
    """The size counts normals of a row, codecs of a table, objects or lights of a frame, or codes of a search."""
    rows, searched, frames = [], [], []
    monkeypatch.setattr(growth, "least_times", lambda works: [works[0](), [1.0]][1])
    monkeypatch.setattr(growth.quality, "rows", lambda cases, _: rows.append(cases) or [])
    monkeypatch.setattr(growth, "worst_case", type("", (), {"__wrapped__": searched.append}))
    monkeypatch.setattr(growth, "_frame", lambda *sizes: frames.append(sizes) or 1.0)
    for over, size in (("normals", 1000), ("codecs", 7), ("codes", 4**6), ("objects", 30), ("lights", 50)):
        assert growth.measure(over, size)["microseconds_each"] == pytest.approx(1e6 / size)
    assert [[case.normal_set.count for case in cases] for cases in rows] == [[1000], [growth.NORMALS] * 7]
    assert len({case.codec.encoding.name for case in rows[1]}) == 7
    assert [codec.codes for codec in searched] == [4**6]
    assert frames == [(30, growth.LIGHTS), (growth.OBJECTS, 50)]


def test_a_row_without_an_opengl_driver_states_the_reason(monkeypatch):
    def missing():
        raise MissingError("no GL driver")

    monkeypatch.setattr(growth, "require_device", missing)
    row = growth.measure("lights", 10)
    assert row["skipped"] == "no GL driver" and row["seconds"] is None


@pytest.mark.parametrize(
    "words, said",
    [
        (["throughput", "--counts", "3"], f"--counts 3: expected whole numbers from {WHOLE} to"),
        (["throughput", "--encoding", "no"], "unknown encoding 'no'"),
        (["growth", "--over", "pixels"], "unknown kind 'pixels'"),
        (["growth", "--sizes", "5"], "--sizes 5: sizes are of one kind; name it, such as --over normals"),
        (["growth", "--over", "lights", "--sizes", "0"], "--sizes 0: expected whole numbers from 1 to"),
        (["simulate", "--record", "no"], "unknown table 'no'"),
    ],
)
def test_bad_input_is_a_one_line_error(words, said):
    with pytest.raises(SystemExit, match=r"^tests\.speed: ") as error:
        program.main(words)
    assert said in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(("workers", "seconds"), [(1, 1024), (4, 256), (64, 16), (2000, 1)])
def test_steps_of_one_second_are_shared_among_workers(workers, seconds):
    """The load has 1024 steps and no other costs."""
    assert simulated(Load([1.0], 1024), workers, FREE).seconds == pytest.approx(seconds)


def test_a_command_that_is_always_busy_is_the_bottleneck():
    """At 10 ms per row, 1000 rows cost the command 10 s with any number of workers; the last step takes 1 s more."""
    outcome = simulated(Load([1.0], 1000), 10**4, Costs(start=0, task=0, row=0.01, byte=0))
    assert outcome.seconds == pytest.approx(11.0) and outcome.command == pytest.approx(10.0)


def test_the_cost_of_preparation_is_paid_once_per_worker():
    """Steps are prepared in 50 s; files are sent in 1 s."""
    assert simulated(Load([1.0], 100, prepare=50), 1, FREE).seconds == pytest.approx(150)
    assert simulated(Load([1.0], 100, prepare=50), 100, FREE).seconds == pytest.approx(51)
    load, costs = Load([1.0], 100, sent=1.0), Costs(start=0, task=0, row=0, byte=1.0)
    assert simulated(load, 1, costs).command == pytest.approx(1)
    assert simulated(load, 100, costs).command == pytest.approx(100)


def test_timed_steps_are_measured_one_at_a_time():
    assert simulated(Load([1.0], 100, is_timed=True), 80, FREE).seconds == pytest.approx(100)


def test_a_new_record_keeps_the_other_records(tmp_path, monkeypatch):
    """The table is recorded with a few of its steps; the nightly test uses all."""
    few = TABLES["vectors"].options(encoding="linear", storage="rg8")
    own = simulate.asked
    monkeypatch.setattr(simulate, "asked", lambda table, _, outputs: own(table, few, outputs))
    check_record(tmp_path / "record.json", monkeypatch, few)


def check_record(path, monkeypatch, options) -> None:
    """Check that recording `vectors` keeps the other records and stores the seconds of each selected step."""
    path.write_text(json.dumps({"scenes": 1, "seconds": {"render": [5]}, "bytes": {"render": 7}}))
    monkeypatch.setattr(simulate, "measured_costs", lambda: FREE)
    simulate.record(["vectors"], path)
    record = json.loads(path.read_text())
    times = record["seconds"].pop("vectors")
    assert times and all(time >= 0 for time in times) and record["bytes"].pop("vectors") == 0
    assert record == {"scenes": 1, "seconds": {"render": [5]}, "bytes": {"render": 7}, "costs": vars(FREE)}
    assert len(times) == len(TABLES["vectors"].work.steps(options, TABLES["vectors"].outputs()))
