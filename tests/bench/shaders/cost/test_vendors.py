"""Rules for every vendor's compiler: the identity costs nothing, kinds add up, rows are cached, and failures affect
only its own rows. Figures of a vendor are in the vendor's own file."""

import sys
import threading
import time
from pathlib import Path

from normalbench.bench.shaders.isa import process as isa_process


def test_late_reader_does_not_find_a_closed_stream(monkeypatch):
    """On a busy machine the child may end before its reading thread has begun to read."""
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
