"""Cached answers are repeated until something that affects them changes."""

from dataclasses import replace

import pytest

from normalbench.bench.ground.output import cache, errors
from normalbench.bench.ground.output.writing import say
from normalbench.bench.keep import answers
from normalbench.bench.tables.registry import TABLES

PICK = TABLES["pick"]


@pytest.fixture
def asked(own_cache, monkeypatch, tmp_path):  # noqa: ARG001 (an empty cache)
    """A command that counts its runs, prints to standard error and standard output, and fails."""
    ran, driver = [], tmp_path / "lib" / "driver.so"
    driver.parent.mkdir()
    driver.write_text("1")
    monkeypatch.delenv(cache.ANEW, raising=False)
    monkeypatch.setattr(answers, "loaded", lambda: {str(driver)})

    def command() -> int:
        ran.append(1)
        errors.tell("a code is left out")
        say("the answer\n")
        return 1

    def ask(options=None, format="table") -> int:
        errors.told.clear()
        return answers.answered(answers.key_of_answer(PICK, options or PICK.options(), format), command)

    ask.ran, ask.driver = ran, driver
    return ask


def test_a_cached_answer_is_repeated_unchanged(asked, capsys):
    first = (asked(), *capsys.readouterr())
    again = (asked(), *capsys.readouterr())
    assert first == (1, "the answer\n", "normalbench: a code is left out\n")
    assert again[:2] == first[:2] and len(asked.ran) == 1
    assert again[2].startswith(f"{first[2]}normalbench: answer cached on 20")
    assert "; to measure again, use --anew\n" in again[2]


@pytest.mark.parametrize("change", ["driver", "driver gone", "setting", "sources", "width", "anew", "packages"])
def test_an_answer_is_measured_again_if_something_changed(asked, monkeypatch, change):
    asked()
    if change == "driver":
        asked.driver.write_text("22")
    elif change == "driver gone":
        asked.driver.unlink()
    elif change == "anew":
        monkeypatch.setenv(cache.ANEW, "1")
    elif change == "width":
        monkeypatch.setenv("COLUMNS", "77")
    elif change == "setting":
        monkeypatch.setenv("LP_NUM_THREADS", "3")
    else:
        monkeypatch.setattr(answers, {"sources": "sources", "packages": "_packages"}[change], lambda: "others")
    asked()
    assert len(asked.ran) == 2


def test_each_question_has_an_answer_of_its_own(asked):
    for options in (PICK.options(), PICK.options(seed=1), PICK.options(storage=("rg8",))):
        asked(options)
    asked(format="json")
    assert len(asked.ran) == 4


def test_an_answer_about_files_is_not_cached(asked, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").write_text("")
    for word in ("mine.glsl", "folder/mine", "mine", "C:\\mine.hlsl"):
        options = replace(PICK.options(), encoding=("octahedral", word))
        assert answers.key_of_answer(PICK, options, "table") == ""
        asked(options), asked(options)
    assert len(asked.ran) == 8


def test_a_damaged_answer_is_measured_again(asked, own_cache):
    asked()
    for path in own_cache.rglob("*.json"):
        path.write_bytes(path.read_bytes()[:-9])
    asked()
    assert len(asked.ran) == 2
