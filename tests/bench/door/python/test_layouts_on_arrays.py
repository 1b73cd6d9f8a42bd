"""`nb.pack` and `nb.unpack` match the results of the renderer's own GLSL and of the formats."""

import numpy as np
import pytest
from typed import layouts_named

import normalbench as nb
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.code.whole.surface import Contents
from normalbench.bench.shaders.code.whole.surfaces import settings, surfaces
from normalbench.bench.shaders.code.whole.verify import Expected
from normalbench.gbuffer.layouts.presets import LAYOUTS

COUNT = 2**10


PLANES = """
encoding = "octahedral"
depth = "logarithmic"

[[targets]]
format = "rgba8"
holds = "depth:24 normal.x:8"

[[targets]]
format = "r32_uint"
holds = "normal.y:12 square_root(roughness):8 metalness:5 other:7"
"""


SURFACE = {"normal": [0, 0, 1], "base_color": [1, 1, 1], "roughness": 0.5, "metallic": 1, "ao": 1}


def fields_of(contents, rows) -> dict:
    """Return rows of surfaces as arrays by field name."""
    columns, start = {}, 0
    for field in contents.fields:
        size = len(field.components) or 3
        part = rows[:, start : start + size] if size > 1 else rows[:, start]
        columns[field.name] = part if field.kind == "uint" else part.copy().view(np.float32)
        start += size
    return columns


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("name", ["granite", "nrd", "planes"])
def test_arrays_are_packed_and_unpacked_as_in_the_renderer(name, tmp_path):
    """Layouts have floats, integers, bits across bytes, a sign stored with roughness, and depth between planes."""
    (tmp_path / "planes.toml").write_text(PLANES)
    layout = LAYOUTS[name] if name in LAYOUTS else layouts_named(str(tmp_path / "planes.toml"))[0]
    contents, besides = Contents(layout), settings(COUNT)
    expected = Expected(contents, surfaces(contents, COUNT), besides)
    planes = {"near": 0.125, "far": 1024.0} if name == "planes" else {}
    targets = nb.pack(layout, fields_of(contents, surfaces(contents, COUNT)), **planes)
    for index, held in enumerate(targets):
        assert held.shape == (COUNT, layout.targets[index].storage.channels if held.dtype == np.uint32 else 4)
        wanted = expected.stored[:, index, : held.shape[1]]
        np.testing.assert_array_equal(held, wanted if held.dtype == np.uint32 else wanted.view(np.float32))
    back = nb.unpack(layout, targets, **planes)
    for field, wanted in fields_of(contents, expected.surfaces).items():
        np.testing.assert_allclose(back[field], wanted, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(
    "call, said",
    [
        (lambda: nb.pack("granite", {"normal": [0, 0, 1]}), "surface: missing ao, base_color, metallic"),
        (lambda: nb.pack("granite", {**SURFACE, "depth": 1.0}), "surface: unexpected depth; expected: normal"),
        (lambda: nb.pack("granite", SURFACE, near=0.1), "settings: unexpected near; expected: none"),
        (lambda: nb.unpack("granite", [np.zeros(4)]), "has 3 targets, not 1"),
        (lambda: nb.pack("granit", SURFACE), "did you mean granite?"),
    ],
)
def test_misuse_is_a_one_line_error(call, said):
    with pytest.raises(UsageError, match=said.replace("?", r"\?")) as raised:
        call()
    assert "\n" not in str(raised.value)
