"""Nothing that `--on` or `worker` starts can be reached from the network, and TLS is as the manual says."""

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
from test_listening import NORMALBENCH

# Long enough for ten looks at its sockets while the workers are there.
LONG = ("quality", "--encoding", "all", "--storage", "rgba8", "--normals", "sphere", "--count", "2^20")


LONG += ("--on", "local:4")


# 127.0.0.1, ::1 and the former as IPv6, as the kernel writes them: words of 32 bits in the machine's own order.
HERE = {"0100007F", "00000000000000000000000001000000", "0000000000000000FFFF00000100007F"}


LISTENS = "0A"


MANUAL = PAGES[ROOT / "docs" / "workers.md"]


def family_of(pid: int) -> set[int]:
    """A process and all that it started."""
    parents = {}
    for folder in (path for path in Path("/proc").iterdir() if path.name.isdecimal()):
        with suppress(OSError):
            parents[int(folder.name)] = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
    found = {pid}
    while more := {child for child, parent in parents.items() if parent in found} - found:
        found |= more
    return found


def sockets_of(pid: int) -> set[str]:
    """The inodes of a process's sockets; none of one that has just ended."""
    found = set()
    with suppress(OSError):
        for path in Path(f"/proc/{pid}/fd").iterdir():
            with suppress(OSError):
                if match := re.fullmatch(r"socket:\[(\d+)\]", str(path.readlink())):
                    found.add(match[1])
    return found


def listening(pid: int) -> list[str]:
    """The addresses that a process and all that it started listen on."""
    inodes = set().union(*map(sockets_of, family_of(pid)))
    rows = [line.split() for name in ("tcp", "tcp6") for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]]
    return [row[1].partition(":")[0] for row in rows if row[3] == LISTENS and row[9] in inodes]


def looked_at(process: subprocess.Popen, fewest: int, looks: int = 10) -> None:
    """Looks at a command's sockets, from when there are so many that listen: all are this machine's own."""
    seen, until = [], time.monotonic() + 120
    while process.poll() is None and time.monotonic() < until and len(seen) < looks:
        addresses = listening(process.pid)
        assert set(addresses) <= HERE, f"listens on {sorted(set(addresses) - HERE)}, see /proc/net/tcp"
        if len(addresses) >= fewest:
            seen.append(addresses)
        time.sleep(0.1)
    assert len(seen) == looks, f"{len(seen)} looks at {fewest} sockets or more; the command ended: {process.poll()}"


@pytest.fixture
def started():
    """Starts a program, which ends with the test."""
    there = []

    def start(command: list[str], **named) -> subprocess.Popen:
        there.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True, **named))
        return there[-1]

    yield start
    for one in reversed(there):
        one.terminate()
        one.communicate(timeout=30)


def test_local_workers_listen_nowhere(started, tmp_path):
    """Ten looks at the sockets of a command and its four workers, all of which measure by then."""
    process, seen, until = started([*NORMALBENCH, *LONG, "-o", str(tmp_path / "rows.json")]), 0, time.monotonic() + 120
    while process.poll() is None and time.monotonic() < until and seen < 10:
        assert not listening(process.pid)
        kept = tmp_path / ".rows.json.rows"
        seen += kept.exists() and len(family_of(process.pid)) > 4
        time.sleep(0.1)
    assert seen == 10, f"{seen} looks; the command ended: {process.poll()}"


def test_a_worker_listens_where_it_reaches_its_scheduler():
    """Two sockets: what is sent to workers, and what dask serves over HTTP."""
    with scheduled({}) as there:
        looked_at(there.workers[0], fewest=2)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_worker_that_is_ended_leaves_no_file(tmp_path, number):
    """Neither of its orders nor of dask's."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    words = ("quality", "--encoding", "xy", "--storage", "rg8", "--normals", "axes", "--backend", "jax", "--on")
    with scheduled({"TMPDIR": str(temporary)}) as there:
        subprocess.run([*NORMALBENCH, *words, there.address], check=True, capture_output=True)
        assert [*temporary.iterdir()]
        there.workers[0].send_signal(number)
        there.workers[0].wait(30)
        assert not [*temporary.iterdir()], "a folder is left"


def test_local_workers_want_no_certificates_and_leave_nothing_behind(tmp_path):
    words = (
        "quality",
        "--encoding",
        "xy",
        "--storage",
        "rg8",
        "--normals",
        "axes",
        "--backend",
        "jax",
        "--on",
        "local:2",
    )
    variables = os.environ | {"DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION": "True", "TMPDIR": str(tmp_path)}
    done = subprocess.run([*NORMALBENCH, *words], capture_output=True, text=True, env=variables)
    assert done.returncode == 0 and not done.stderr, done.stderr
    assert not [*tmp_path.iterdir()], "something is left"


def block(name: str) -> list[str]:
    return re.search(rf"<!-- tls {name} -->\n```text\n(.*?)```", MANUAL, re.S)[1].splitlines()


def free_port() -> int:
    with socket.socket() as free:
        free.bind((HOST, 0))
        return free.getsockname()[1]


def test_the_manuals_commands_measure_over_tls(started, tmp_path):
    """On this machine's address and free ports. Who has no certificate is refused."""
    (certificate,) = block("certificate")
    subprocess.run(shlex.split(certificate), cwd=tmp_path, check=True, capture_output=True)
    secret = dict(line.split("=") for line in block("variables"))
    port, there = str(free_port()), {"cwd": tmp_path, "env": os.environ | secret}
    commands = [
        shlex.split(line.replace("10.0.0.5", HOST).replace("8786", port).replace("8787", str(free_port())))
        for line in block("commands")
    ]
    scheduler, worker, asks = [[sys.executable, "-m", *words] for words in commands]
    looked_at(started(scheduler, **there), fewest=2, looks=1)
    looked_at(started(worker, **there), fewest=2, looks=1)
    rows = subprocess.run([*asks, "--backend", "jax", "--format", "csv"], capture_output=True, text=True, **there)
    alone = subprocess.run([*asks[:-2], "--backend", "jax", "--format", "csv"], capture_output=True, text=True, **there)
    assert rows.returncode == 0 and rows.stdout == alone.stdout, rows.stderr
    stranger = subprocess.run(asks, capture_output=True, text=True, cwd=tmp_path)
    assert stranger.returncode == 2 and "check your TLS configuration" in stranger.stderr
    plain = subprocess.run([*asks[:-1], f"tcp://{HOST}:{port}"], capture_output=True, text=True, **there)
    assert plain.returncode == 2 and len(plain.stderr.splitlines()) == 1 and "encryption required" in plain.stderr
