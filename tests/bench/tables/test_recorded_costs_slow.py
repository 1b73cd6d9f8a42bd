"""Encoding costs without a compiler: the answer is the same."""

import os
import subprocess
import sys
from pathlib import Path

from other_systems import START


def test_the_answer_is_the_same_without_compilers():
    """The answer says where its counts come from."""
    words = ["pick", "--bytes", "2", "--encoding", "octahedral,spheremap,xyz", "--scene", "studio"]
    answers = [pick(words, os.environ["PATH"]), pick(words, str(Path(sys.executable).parent))]
    first, other = (text.splitlines()[0] for text in answers)
    assert first == other and first.startswith("2 bytes, on sphere: take octahedral in rg8."), answers
    assert "recorded with Mesa" in " ".join(answers[1].split()) and "recorded with" not in answers[0]


def pick(words, path):
    command = [sys.executable, "-c", START, *words]
    return subprocess.run(command, capture_output=True, text=True, env=os.environ | {"PATH": path}, check=True).stdout
