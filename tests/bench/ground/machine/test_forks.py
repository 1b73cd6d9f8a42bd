"""Processes that are forked from a process with the needed imports behave like separate processes."""

import os
import signal
import subprocess
import sys
import time

import pytest

from normalbench.bench.ground.machine.cores import on_all_cores
from normalbench.bench.ground.machine.systems import forks, linux_forks

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere each process imports for itself")


MODULE = """
import os, signal, subprocess, sys, time

made = os.getpid()


def main(words):
    exec(words[0])
"""


@pytest.fixture
def ended(monkeypatch, tmp_path):
    """A function that runs a line of Python in a forked process, and returns the finished process."""
    (tmp_path / "tried.py").write_text(MODULE)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, (str(tmp_path), os.environ.get("PYTHONPATH")))))
    yield lambda line, seconds=30.0: forks.finished("tried", [line], seconds)
    linux_forks._forking.end()


def is_there(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def test_each_fork_has_its_own_status_output_folder_and_variables(ended, monkeypatch, tmp_path):
    """The folder and variables are those at the time of the request; the forking process imports only once."""
    first = ended("print(made, os.getpid()); print('e', file=sys.stderr); sys.exit(3)")
    assert (first.returncode, first.stderr) == (3, "e\n")
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("OWN", "1")
    second = ended("print(made, os.getpid()); print(os.getcwd(), os.environ['OWN'])")
    assert second.returncode == 0 and second.stdout.splitlines()[1] == f"{tmp_path}/here 1"
    (importer, pid), (again, other) = (done.stdout.split()[:2] for done in (first, second))
    assert importer == again and len({importer, pid, other}) == 3


def test_an_error_is_reported_and_does_not_affect_the_next_fork(ended):
    done = ended("sys.made = 1; 1 / 0")
    assert done.returncode == 1 and done.stderr.endswith("ZeroDivisionError: division by zero\n")
    assert ended("print(hasattr(sys, 'made'))").stdout == "False\n"


def test_children_of_a_fork_end_with_it(ended):
    """The fork ends by itself or at its time limit."""
    line = "print(subprocess.Popen(['sleep', '60']).pid, flush=True)"
    with pytest.raises(subprocess.TimeoutExpired) as late:
        ended(f"{line}; time.sleep(60)", 0.5)
    started = [int(late.value.output), int(ended(line).stdout)]
    until = time.monotonic() + 10
    while any(map(is_there, started)) and time.monotonic() < until:
        time.sleep(0.02)
    assert not any(map(is_there, started))


@pytest.mark.parametrize("who", ["made", "os.getppid()", "os.getpid()"])
def test_the_next_fork_runs_whatever_process_the_last_fork_killed(ended, who):
    """The killed process is the forking one, the waiting one, or the fork itself."""
    ended("pass")
    done = ended(f"print(1, flush=True); os.kill({who}, signal.SIGKILL); time.sleep(0 if made == {who} else 0.2)")
    assert done.stdout == "1\n" and done.returncode == (0 if who == "made" else -signal.SIGKILL)
    assert ended("print(2)").stdout == "2\n"


def test_a_thread_that_waits_for_a_fork_can_be_stopped(ended):
    """As after Ctrl-C, the fork is killed before its time limit."""

    def interrupted():
        yield "time.sleep(60)"
        time.sleep(2)
        raise KeyboardInterrupt

    outcomes, began = [], time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        list(on_all_cores(lambda line: outcomes.append(ended(line)), interrupted(), forks.stop))
    assert time.monotonic() - began < 20
    assert [done.returncode for done in outcomes] == [-signal.SIGKILL]


@pytest.mark.usefixtures("ended")
def test_a_fork_ends_if_its_requester_is_killed(tmp_path):
    """The requester can no longer end the fork at its time limit."""
    line = f"open({str(tmp_path / 'number')!r}, 'w').write(str(os.getpid())); time.sleep(60)"
    asking = f"from normalbench.bench.ground.machine.systems import forks; forks.finished('tried', [{line!r}], 60)"
    asks = subprocess.Popen([sys.executable, "-c", asking])
    until = time.monotonic() + 30
    while not (tmp_path / "number").is_file() or not (tmp_path / "number").read_text():
        assert time.monotonic() < until
        time.sleep(0.02)
    number = int((tmp_path / "number").read_text())
    assert is_there(number)
    asks.kill()
    asks.wait()
    while is_there(number) and time.monotonic() < until:
        time.sleep(0.02)
    assert not is_there(number)


def test_changed_variables_of_jax_start_a_new_forking_process(ended, monkeypatch):
    """JAX reads its variables when the forking process imports it."""
    first = ended("print(made)").stdout
    monkeypatch.setenv("JAX_ENABLE_X64", "1")
    assert ended("print(made)").stdout != first
