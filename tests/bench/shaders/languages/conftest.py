"""Translations of users' files in this process."""

import json
from pathlib import Path
from subprocess import CompletedProcess
from types import SimpleNamespace

import pytest

from normalbench.bench.ground.user_files import UserFile
from normalbench.bench.shaders.languages import child, translated
from normalbench.encodings.kinds import BY_NAME


@pytest.fixture
def in_this_process(monkeypatch):
    """Translation of files within this process, because a process takes far longer to start than to translate.
    test_translated.py and test_wall.py test the separate process, its limits and its sandbox."""

    def finished(command, _):
        folder, word, by, kind, part = command
        number, count = map(int, part.split(":"))
        facts = child.answer(UserFile(word), Path(folder), by, BY_NAME[kind], part=(number, count))
        return CompletedProcess(command, 0, json.dumps(facts), "")

    children = SimpleNamespace(python=lambda _, *words: words, finished=finished)
    monkeypatch.setattr(translated, "children", children)
