"""A short form of `python -m tests.attack`: every kind that takes no process of its own, from the first seeds."""

import pytest
from attack import translations
from attack.kind import MEASURED, REFUSED
from attack.trying import one
from languages import RUN

from normalbench.bench.ground.compilers import tools
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.shaders.languages import translated


@pytest.mark.usefixtures("gl")
def test_what_a_machine_lacks_is_left_out_of_the_attack_and_said(monkeypatch, tmp_path):
    """Without a C compiler no program is written in C, whichever seed it has."""
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
