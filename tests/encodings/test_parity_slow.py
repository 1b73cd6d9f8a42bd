"""Agreement of the two languages: to a few units in the last place before storage, code for code after storage."""

import pytest
from parity.kinds import PARITY
from slowly import a_tenth
from test_parity import EVERY, codecs, swaps

from normalbench.gbuffer.gl import shader
from normalbench.gbuffer.gl.shader import ShaderError


# The quick test has each encoding; these are further inputs and storages of one.
@pytest.mark.parametrize("kind, codec", a_tenth(codecs("more_codecs")))
def test_more_codes_are_the_same_after_storage(gl, kind, codec):
    """The quick test has fewer inputs and fewer storages."""
    for comparison in PARITY[kind].stored(gl, codec, True):
        assert comparison.agrees, comparison


def is_unseen(gl, monkeypatch, kind, encoding, file, text) -> bool:
    """Whether the languages agree although two arguments are exchanged in one language."""
    original, parity = shader.read_shader, PARITY[kind]
    with monkeypatch.context() as patch:
        patch.setattr(shader, "read_shader", lambda path: text if path == file else original(path))
        # What is read once is read anew.
        patch.setattr(shader, "_lines", shader._lines.__wrapped__)
        patch.setattr(shader, "_expanded_of_own", shader._expanded)
        try:
            comparisons = parity.compared(gl, parity.cases(encoding)[0])
        except ShaderError:
            return False  # the types disagree: nobody can ship that
        return all(comparison.agrees for comparison in comparisons)


@pytest.mark.parametrize("kind, encoding", EVERY)
def test_swapping_two_arguments_is_noticed(gl, monkeypatch, kind, encoding):
    """The comparison is strict enough to notice a swap of two arguments in any GLSL function. This test tries a tenth
    of the swaps of each encoding."""
    several = a_tenth(swaps(kind, encoding))
    assert not [what for what, *swap in several if is_unseen(gl, monkeypatch, kind, encoding, *swap)]
