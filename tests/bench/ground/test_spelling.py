"""Names are understood in common spellings, and a near miss gets a suggestion."""

import pytest
from typed import choose

from normalbench.bench.ground.options.gpu_families import CHOICES
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.spelling import spelled
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
def test_a_near_miss_gets_a_suggestion(what, typed, said):
    with pytest.raises(UsageError) as error:
        choose(what, typed, KNOWN[what])
    assert said in str(error.value)


@pytest.mark.parametrize("what", KNOWN)
def test_names_differ_by_more_than_spelling(what):
    """Each name is found in capitals and with hyphens."""
    for name in KNOWN[what]:
        assert choose(what, name.upper().replace("_", "-"), KNOWN[what]) == [name]


FORMATS_OF_APIS = {
    "rgb10a2": "R10G10B10A2_UNORM VK_FORMAT_A2B10G10R10_UNORM_PACK32 GL_RGB10_A2 PF_A2B10G10R10 rgb10a2unorm",
    "rg16f": "DXGI_FORMAT_R16G16_FLOAT VK_FORMAT_R16G16_SFLOAT GL_RG16F PF_G16R16F rg16float",
    "rg8_snorm": "DXGI_FORMAT_R8G8_SNORM VK_FORMAT_R8G8_SNORM GL_RG8_SNORM MTLPixelFormatRG8Snorm rg8snorm",
    "rgba8": "B8G8R8A8_UNORM VK_FORMAT_R8G8B8A8_UNORM GL_RGBA8",
    "r11g11b10f": "DXGI_FORMAT_R11G11B10_FLOAT VK_FORMAT_B10G11R11_UFLOAT_PACK32 GL_R11F_G11F_B10F",
}


def test_formats_are_recognised_by_their_api_names():
    """Names are from RenderDoc, DXGI, Vulkan, OpenGL, Metal, WebGPU and Unreal; other formats are not storages."""
    for storage, names in FORMATS_OF_APIS.items():
        assert {spelled("storage", name, STORAGES) for name in names.split()} == {storage}
    for name in ("DXGI_FORMAT_R24G8_TYPELESS", "VK_FORMAT_R8G8_UINT", "R64G64_SFLOAT", "a2", "gpu", ""):
        assert spelled("storage", name, STORAGES) is None, name
