"""What `normalbench sweep` prints, keeps and refuses."""

import json
import signal
import subprocess
import sys

import pytest
from test_sweep import SWEEP

from normalbench.bench.tables.sweep import measure as sweep

pytestmark = pytest.mark.usefixtures("gl")


def test_a_stopped_sweep_goes_on_where_it_was(run, tmp_path, monkeypatch):
    """Rows that were measured before are kept to the last digit, a line that was cut off is measured again."""
    output = tmp_path / "rows.json"
    measure, measured = sweep.measure, []

    def stopping(device, point):
        if len(measured) == 3:
            raise KeyboardInterrupt
        measured.append(point)
        return measure(device, point)

    monkeypatch.setattr(sweep, "measure", stopping)
    status, out, err = run(*SWEEP, "--format", "json", "-o", str(output))
    assert (status, out) == (130, "") and "3 of 8 steps are kept; the same command goes on" in err
    journal = tmp_path / ".rows.json.rows"
    _, *lines = [json.loads(line) for line in journal.read_text().splitlines()]
    kept = [row for line in lines for row in line["rows"]]
    with journal.open("a") as file:
        file.write('{"pipeline": "pre')
    monkeypatch.setattr(sweep, "measure", lambda device, point: measured.append(point) or measure(device, point))
    status, _, err = run(*SWEEP, "--format", "json", "-o", str(output))
    assert status == 0 and "3 of 8 steps were measured before" in err and len(measured) == 8
    rows = json.loads(output.read_text())
    assert rows[:3] == kept and len(rows) == 8 and not journal.exists()


def test_ctrl_c_in_a_callback_that_swallows_it_still_ends_the_program(tmp_path):
    """As JAX's does in the garbage collector: no traceback, and the next step ends."""
    program = (
        "import gc, os, signal, sys\n"
        "from normalbench.bench.door.cli import app as cli\n"
        "def callback(*_):\n"
        # A step is kept: others are under way.
        "    if not sent and any(file.stat().st_size for file in os.scandir(folder)):\n"
        "        sent.append(os.kill(os.getpid(), signal.SIGINT))\n"
        "sent, folder = [], os.path.dirname(sys.argv[-1])\n"
        "gc.callbacks.append(callback)\n"
        "gc.set_threshold(100)\n"
        "cli.program()\n"
    )
    command = [sys.executable, "-c", program, *SWEEP, "-o", str(tmp_path / "rows.csv")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode in (130, -signal.SIGINT), done.stderr
    assert "steps are kept" in done.stderr and "Traceback" not in done.stderr and "ignored" not in done.stderr
