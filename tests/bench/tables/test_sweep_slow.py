"""`normalbench sweep`: its output, the rows that it keeps, and refused requests."""

import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from test_sweep import SWEEP

from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.shots import STAGES
from normalbench.bench.tables.sweep import measure as sweep
from normalbench.gbuffer.scenes.catalogue import SCENES
from normalbench.gbuffer.scenes.setting import Setting

pytestmark = pytest.mark.usefixtures("gl")


def test_a_sweep_counts_the_draws_of_each_pass(run):
    """The light pre-pass draws all surfaces twice; the hybrid pipeline draws general surfaces once."""
    status, out, _ = run(*SWEEP, "--format", "json")
    rows = json.loads(out)
    assert status == 0 and all(tuple(row) == tuple(TABLES["sweep"].empty(STAGES)) for row in rows)
    assert [(r["shadow"], r["objects"], r["pipeline"]) for r in rows] == [
        (shadow, objects, pipeline)
        for shadow in (True, False)
        for objects in (3, 5)
        for pipeline in ("prepass", "hybrid")
    ]
    for row in rows:
        scene = SCENES["objects"].make(Setting(row["objects"], 4))
        general, special = (
            sum(len(p.mesh.triangles) * np.sum([(scene.materials[m].kind != "general") == s for m in p.materials])
                for p in scene.parts)
            for s in (False, True)
        )  # fmt: skip
        assert row["triangles_geometry"] == general + special
        assert row["triangles_material"] == special + (general if row["pipeline"] == "prepass" else 0)
        assert (row["triangles_shadow_map"] > 0) == row["shadow"]


def test_a_sweep_can_write_to_a_pipe(run, tmp_path):
    """A pipe has no journal next to it."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = subprocess.Popen(["cat", str(pipe)], stdout=subprocess.PIPE, text=True)
    status, *_ = run(*SWEEP, "--format", "csv", "-o", str(pipe))
    assert status == 0 and reader.communicate(timeout=20)[0].count("\n") == 9
    assert [path.name for path in tmp_path.iterdir()] == ["pipe"]


def test_a_stopped_sweep_resumes_where_it_stopped(run, tmp_path, monkeypatch):
    """Rows that were measured before are kept to the last digit, and a truncated line is measured again."""
    output = tmp_path / "rows.json"
    measure, measured = sweep.measure, []

    def stopping(device, point):
        if len(measured) == 3:
            raise KeyboardInterrupt
        measured.append(point)
        return measure(device, point)

    monkeypatch.setattr(sweep, "measure", stopping)
    status, out, err = run(*SWEEP, "--format", "json", "-o", str(output))
    assert (status, out) == (130, "") and "3 of 8 steps were saved; to resume, run the same command" in err
    journal = tmp_path / ".rows.json.rows"
    _, *lines = [json.loads(line) for line in journal.read_text().splitlines()]
    kept = [row for line in lines for row in line["rows"]]
    with journal.open("a") as file:
        file.write('{"pipeline": "pre')
    monkeypatch.setattr(sweep, "measure", lambda device, point: measured.append(point) or measure(device, point))
    status, _, err = run(*SWEEP, "--format", "json", "-o", str(output))
    assert status == 0 and "3 of 8 steps are already measured" in err and len(measured) == 8
    rows = json.loads(output.read_text())
    assert rows[:3] == kept and len(rows) == 8 and not journal.exists()


def test_ctrl_c_in_a_callback_that_swallows_it_still_ends_the_program(tmp_path):
    """JAX has such a callback in the garbage collector: no traceback is shown, and the next step ends the program."""
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
    assert "steps were saved" in done.stderr and "Traceback" not in done.stderr and "ignored" not in done.stderr
