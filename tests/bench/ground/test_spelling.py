"""Names are understood as people type them, and what is nearly right is said."""

import pytest

from normalbench.bench.ground.choose import choose
from normalbench.bench.ground.options.gpu_families import CHOICES
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.storage import STORAGES

KNOWN = {what: {name: name for name in names} for what, names in (("encoding", ENCODINGS), ("storage", STORAGES))}
KNOWN["family"] = {name: name for name in CHOICES}
KNOWN["language"] = {name: name for name in LANGUAGES}


@pytest.mark.parametrize(
    "what, typed, meant",
    [
        ("storage", "RG8", "rg8"),
        ("storage", "R8G8", "rg8"),
        ("storage", "RGB10_A2", "rgb10a2"),
        ("storage", "R10G10B10A2", "rgb10a2"),
        ("storage", "RGBA8-SNORM", "rgba8_snorm"),
        ("encoding", "oct", "octahedral"),
        ("encoding", "Octahedral-Precise", "octahedral_precise"),
        ("encoding", "SphereMap", "spheremap"),
        ("family", "rdna3", "navi31"),
        ("language", "Metal", "msl"),
        ("family", "Navi21", "navi21"),
        ("family", "Tiger Lake", "tgl"),
        ("family", "Arc", "dg2"),
        ("family", "Intel", "intel"),
    ],
)
def test_a_name_is_understood(what, typed, meant):
    assert choose(what, f" {typed} ", KNOWN[what]) == [meant]


@pytest.mark.parametrize(
    "what, typed, said",
    [
        ("encoding", "octaedral", "unknown encoding 'octaedral'; did you mean octahedral? known: all, xyz"),
        ("encoding", "sphericla", "did you mean spherical?"),
        ("encoding", "octahedral spheremap", "separate names by commas: octahedral,spheremap"),
        ("storage", "rgba8_snrm", "did you mean rgba8_snorm?"),
        ("family", "navi32", "did you mean navi31?"),
        ("family", "turning", "did you mean sm_75?"),
        ("storage", "rg9", "did you mean rg8?"),
        ("encoding", "zzzz", "unknown encoding 'zzzz'; known: all, xyz"),
    ],
)
def test_what_is_nearly_right_is_said(what, typed, said):
    with pytest.raises(UsageError) as error:
        choose(what, typed, KNOWN[what])
    assert said in str(error.value)


@pytest.mark.parametrize("what", KNOWN)
def test_no_two_names_are_spelled_alike(what):
    """Each is found by its own name, in capitals and with hyphens."""
    for name in KNOWN[what]:
        assert choose(what, name.upper().replace("_", "-"), KNOWN[what]) == [name]
