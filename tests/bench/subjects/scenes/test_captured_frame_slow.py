"""Captured frames as scenes, compared with the image and figures of the scenes that they were written from."""

import json
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_captured_frame import frame, pixels_of, read
from typed import scene_makers_named
from written import png_bytes

from normalbench.bench.tables.budget.attributes import SEEN
from normalbench.bench.tables.budget.rates import Exact, Stage
from normalbench.encodings.storages.rounding import from_srgb
from normalbench.gbuffer.environment.catalogue import ENVIRONMENTS
from normalbench.gbuffer.frame.resources import LINEAR_DEPTH
from normalbench.gbuffer.scenes.catalogue import SCENES, SceneMaker
from normalbench.gbuffer.scenes.files.read import AROUND
from normalbench.gbuffer.scenes.setting import Setting

SIZE = (160, 120)


def unlit(name: str) -> SceneMaker:
    """Return a scene of the catalogue lit only by the environment of captured frames."""
    maker = SCENES[name]
    around = ENVIRONMENTS[AROUND].make()
    return replace(maker, make=lambda setting: replace(maker.make(setting), lights=(), environment=around))


def written(exact: Exact, folder: Path) -> Path:
    """Write the surfaces of an exact image as float arrays with a description, and return its path."""
    view, surfaces = exact.stage.scene.view, exact.surfaces
    depth = exact._made.read(LINEAR_DEPTH)[0][..., 0]
    arrays = {
        "depth": np.where(exact.covered, depth, 0),
        **{name: getattr(surfaces, name) for name in surfaces.__dataclass_fields__},
    }
    for name, array in arrays.items():
        np.save(folder / f"{name}.npy", array.astype(np.float32))
    entries = {name: {"file": f"{name}.npy"} for name in arrays}
    entries["normal"]["space"] = "world"
    entries |= {"fov": view.fov, "near": view.near, "far": view.far, "view_matrix": view.matrix().tolist()}
    path = folder / "gbuffer.json"
    path.write_text(json.dumps(entries))
    return path


@pytest.mark.parametrize("name", ["ramps", "studio"])
def test_a_scene_that_is_read_back_renders_the_same_images(gl, name, tmp_path):
    """Attributes and the lit image agree to within texel rounding, and the errors of each code to within 0.1 dB."""
    with ExitStack() as stack:
        whole = Exact(gl, stack, Stage(unlit(name), Setting(), SIZE))
        (maker,) = scene_makers_named(str(written(whole, tmp_path)))
        assert maker.sides == SIZE == maker.within((320, 240)) and maker.name == "gbuffer.json"
        maker = replace(maker, exposure=SCENES[name].exposure)
        again = Exact(gl, stack, Stage(maker, Setting(), SIZE))
        assert np.array_equal(whole.covered, again.covered) and set(whole.classes) == set(again.classes)
        for field in whole.surfaces.__dataclass_fields__:
            apart = abs(getattr(whole.surfaces, field) - getattr(again.surfaces, field))[whole.covered]
            assert apart.max() < 1e-6 * max(1.0, abs(getattr(whole.surfaces, field)).max()), field
        assert abs(whole.shown - again.shown).max() < 1e-4
        for attribute in ("normal", "base_color", "roughness", "metallic", "ao"):
            code = SEEN[attribute].codes[0]
            errors, others = whole.of(code.trip), again.of(code.trip)
            for of_class, error in errors.items():
                if error > 1e-8:
                    assert 10 * abs(np.log10(error / others[of_class])) < 0.1, (attribute, of_class)


def test_8_bit_images_are_decoded_with_their_curve_and_noted(tmp_path):
    """A PNG's base colour, and roughness that RenderDoc's script wrote as floats, are on 8-bit steps."""
    rng = np.random.default_rng(5)
    colours = rng.integers(0, 256, (16, 24, 3), np.uint8)
    (tmp_path / "a.png").write_bytes(png_bytes(colours))
    path = frame(tmp_path, base_color={"file": "a.png", "curve": "srgb"})
    np.save(tmp_path / "roughness.npy", rng.integers(0, 256, (16, 24)).astype(np.float32) / np.float32(255))
    assert np.allclose(pixels_of(path).base_color, from_srgb(colours / 255), atol=1e-6)
    assert (
        "base_color, roughness: 8-bit steps; encodings with the same steps look better than they are"
        in read(path).notes
    )
    path = frame(tmp_path, base_color={"file": "a.png"})
    assert np.allclose(pixels_of(path).base_color, colours / 255, atol=1e-6)
    assert any('"curve": "srgb"' in line for line in read(path).notes)
