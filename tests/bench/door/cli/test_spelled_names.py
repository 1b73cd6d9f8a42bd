"""Names of every kind are matched regardless of capitals, hyphens and underscores."""

import json

import pytest
from typed import (
    as_known,
    choose,
    effects_named,
    encodings_named,
    families_named,
    gpus_named,
    layouts_named,
    light_buffers_named,
    listed,
    normal_sets_named,
    roundings_named,
    scene_makers_named,
    storages_named,
)

from normalbench.bench.door.gates.measured import table_named
from normalbench.bench.ground.options.option import Reading
from normalbench.bench.subjects.environments.environment_names import environment_named
from normalbench.bench.subjects.scenes.frame_file import read_frame_file
from normalbench.gbuffer.pipelines import PIPELINES


def names(values):
    return [getattr(value, "name", value) for value in values]


# By kind of name: what reads it, as it may be typed, and what it is.
READ = {
    "encoding": (lambda word: names(encodings_named(word)), "Hemi-Octahedral", ["hemi_octahedral"]),
    "encoding with a setting": (
        lambda word: names(encodings_named(word)),
        "Octahedral:axis=y",
        names(encodings_named("octahedral:axis=y")),
    ),
    "storage": (lambda word: names(storages_named(word)), "RG8-Snorm", ["rg8_snorm"]),
    "rounding": (roundings_named, "Truncate-Half", ["truncate_half"]),
    "set of normals": (lambda word: names(normal_sets_named(word, 10, 0, Reading())), "SPHERE", ["sphere"]),
    "scene": (lambda word: names(scene_makers_named(word)), "Studio", ["studio"]),
    "environment": (lambda word: environment_named(word).name, "Studio", "studio"),
    "layout": (lambda word: names(layouts_named(word)), "Unreal-4", ["unreal4"]),
    "light buffer": (lambda word: names(light_buffers_named(word)), "RGBA-16F", names(light_buffers_named("rgba16f"))),
    "effect": (lambda word: [effect.name for effect in effects_named(word)], "GTAO", ["gtao"]),
    "pipeline": (lambda word: names(choose("pipeline", word, PIPELINES)), "For-Ward", ["forward"]),
    "family": (families_named, "NAVI_21", ["navi21"]),
    "GPU": (lambda word: [*gpus_named(word)], next(iter(gpus_named("all"))).upper(), [next(iter(gpus_named("all")))]),
    "table": (lambda word: table_named(word).name, "Quality", "quality"),
    "list": (listed, "Light-s", listed("lights")),
    "attribute": (as_known, "base_color", ("base_color",)),
    "attribute with a hyphen": (as_known, "base-color", ("base_color",)),
    "attribute in British": (as_known, "Base_Colour", ("base_color",)),
    "attributes with bits": (
        as_known,
        "Normal, base_color,ID:4,MOTION:Packed",
        ("normal", "base_color", "shading_model:4", "motion:packed"),
    ),
    "attributes read together": (as_known, "2,Base_Color+Roughness,All", ("2", "base_color+roughness", "all")),
    "what is no attribute": (as_known, "normal,colour", ("normal", "colour")),
}


@pytest.mark.parametrize("kind", READ)
def test_a_name_is_recognised_in_any_spelling(kind):
    read, typed, known = READ[kind]
    assert read(typed) == known, f"{typed}: {read(typed)}, not {known}"


@pytest.mark.parametrize("key", ["basecolor", "base_color", "base-color", "BaseColor", "base_colour"])
def test_a_captured_frame_has_a_base_colour_in_any_spelling(tmp_path, key):
    entry = {"file": "a.npy"}
    (tmp_path / "a.npy").touch()
    facts = {"fov": 60, "near": 0.1, "far": 100, "depth": entry, "normal": entry, "roughness": 0.5, key: [1, 1, 1]}
    (tmp_path / "gbuffer.json").write_text(json.dumps(facts))
    assert read_frame_file(tmp_path / "gbuffer.json").entries["base_color"] == [1, 1, 1]


@pytest.mark.parametrize("option", ["--hold", "--blend", "--read-alone", "--readers"])
def test_options_for_attributes_accept_base_color(run, option):
    """Names are read before errors are reported."""
    words = {"--hold": "normal,base_color,Base-Color", "--readers": "base_color+tangent"}
    status, _, err = run("budget", option, words.get(option, "base_color,tangent"))
    messages = {"--hold": "--hold: base_color is named twice", "--readers": "--readers base_color+tangent: unknown"}
    wanted = messages.get(option, f"{option} tangent: not in --hold")
    assert status == 2 and wanted in err, err
