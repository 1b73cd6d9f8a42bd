"""Agreement of the two languages: to a few units in the last place before storage, code for code after storage."""

import numpy as np
import pytest
from mutants import mutants
from parity.comparison import Comparison
from parity.kinds import PARITY

from normalbench.encodings.catalogue import BY_KIND

EVERY = [pytest.param(kind, e, id=f"{kind.name} {e.name}") for kind, named in BY_KIND.items() for e in named.values()]


def codecs(which: str) -> list:
    """Return the codecs of all kinds that the quick test or the slow test compares."""
    quick = {f"{kind.name} {codec.name}": (kind, codec) for kind, parity in PARITY.items() for codec in parity.codecs}
    more = {
        f"{kind.name} {codec.name}": (kind, codec) for kind, parity in PARITY.items() for codec in parity.more_codecs
    }
    chosen = quick if which == "codecs" else {name: pair for name, pair in more.items() if name not in quick}
    return [pytest.param(*pair, id=name) for name, pair in chosen.items()]


@pytest.mark.parametrize("kind, encoding", EVERY)
def test_the_languages_agree_before_storage_within_the_stated_error(gl, kind, encoding):
    for case in PARITY[kind].cases(encoding):
        for comparison in PARITY[kind].compared(gl, case):
            assert comparison.agrees, comparison


@pytest.mark.parametrize("kind, codec", codecs("codecs"))
def test_codes_are_the_same_after_storage(gl, kind, codec):
    """A few codes may differ where float32 falls on either side of a tie; the module of the kind says how many."""
    for comparison in PARITY[kind].stored(gl, codec, False):
        assert comparison.agrees, comparison


def test_every_encoding_is_compared_after_storage():
    compared = {(kind, codec.encoding) for kind, codec in (param.values for param in codecs("codecs"))}
    assert [e.name for kind, e in (param.values for param in EVERY) if (kind, e) not in compared] == []


@pytest.mark.parametrize("kind, encoding", [param for param in EVERY if PARITY[param.values[0]].guarded])
def test_invalid_values_have_the_same_code_in_both_languages(gl, kind, encoding):
    """NaN, infinities and vectors without a direction: their codes are numbers."""
    for case in PARITY[kind].cases(encoding):
        for comparison in PARITY[kind].guarded(gl, case):
            assert comparison.agrees, comparison


@pytest.mark.parametrize(
    "apart, same, agrees",
    [
        ([0.0, 2.0], [True, True], True),
        ([0.0, 2.1], [True, True], False),
        ([0.0, np.inf], [True, True], False),
        ([0.0, np.nan], [True, True], False),
        ([0.0, 0.0], [True, False], False),
    ],
)
def test_a_comparison_fails_if_one_row_is_too_far_off_or_too_few_rows_are_equal(apart, same, agrees):
    """At most 2 units apart, and 60% equal; a value that is not a number is too far apart."""
    rows = np.zeros((2, 1))
    comparison = Comparison("a codec", rows, rows, rows, np.array(apart), 2.0, same=np.array(same), share=0.6)
    assert comparison.agrees == agrees, comparison


def swaps(kind, encoding) -> list:
    """Return every swap of two arguments of a call in an encoding's GLSL: a description, the file and its text."""
    all_swaps = mutants(encoding.glsl, PARITY[kind].shared.get(encoding.name, ()))
    return [swap for swap in all_swaps if swap[0] not in PARITY[kind].same]


def test_every_encoding_with_two_arguments_has_something_to_swap():
    """Functions that several encodings share count too."""
    tried = {(kind, encoding.name): len(swaps(kind, encoding)) for kind, encoding in (p.values for p in EVERY)}
    assert not [e.name for kind, e in (p.values for p in EVERY) if "," in e.signatures[0] and not tried[kind, e.name]]
    counts = {kind.name: sum(count for (other, _), count in tried.items() if other is kind) for kind in PARITY}
    assert {name: count for name, count in counts.items() if count <= LEAST_SWAPS[name]} == {}


LEAST_SWAPS = {"normal": 40, "depth": 30, "tangent frame": 100, "light": 20, "motion": 5, "curve": 15}
