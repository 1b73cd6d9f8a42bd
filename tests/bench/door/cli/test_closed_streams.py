"""Standard input, output or error may be closed when the program starts: no other file takes its place."""

import itertools
import subprocess
import sys

import pytest

CLOSED = [closed for count in (1, 2, 3) for closed in itertools.combinations((0, 1, 2), count)]


def started(closed, *words, **more):
    """Run the program with some of its standard streams closed; return the finished process."""
    return without_streams(closed, [sys.executable, "-m", "normalbench", *words], **more)


def without_streams(closed, command, **more):
    """Run a command with streams closed by a shell, because JAX warns about forks; return the finished process."""
    closing = " ".join(f"{number}>&-" for number in closed)
    words = ["sh", "-c", f'exec "$@" {closing}', "sh", *command]
    return subprocess.run(words, capture_output=True, text=True, timeout=300, **more)


@pytest.mark.parametrize("closed", [closed for closed in CLOSED if 1 in closed])
def test_a_closed_output_is_refused_if_something_would_be_printed(closed):
    done = started(closed, "list")
    message = "" if 2 in closed else "normalbench: standard output is closed; name a file with -o\n"
    assert (done.returncode, done.stdout, done.stderr) == (2, "", message)


def test_child_processes_have_all_three_standard_streams(tmp_path):
    """Otherwise a compiler's messages would go into the first file that it opens."""
    program = (
        "import os, subprocess, sys\n"
        "from normalbench.bench.door.cli.start import open_missing_streams\n"
        "open_missing_streams()\n"
        "print('lost', file=sys.stderr)\n"
        'child = \'import os; [os.fstat(number) for number in range(3)]; open("made", "w").close()\'\n'
        "sys.exit(subprocess.run([sys.executable, '-c', child]).returncode)\n"
    )
    done = without_streams(range(3), [sys.executable, "-c", program], cwd=tmp_path)
    assert done.returncode == 0 and (tmp_path / "made").exists()
