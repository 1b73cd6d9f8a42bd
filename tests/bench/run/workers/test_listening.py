"""Nothing that `--on` or `worker` starts can be reached from the network, and TLS is as the manual says."""

import os
import subprocess
import sys

import pytest

NORMALBENCH = [sys.executable, "-m", "normalbench"]


@pytest.mark.parametrize("command", [("quality", "--normals", "axes", "--on"), ("worker",)], ids=["on", "worker"])
@pytest.mark.parametrize(
    ("scheme", "encrypts", "says"),
    [("tls", "False", "check your TLS configuration"), ("tcp", "True", "encryption required")],
)
def test_what_is_wrong_with_tls_is_one_line_of_dasks(command, scheme, encrypts, says):
    """In seconds: without certificates, and by an address without TLS where encryption is wanted."""
    variables = os.environ | {"DASK_DISTRIBUTED__COMM__REQUIRE_ENCRYPTION": encrypts}
    words = [*NORMALBENCH, *command, f"{scheme}://127.0.0.1:1"]
    done = subprocess.run(words, capture_output=True, text=True, env=variables, timeout=30)
    assert done.returncode == 2 and says in done.stderr.splitlines()[-1] and "Traceback" not in done.stderr, done.stderr
