"""What the layouts of `budget` cost: bytes that passes fetch, and issue slots to pack and to unpack."""

import itertools

import pytest

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.tables.budget.readers import read_readers
from normalbench.gbuffer.layouts.presets import LAYOUTS


@pytest.mark.parametrize(
    ("readers", "unreal", "signed", "said"),
    [
        # Four targets of 4 bytes each. Unreal keeps the normal in the first, roughness and id in the second, base
        # colour and occlusion in the third. The other one keeps the normal's x and y in the first, and the sign of its
        # z on the depth in the second; base colour and id in the third, F0 and its power in the fourth.
        ("1", 16, 16, "once in full"),
        ("2.5", 40, 40, "2.5 times in full"),
        ("all,all", 32, 32, "twice in full"),
        ("normal", 4, 8, "once for normal"),
        ("normal+roughness, id,1", 28, 32, "once in full, once for normal and roughness, once for id"),
        ("basecolor+id", 8, 4, "once for basecolor and id"),
        ("specular", 4, 4, "once for specular"),
        # Neither holds it.
        ("emission", 0, 0, "once for emission"),
        ("0", 0, 0, "0 times in full"),
    ],
)
def test_a_reader_fetches_the_targets_that_hold_what_it_reads(readers, unreal, signed, said):
    found = read_readers(readers)
    assert found.bytes_of(LAYOUTS["unreal4"]) == unreal
    assert found.bytes_of(LAYOUTS["xy_depth_sign"]) == signed
    assert found.said == said


@pytest.mark.parametrize(
    ("readers", "said"),
    [
        ("-1", "--readers -1.0: from 0.0 to 64.0"),
        ("nan", "--readers -1.0: from 0.0 to 64.0"),
        ("32,33", "--readers 65.0: from 0.0 to 64.0"),
        ("normals", "--readers normals: unknown; known: a number, all, normal, basecolor"),
        ("normal+flags", "--readers normal+flags: unknown"),
        ("normal+", "--readers normal+: unknown"),
    ],
)
def test_readers_that_are_none_are_one_line(readers, said):
    with pytest.raises(UsageError) as caught:
        read_readers(readers)
    assert said in str(caught.value)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["--readers", "emission"], "--readers emission: not held; held: normal, basecolor, roughness"),
    ],
)
@pytest.mark.usefixtures("gl")
def test_what_cannot_be_asked_is_one_line(run, asked, said):
    usual = {"--scene": "ramps", "--size": "64x48"} | dict(zip(asked[::2], asked[1::2], strict=True))
    status, _, err = run("budget", *itertools.chain.from_iterable(usual.items()))
    assert status != 0 and said in err and "Traceback" not in err, err
