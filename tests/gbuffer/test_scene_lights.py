"""Lights in glTF files, from KHR_lights_punctual."""

from dataclasses import replace

import numpy as np
import pytest
from written import TRIANGLE, Document

from normalbench.gbuffer.scenes.files.gltf_lights import ROUNDED_OFF
from normalbench.gbuffer.scenes.files.read import file_scene, read_mesh_file
from normalbench.gbuffer.scenes.files.source import SceneFileError
from normalbench.gbuffer.scenes.scene import Material
from normalbench.gbuffer.scenes.setting import Setting

NAME = "KHR_lights_punctual"


def lit(*lights: dict, **node) -> Document:
    """Return a document with a triangle and a node for each light."""
    document = Document()
    document.node(mesh=document.mesh(TRIANGLE, [(0, 0, 1)] * 3))
    document.json["extensions"] = {NAME: {"lights": list(lights)}}
    for index in range(len(lights)):
        document.node(extensions={NAME: {"light": index}}, **node)
    return document


def read(document: Document, tmp_path):
    return read_mesh_file(document.write(tmp_path / "a.glb"))


def test_lights_take_position_and_direction_from_their_nodes(tmp_path):
    """Irradiance is pi x colour x cosine at a distance of 0: a sun of E lux gives E, so its colour is E / pi. A quarter
    turn about x takes the light's -z to -y; a scale changes neither its intensity nor its range."""
    turned = [-(0.5**0.5), 0, 0, 0.5**0.5]
    document = lit(
        {"type": "point", "color": [1, 0.5, 0], "intensity": 10 * np.pi, "range": 7},
        {"type": "spot", "intensity": np.pi, "range": 7, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}},
        {"type": "directional", "color": [0, 0, 1], "intensity": 3 * np.pi},
        rotation=turned,
        translation=[1, 2, 3],
        scale=[5, 5, 5],
    )
    file = read(document, tmp_path)
    sun, point, spot = file.lights
    assert sun.kind == "sun" and np.allclose(sun.colour, (0, 0, 3)) and np.allclose(sun.direction, (0, -1, 0))
    assert point.kind == "point" and np.allclose(point.colour, (10, 5, 0))
    assert point.position == (1, 2, 3) and point.radius == 7
    assert spot.kind == "spot" and np.allclose(spot.direction, (0, -1, 0)) and np.allclose(spot.colour, (1, 1, 1))
    assert (spot.inner, spot.outer) == pytest.approx((np.degrees(0.1), np.degrees(0.5)))
    assert file_scene(file, Setting()).lights == file.lights and file.notes == (ROUNDED_OFF,)


def test_a_light_without_a_range_reaches_four_times_as_far_as_the_scene(tmp_path):
    """Within the scene, the fall-off window (1 - (d / r)^4)^2 removes less than 1% of the light."""
    (light,) = read(lit({"type": "point"}, translation=[0, 0, 10]), tmp_path).lights
    assert light.radius == pytest.approx(4 * 102**0.5) and (1 - 1 / 4**4) ** 2 > 0.99


def test_spot_without_cones_gets_default_cones_and_a_smooth_edge(tmp_path):
    """The defaults are 0 and pi / 4; equal cones are moved 0.1° apart, because the edge between them is smooth."""
    same = {"innerConeAngle": 0.5, "outerConeAngle": 0.5}
    lights = read(lit({"type": "spot"}, {"type": "spot", "spot": same}), tmp_path).lights
    assert (lights[0].inner, lights[0].outer) == (0, pytest.approx(45))
    assert (lights[1].inner, lights[1].outer) == pytest.approx((np.degrees(0.5) - 0.1, np.degrees(0.5)))


def test_files_without_lights_get_a_sun_and_an_environment_or_lamps(tmp_path):
    """Metallic-roughness scenes get an environment, which lights them; other scenes get lamps instead."""
    file = read(lit({"type": "point", "intensity": 0}), tmp_path)
    dull = replace(file, materials=(Material(),) * len(file.materials))
    scenes = [file_scene(mesh_file, Setting(lights=2)) for mesh_file in (file, dull)]
    assert file.lights == () and [scene.environment is None for scene in scenes] == [False, True]
    assert [[light.kind for light in scene.lights] for scene in scenes] == [["sun"], ["sun", "point", "point"]]


def test_brightest_of_several_suns_is_drawn_with_a_note(tmp_path):
    file = read(lit({"type": "directional"}, {"type": "directional", "intensity": 2}), tmp_path)
    assert len(file.lights) == 1 and file.lights[0].colour == pytest.approx((2 / np.pi,) * 3)
    assert file.notes == ("only the brightest of 2 directional lights is drawn",)


def test_unknown_kind_of_light_is_ignored_with_a_note(tmp_path):
    file = read(lit({"type": "area"}), tmp_path)
    assert file.notes == (f"{NAME}.lights[0] is ignored: not a directional, point or spot light",)


BAD = {
    "no such light": (
        lambda j: j["nodes"][1].update(extensions={NAME: {"light": 3}}),
        ["a light that does not exist", "number of lights is 1"],
    ),
    "a range": (lambda j: j["extensions"][NAME]["lights"][0].update(range=0), ["range is 0.0"]),
    "a colour": (lambda j: j["extensions"][NAME]["lights"][0].update(color=[1]), ["color", "3 numbers"]),
    "cones": (lambda j: j["extensions"][NAME]["lights"][0].update(spot={"innerConeAngle": 2}), ["spot has cones"]),
    "nothing": (lambda j: j["nodes"][1].update(scale=[0, 0, 0]), ["zero scale"]),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_light_is_a_one_line_error(tmp_path, what):
    change, parts = BAD[what]
    document = lit({"type": "spot"})
    change(document.json)
    with pytest.raises(SceneFileError) as refusal:
        read(document, tmp_path)
    assert all(part in str(refusal.value) for part in ("a.glb", *parts)) and "\n" not in str(refusal.value)
