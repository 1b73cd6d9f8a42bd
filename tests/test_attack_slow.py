"""A short form of `python -m tests.attack`: every kind that needs no separate process, with the first seeds."""

import sys
import time
from collections import Counter
from pathlib import Path

import pytest
from attack import translations
from attack.kind import MEASURED, REFUSED
from attack.trying import KINDS, ODD, one
from languages import RUN, require_runner

from normalbench.bench.ground.compilers import tools
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.languages import translated


@pytest.mark.usefixtures("gl")
def test_languages_without_a_compiler_are_left_out_and_reported(monkeypatch, tmp_path):
    """Without a C compiler no program is written in C, whatever its seed."""
    path_of = tools.path_of
    # What another test has asked of the compiler is not asked again.
    monkeypatch.setattr(tools, "version_text", tools.version_text.__wrapped__)
    monkeypatch.setattr(tools, "path_of", lambda tool: raised("no cc") if tool == tools.C else path_of(tool))
    monkeypatch.setattr(translated, "_by_child", translated._by_child)
    written, left_out = translations.written_here()
    assert "c" not in written and left_out == ["left out: programs written in C: no cc"], left_out
    seed = RUN.index("c") * len(translations.GIVEN)
    ended, why = one(translations.translations(tmp_path), translations.KINDS[0], seed)
    assert ended in (MEASURED, REFUSED), why


def raised(why):
    raise MissingError(why)


FEW = [kind for kind in KINDS if kind.few]


# Of programs: each language is read once, and written in another one.
BY_DAY = (0, 5, 10, 7)


# Each of these is a command, and takes half a second.
COSTLY = ("run: read", "words")


def of(kinds, share: int) -> list:
    """Return test parameters: each kind, with the number of its cases to try."""
    return [pytest.param(kind, kind.few // share, id=kind.name) for kind in kinds]


@pytest.mark.drawn(3)
@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    "kind, count", [*of((k for k in FEW if k.name not in COSTLY), 1), *of((k for k in FEW if k.name in COSTLY), 8)]
)
def test_damaged_input_is_measured_or_refused_in_one_line(kind, count, tmp_path, monkeypatch, opened):
    """Cases end within the time limit of their kind, and open no file outside the folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    attack, counts = kind.prepare(tmp_path), Counter()
    began = time.process_time()
    for seed in range(count):
        opened.clear()
        ended, why = one(attack, kind, seed)
        counts[ended] += 1
        assert ended != ODD, f"seed {seed}: {why}"
        if kind.reads_here_only:
            outside = [name for name in opened if not _is_known(tmp_path / name, tmp_path)]
            assert not outside, (seed, outside)
    assert time.process_time() - began < count * kind.seconds
    assert len(counts) == 2, f"changes must be both harmless and harmful: {counts}"


@pytest.mark.drawn(3)
@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("seed", BY_DAY)
def test_programs_mean_the_same_in_every_language(seed, tmp_path, monkeypatch):
    """A program is read in the language that its seed selects, and written in another."""
    for language in ("hlsl", "slang", "wgsl", "c"):
        require_runner(language)
    monkeypatch.setattr(translated, "_by_child", translated._by_child)
    ended, why = one(translations.translations(tmp_path), translations.KINDS[0], seed)
    assert ended == MEASURED, why


def _is_known(path: Path, folder: Path) -> bool:
    """Whether a file is in the test's folder, or is read by Python and its packages at startup (JAX reads /sys)."""
    ours = any(path.is_relative_to(root) for root in (folder, sys.prefix, sys.base_prefix))
    return (
        ours or path.suffix in (".py", ".pyc", ".so") or path.name == "entry_points.txt" or path.is_relative_to("/sys")
    )
