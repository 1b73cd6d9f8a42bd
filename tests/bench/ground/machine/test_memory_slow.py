"""The memory that a process keeps and needs."""

import subprocess
import sys

import pytest

COMMAND = """
import resource, sys
resource.setrlimit(resource.RLIMIT_AS, (10**9, 10**9))
from normalbench.bench.door.cli.app import main
sys.argv = ["normalbench", *sys.argv[1:]]
sys.exit(main())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the limit of addresses")
@pytest.mark.parametrize(
    "words", ["quality --encoding octahedral --storage rg8 --normals axes", "code octahedral --storage rg8", "doctor"]
)
def test_too_little_address_space_is_a_one_line_error(words):
    """With 1 GB, JAX's C++ libraries would terminate the process with status 134."""
    done = subprocess.run([sys.executable, "-c", COMMAND, *words.split()], capture_output=True, text=True)
    message = (
        "normalbench: not enough memory: this process may use 1 GB of address space, but JAX and OpenGL need 2.5 GB"
    )
    assert (done.returncode, done.stdout) == (3, ""), done.stderr
    assert done.stderr == f"{message}; raise the limit: ulimit -v 2500000\n", done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="the limit of addresses")
def test_commands_without_jax_need_little_address_space():
    done = subprocess.run([sys.executable, "-c", COMMAND, "list", "encodings"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
