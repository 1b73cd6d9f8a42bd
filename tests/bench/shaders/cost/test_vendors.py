"""What holds for every vendor's compiler: nothing costs nothing, kinds add up, rows are kept, and its failures are its
own. Figures of one vendor stand in the vendor's file."""

import sys
import threading
import time
from pathlib import Path

from normalbench.bench.shaders.isa import process as isa_process


def test_a_reader_that_starts_late_meets_no_closed_stream(monkeypatch):
    """As on a busy machine: the child is left at once, and its thread has only then begun to read."""
    script = "print('{}', flush=True); input()"
    monkeypatch.setattr(isa_process, "CHILD", [sys.executable, "-c", script])
    read, errors, ended = isa_process._read, [], threading.Event()

    def late(stream, lines):
        time.sleep(0.3)
        try:
            read(stream, lines)
        except ValueError as error:
            errors.append(error)
        ended.set()

    monkeypatch.setattr(isa_process, "_read", late)
    driver = isa_process.Driver(Path("none.json"), threading.Event())
    with isa_process.child({}, driver, {}):
        pass
    assert ended.wait(10) and not errors, errors
