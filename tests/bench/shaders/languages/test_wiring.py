"""Functions that take or return more than a normal and its code."""

import pytest
from manual import ROOT
from typed import translated

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.languages.pairs import NoPairError
from normalbench.bench.shaders.languages.wiring import Wiring, wiring_of

pytestmark = pytest.mark.usefixtures("in_this_process")

FORMS = ROOT / "tests" / "inputs" / "encoders"


MATERIAL = "PackSurface(s.normalWS=n; s.roughness=0.25)->o1.xy:UnpackSurface(o1.xy=e)->normalWS"


@pytest.mark.parametrize(
    "text", ["Pack", "A::Pack(s.normalWS=n; s.roughness=0.5)->o1.xyz", "f(n.xy=e.xy; face=e.z)->(n.xy; face)", "g->xyz"]
)
def test_wiring_round_trips_through_its_text(text):
    assert str(wiring_of(text)) == text
    assert wiring_of(text).is_plain == text.isalpha()


def test_commas_and_spaces_are_also_accepted():
    assert wiring_of("f(a=n,b= 1 )->(x, y)") == Wiring("f", (("a", "n"), ("b", "1")), ("x", "y"))
    for wrong in ("f(a)", "f(=n)", "f(a=)", "->x", "f(a=n"):
        with pytest.raises(NoPairError, match="is not in the form Pack"):
            wiring_of(wrong)


@pytest.mark.usefixtures("slang")
@pytest.mark.parametrize(
    "wiring, said",
    [
        (
            MATERIAL.replace("s.normalWS", "s.normal"),
            "PackSurface has no input s.normal; its inputs are s.albedo, s.normal",
        ),
        (MATERIAL.replace("->o1.xy", "->o2.xy"), "PackSurface does not return o2.xy; it returns o0, o1"),
        (MATERIAL.replace("->o1.xy", ""), "PackSurface(s.normalWS=n; s.roughness=0.25) returns a code of 8 numbers"),
        (MATERIAL.replace("->normalWS", "->roughness"), "does not return a normal; name the output"),
        (MATERIAL.replace("UnpackSurface", "Gone"), "unknown function Gone; known: "),
        (MATERIAL.replace("=0.25", "=gone"), "is not in the form Pack(s.normal=n; s.roughness=0.5)->o1.xyz"),
    ],
)
def test_wiring_error_is_reported_in_one_line(wiring, said):
    with pytest.raises(UsageError) as error:
        translated(f"{FORMS / 'material.hlsl'}:{wiring}")
    assert said in str(error.value) and str(error.value).count("\n") == 0
