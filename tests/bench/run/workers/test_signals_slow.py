"""Signals that end a waiting worker, whichever of its threads receives them."""

import subprocess
import sys

PROGRAM = """
import os, signal, threading, time
from normalbench.bench.run.workers.worker import MainThread

def end(*_):
    raise SystemExit(7)

def given_to_this_thread():
    time.sleep(0.2)
    signal.pthread_kill(threading.get_ident(), signal.SIGTERM)
    threading.Event().wait()

signal.signal(signal.SIGTERM, end)
threading.Thread(target=given_to_this_thread, daemon=True).start()
try:
    MainThread().serve()
except SystemExit as ended:
    os._exit(ended.code)
"""


def test_signal_delivered_to_another_thread_ends_a_worker():
    assert subprocess.run([sys.executable, "-c", PROGRAM], timeout=60).returncode == 7
