"""Processes that `--on` or `worker` starts cannot be reached from the network, and TLS works as in the manual."""

import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest
from manual import PAGES, ROOT
from speed.scheduled import HOST, scheduled

NORMALBENCH = [sys.executable, "-m", "normalbench"]


# Long enough for four looks at its sockets while the workers are there.
LONG = ("quality", "--encoding", "all", "--storage", "rgba8", "--normals", "sphere", "--count", "2^18")


LONG += ("--on", "local:2")


# 127.0.0.1, ::1 and the former as IPv6, as the kernel writes them: words of 32 bits in the machine's own order.
HERE = {"0100007F", "00000000000000000000000001000000", "0000000000000000FFFF00000100007F"}


LISTENS = "0A"


MANUAL = PAGES[ROOT / "docs" / "workers.md"]


def family_of(pid: int) -> set[int]:
    """Return a process and all its descendants."""
    parents = {}
    for folder in (path for path in Path("/proc").iterdir() if path.name.isdecimal()):
        with suppress(OSError):
            parents[int(folder.name)] = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
    family = {pid}
    while more := {child for child, parent in parents.items() if parent in family} - family:
        family |= more
    return family


def sockets_of(pid: int) -> set[str]:
    """Return the inodes of a process's sockets; an empty set if the process has just ended."""
    inodes = set()
    with suppress(OSError):
        for path in Path(f"/proc/{pid}/fd").iterdir():
            with suppress(OSError):
                if match := re.fullmatch(r"socket:\[(\d+)\]", str(path.readlink())):
                    inodes.add(match[1])
    return inodes


def listening(pid: int) -> list[str]:
    """Return the addresses on which a process and its descendants listen."""
    inodes = set().union(*map(sockets_of, family_of(pid)))
    rows = [line.split() for name in ("tcp", "tcp6") for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]]
    return [row[1].partition(":")[0] for row in rows if row[3] == LISTENS and row[9] in inodes]


def looked_at(process: subprocess.Popen, fewest: int) -> None:
    """Wait until at least this many sockets of a command listen, and check that all use addresses of this machine."""
    addresses, until = [], time.monotonic() + 120
    while process.poll() is None and time.monotonic() < until and len(addresses) < fewest:
        time.sleep(0.1)
        addresses = listening(process.pid)
        assert set(addresses) <= HERE, f"listens on {sorted(set(addresses) - HERE)}, see /proc/net/tcp"
    assert len(addresses) >= fewest, f"{len(addresses)} sockets of {fewest}; the command ended: {process.poll()}"


@pytest.fixture
def started():
    """A function that starts a program, which ends with the test."""
    there = []

    def start(command: list[str], **named) -> subprocess.Popen:
        there.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True, **named))
        return there[-1]

    yield start
    for process in reversed(there):
        process.terminate()
        process.communicate(timeout=30)


def test_local_workers_open_no_listening_sockets(started, tmp_path):
    """The sockets are checked four times while a command and its two workers measure."""
    process, seen, until = started([*NORMALBENCH, *LONG, "-o", str(tmp_path / "rows.json")]), 0, time.monotonic() + 120
    while process.poll() is None and time.monotonic() < until and seen < 4:
        assert not listening(process.pid)
        kept = tmp_path / ".rows.json.rows"
        seen += kept.exists() and len(family_of(process.pid)) > 2
        time.sleep(0.1)
    assert seen == 4, f"{seen} looks; the command ended: {process.poll()}"


@pytest.mark.drawn(3)
def test_a_stopped_worker_leaves_no_file(tmp_path, number=signal.SIGTERM):
    """The files of the worker's tasks and of Dask are removed."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    words = ("quality", "--encoding", "xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax", "--on")
    with scheduled({"TMPDIR": str(temporary)}) as there:
        subprocess.run([*NORMALBENCH, *words, there.address], check=True, capture_output=True)
        assert [*temporary.iterdir()]
        there.workers[0].send_signal(number)
        there.workers[0].wait(30)
        assert not [*temporary.iterdir()], "a folder is left"


@pytest.mark.drawn(3)
@pytest.mark.parametrize("command", [("quality", "--normals", "axes", "--on"), ("worker",)], ids=["on", "worker"])
@pytest.mark.parametrize(
    ("scheme", "encrypts", "says"),
    [("tls", "False", "check your TLS configuration"), ("tcp", "True", "encryption required")],
)
def test_a_tls_error_ends_with_a_line_from_dask(command, scheme, encrypts, says):
    """The error comes in seconds: certificates are missing, or the address lacks TLS but encryption is required."""
    variables = os.environ | {"DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION": encrypts}
    words = [*NORMALBENCH, *command, f"{scheme}://127.0.0.1:1"]
    done = subprocess.run(words, capture_output=True, text=True, env=variables, timeout=30)
    assert done.returncode == 2 and says in done.stderr.splitlines()[-1] and "Traceback" not in done.stderr, done.stderr


def block(name: str) -> list[str]:
    return re.search(rf"<!-- tls {name} -->\n```text\n(.*?)```", MANUAL, re.S)[1].splitlines()


def free_port() -> int:
    with socket.socket() as free:
        free.bind((HOST, 0))
        return free.getsockname()[1]


def test_the_manuals_commands_measure_over_tls(run, started, tmp_path):
    """The commands run with this machine's address and free ports."""
    (certificate,) = block("certificate")
    subprocess.run(shlex.split(certificate), cwd=tmp_path, check=True, capture_output=True)
    secret = dict(line.split("=") for line in block("variables"))
    port, there = str(free_port()), {"cwd": tmp_path, "env": os.environ | secret}
    commands = [
        shlex.split(line.replace("10.0.0.5", HOST).replace("8786", port).replace("8787", str(free_port())))
        for line in block("commands")
    ]
    scheduler, worker, asks = [[sys.executable, "-m", *words] for words in commands]
    looked_at(started(scheduler, **there), fewest=2)
    looked_at(started(worker, **there), fewest=2)
    csv = ("--backend", "jax", "--format", "csv")
    rows = subprocess.run([*asks, *csv], capture_output=True, text=True, **there)
    status, alone, _ = run(*commands[-1][1:-2], *csv)
    assert (rows.returncode, status) == (0, 0) and rows.stdout == alone, rows.stderr
