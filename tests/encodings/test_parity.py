"""The two languages agree: before storage to a few units in the last place, after it code for code."""

import numpy as np
import pytest
from mutants import mutants
from parity.comparison import Comparison
from parity.kinds import PARITY

from normalbench.encodings.catalogue import BY_KIND

EVERY = [pytest.param(kind, e, id=f"{kind.name} {e.name}") for kind, found in BY_KIND.items() for e in found.values()]


def codecs(which: str) -> list:
    """The codecs of all kinds that the quick test or the slow one compares."""
    quick = {f"{kind.name} {codec.name}": (kind, codec) for kind, parity in PARITY.items() for codec in parity.codecs}
    more = {
        f"{kind.name} {codec.name}": (kind, codec) for kind, parity in PARITY.items() for codec in parity.more_codecs
    }
    chosen = quick if which == "codecs" else {name: pair for name, pair in more.items() if name not in quick}
    return [pytest.param(*pair, id=name) for name, pair in chosen.items()]


@pytest.mark.parametrize("kind, encoding", EVERY)
def test_before_storage_the_languages_differ_by_no_more_than_the_encoding_states(gl, kind, encoding):
    for case in PARITY[kind].cases(encoding):
        for found in PARITY[kind].compared(gl, case):
            assert found.agrees, found


@pytest.mark.parametrize("kind, codec", codecs("codecs"))
def test_after_storage_the_codes_are_the_same(gl, kind, codec):
    """But for few where float32 falls on either side of a tie; the module of the kind says how few."""
    for found in PARITY[kind].stored(gl, codec, False):
        assert found.agrees, found


def test_every_encoding_is_compared_after_storage():
    compared = {(kind, codec.encoding) for kind, codec in (param.values for param in codecs("codecs"))}
    assert [e.name for kind, e in (param.values for param in EVERY) if (kind, e) not in compared] == []


@pytest.mark.parametrize("kind, encoding", [param for param in EVERY if PARITY[param.values[0]].guarded])
def test_what_means_nothing_has_the_same_code_in_both_languages(gl, kind, encoding):
    """NaN, infinities and vectors without a direction: codes are numbers."""
    for case in PARITY[kind].cases(encoding):
        for found in PARITY[kind].guarded(gl, case):
            assert found.agrees, found


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
def test_a_comparison_fails_where_one_is_too_far_apart_or_too_few_are_the_same(apart, same, agrees):
    """At most 2 units apart, and 60 % the same; what is not a number is too far apart."""
    rows = np.zeros((2, 1))
    found = Comparison("a codec", rows, rows, rows, np.array(apart), 2.0, same=np.array(same), share=0.6)
    assert found.agrees == agrees, found


def swaps(kind, encoding) -> list:
    """Every two arguments of a call in the GLSL of an encoding exchanged: what, the file and its text."""
    found = mutants(encoding.glsl, PARITY[kind].shared.get(encoding.name, ()))
    return [swap for swap in found if swap[0] not in PARITY[kind].same]


def test_there_is_something_to_swap():
    """In each encoding whose functions have two arguments, and in the functions that several share."""
    tried = {(kind, encoding.name): len(swaps(kind, encoding)) for kind, encoding in (p.values for p in EVERY)}
    assert not [e.name for kind, e in (p.values for p in EVERY) if "," in e.signatures[0] and not tried[kind, e.name]]
    counts = {kind.name: sum(count for (other, _), count in tried.items() if other is kind) for kind in PARITY}
    assert {name: count for name, count in counts.items() if count <= LEAST_SWAPS[name]} == {}


LEAST_SWAPS = {"normal": 40, "depth": 30, "tangent frame": 100, "light": 20, "motion": 5, "curve": 15}
