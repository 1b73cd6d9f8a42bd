"""What people's hands do: each slip is one line that says what would be right, exit status 2, or is understood."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.parametrize("typed, expected", [("xyz,oct", "xyz,octahedral"), ("optim", "optimised_rings")])
def test_a_shell_completes_names(typed, expected):
    words = f"normalbench quality --encoding {typed}"
    environment = os.environ | {"_NORMALBENCH_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": "3"}
    program = Path(sys.executable).with_name("normalbench")
    done = subprocess.run([program], env=environment, capture_output=True, text=True)
    assert expected in done.stdout.split(), done
