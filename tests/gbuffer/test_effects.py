"""Passes and resources: invalid pipelines, the kinds of resources, and adding an effect."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from drawing import FP32, scene_of

from normalbench.encodings.catalogue import LIGHT_BUFFERS
from normalbench.gbuffer.effects.effect import Choice, Effect, EffectError, Number, chosen
from normalbench.gbuffer.frame.contract import Pass, Pipeline, PipelineError
from normalbench.gbuffer.frame.plan import Plan
from normalbench.gbuffer.frame.resource import Resource
from normalbench.gbuffer.frame.resources import BY_KIND, COLOURS, DEPTH, FINAL, FINAL_DEPTH, GBUFFER, TERMS
from normalbench.gbuffer.passes.forward import forward
from normalbench.gbuffer.passes.geometry import geometry
from normalbench.gbuffer.passes.lights import lights
from normalbench.gbuffer.passes.linear_depth import linear_depth
from normalbench.gbuffer.passes.material import material
from normalbench.gbuffer.passes.screen import screen
from normalbench.gbuffer.passes.shadow_map import shadow_map
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import bytes_per_pixel, rendering

SIZE = (48, 36)


PLAN = Plan(SIZE, 1, FP32, LIGHT_BUFFERS["rgba32f"], 2, False, 1.0)


HEAD = '#version 430\n#include "frame.glsl"\n'


def nothing(_):
    return lambda: None


def piped(*stages: Pass) -> Pipeline:
    return Pipeline("mine", "a pipeline of a test", "this test", stages)


def rendered(gl, *stages: Pass, scene=None):
    """Return the rendering of passes after forward shading of the room."""
    return rendering(gl, piped(shadow_map(), forward(), *stages), scene or scene_of("room"), PLAN)


HALF = Resource("half", "rgba16f", scale=0.5)


WRITES, READS = Pass("first", (), (HALF,), nothing), Pass("second", (HALF,), (FINAL,), nothing)


@pytest.mark.parametrize(
    "stages, said",
    [
        ((READS, WRITES), "pass second reads half, which no earlier pass writes"),
        ((WRITES, WRITES), "pass first has the same name as another pass"),
        ((Pass("first", (), (), nothing),), "pass first writes nothing"),
        (
            (Pass("first", (), (replace(HALF, format="rgb555"),), nothing),),
            "pass first has the resource half, which has the unknown format 'rgb555'; known: rgba8, ",
        ),
        (
            (WRITES, Pass("second", (replace(HALF, scale=0.25),), (FINAL,), nothing)),
            "pass second has a resource half that differs from that of an earlier pass",
        ),
        (
            (Pass("first", (), (replace(HALF, depth=8),), nothing),),
            "pass first has the resource half, which is a volume, which has one sample and a size in pixels",
        ),
        (
            (Pass("first", (), (replace(HALF, scale=(8, 8), depth=8, format="r11g11b10f"),), nothing),),
            "pass first has the resource half, which is a volume, which cannot have the format 'r11g11b10f'",
        ),
        (
            (Pass("first", (), (replace(HALF, kept=True),), nothing),),
            "pass first has the resource half, which has 1 copies; a kept resource needs 2",
        ),
        (
            (Pass("first", (replace(HALF, kept=True, copies=2),), (FINAL,), nothing),),
            "pass first reads half, which no pass writes",
        ),
        ((geometry(TERMS), screen()), "pass screen reads linear_depth, which no earlier pass writes"),
        (
            (shadow_map(), geometry(BY_KIND), linear_depth(), lights(COLOURS)),
            "pass lights expects LIGHT_HOLDS 1, but has 2",
        ),
        (
            (shadow_map(), geometry(COLOURS), linear_depth(), lights(COLOURS), screen(), material("special")),
            "pass material expects LIGHT_HOLDS 2, but has 1",
        ),
        (
            (shadow_map(), geometry(TERMS), linear_depth(), lights(TERMS), material("opaque", filters=True)),
            "pass material expects FILTERS 1, but has 0",
        ),
        (
            (geometry(TERMS), Pass("own", (), (FINAL_DEPTH,), nothing), linear_depth()),
            "pass linear_depth reads native_depth, which final_depth has replaced",
        ),
        (
            (geometry(TERMS), Pass("more", (), (FINAL,), nothing, tells={"FILTERS": 1})),
            "pass more defines FILTERS as 1, but an earlier pass defines it as 0",
        ),
    ],
)
def test_invalid_pipeline_is_a_one_line_error(stages, said):
    with pytest.raises(PipelineError) as refused:
        piped(*stages)
    assert str(refused.value).startswith(f"pipeline mine: {said}") and "\n" not in str(refused.value), refused.value


def test_an_effect_after_a_missing_pass_is_refused():
    glow = Pass("glow", (FINAL,), (FINAL,), nothing, after=("bloom", "haze"))
    with pytest.raises(
        PipelineError, match=r"^pipeline forward: pass glow must come after bloom or haze; known: shadow_map, "
    ):
        PIPELINES["forward"].with_effect([glow])


def test_effects_follow_the_pass_they_name_in_the_order_they_are_added():
    first, second = (Pass(name, (GBUFFER,), (HALF,), nothing, after=("geometry", "forward")) for name in ("one", "two"))
    pipeline = PIPELINES["hybrid"].with_effect([first]).with_effect([second])
    assert [stage.name for stage in pipeline.stages][:5] == ["shadow_map", "geometry", "one", "two", "linear_depth"]


def test_a_pass_cannot_use_resources_that_it_does_not_declare(gl, tmp_path):
    (tmp_path / "mine.frag").write_text(
        HEAD + "uniform sampler2D final;\nout vec4 o;\nvoid main() { o = texelFetch(final, ivec2(0), 0); }\n"
    )
    samples = Pass("mine", (), (HALF,), lambda canvas: canvas.over(tmp_path / "mine.frag", HALF))
    with (
        pytest.raises(PipelineError, match=r"^pass mine samples final, which it does not read$"),
        rendered(gl, samples),
    ):
        pass
    draws = Pass("mine", (), (HALF,), lambda canvas: canvas.target(FINAL).use)
    with pytest.raises(PipelineError, match=r"^pass mine uses final, which it does not declare$"), rendered(gl, draws):
        pass


def test_the_requirements_of_a_pipeline_follow_from_its_passes():
    facts = {n: (p.light_targets, p.scaled, p.starts_light, "shading_model" in p.needs) for n, p in PIPELINES.items()}
    assert facts == {
        "forward": ((), False, False, False),
        "forward_multipass": ((), False, False, False),
        "deferred": ((1,), False, True, False),
        "prepass": ((1, 2), False, False, False),
        "inferred": ((1, 2), True, False, False),
        "hybrid": ((1, 2), False, True, True),
    }


def test_a_resource_counts_toward_the_bytes_per_pixel():
    """A half-size resource counts as a quarter, and every copy that the next frame reads counts. Resources with a
    size in pixels do not count, nor does the image."""
    plain = bytes_per_pixel(piped(shadow_map(), forward()), PLAN)
    assert plain == 5, "depth and stencil"
    sizes = {
        HALF: 8 / 4,
        replace(HALF, copies=2): 8 / 4,
        replace(HALF, copies=2, kept=True): 2 * 8 / 4,
        replace(HALF, scale=(16, 16), depth=4): 0,
        FINAL: 0,
        replace(DEPTH, name="another"): 5,
    }
    for resource, expected in sizes.items():
        pipeline = piped(shadow_map(), forward(), Pass("mine", (), (resource,), nothing))
        assert bytes_per_pixel(pipeline, PLAN) == plain + expected, resource


def test_a_volume_is_drawn_in_slices_and_read_as_a_whole(gl, tmp_path):
    """Slice 2 stays cleared; a later pass reads slice 3."""
    volume, read = Resource("fog", "rgba32f", (8, 6), depth=4), Resource("seen", "rgba32f", (8, 6))
    (tmp_path / "fill.frag").write_text(
        HEAD + "uniform float at;\nout vec4 o;\nvoid main() { o = vec4(floor(gl_FragCoord.xy), at, 1); }\n"
    )
    (tmp_path / "read.frag").write_text(
        HEAD
        + "uniform sampler3D fog;\nout vec4 o;\nvoid main() { o = texelFetch(fog, ivec3(gl_FragCoord.xy, 3), 0); }\n"
    )

    def fill(canvas):
        target, covers = canvas.target(volume), canvas.fullscreen(tmp_path / "fill.frag")

        def run():
            canvas.device.state(None)
            for layer in (0, 1, 3):
                target.use(at=layer)
                covers.program["at"] = layer
                canvas.prepare(covers.program)
                covers.render(vertices=3)

        return run

    stages = (
        Pass("fill", (), (volume,), fill),
        Pass("read", (volume,), (read,), lambda canvas: canvas.over(tmp_path / "read.frag", read)),
    )
    with rendered(gl, *stages) as drawing:
        drawing.draw()
        drawing.draw()
        slices = np.frombuffer(drawing.frame.textures(volume)[0].read(), np.float32).reshape(4, 6, 8, 4)
        seen = drawing.read(read)[0][::-1]
    y, x = np.mgrid[:6, :8].astype(np.float32)
    expected = np.stack([np.stack([x, y, np.full_like(x, layer), np.ones_like(x)], axis=-1) for layer in range(4)])
    expected[2] = 0
    assert np.array_equal(slices, expected), f"{(slices != expected).sum()} of {slices.size} numbers differ"
    assert np.array_equal(seen, expected[3]), f"{(seen != expected[3]).sum()} of {seen.size} numbers differ"


def one_more(tmp_path, name: str) -> Path:
    """Write a shader that adds 1 to the previous copy and return its path."""
    path = tmp_path / "more.frag"
    path.write_text(
        f"{HEAD}uniform sampler2D {name}_before;\nout vec4 o;\n"
        f"void main() {{ o = texelFetch({name}_before, ivec2(gl_FragCoord.xy), 0) + 1.0; }}\n"
    )
    return path


def test_copies_are_read_and_written_alternately(gl, tmp_path):
    """Five draws that each add 1 give 5 in every frame."""
    pong = Resource("pong", "rgba32f", scale=0.25, copies=2)

    def build(canvas):
        draw = canvas.over(one_more(tmp_path, "pong"), pong)

        def run():
            for _ in range(5):
                canvas.swap(pong)
                draw()

        return run

    with rendered(gl, Pass("turns", (), (pong,), build)) as drawing:
        for _ in range(3):
            drawing.draw()
            texels = drawing.read(pong)[0]
            assert texels.shape == (9, 12, 4) and np.all(texels == 5), f"{texels.min()} to {texels.max()}"


@pytest.mark.parametrize("copies", [2, 3])
def test_a_kept_resource_is_available_in_the_next_frame(gl, tmp_path, copies):
    """A pass that adds 1 to the previous frame counts frames, from 0; an earlier pass reads the previous frame."""
    history = Resource("history", "rgba32f", copies=copies, kept=True)
    late = Resource("late", "rgba32f")
    counts = Pass("counts", (history,), (history,), lambda c: c.over(one_more(tmp_path, "history"), history))
    before = Pass("before", (history,), (late,), lambda c: c.over(one_more(tmp_path, "history"), late))
    with rendered(gl, before, counts) as drawing:
        for frame in range(1, 6):
            drawing.draw()
            counted, read = drawing.read(history)[0], drawing.read(late)[0]
            assert np.all(counted == frame), f"frame {frame}: {counted.min()} to {counted.max()}"
            assert np.all(read == frame), f"frame {frame}, the pass before: {read.min()} to {read.max()}"


def test_a_pass_can_have_its_own_view(gl, tmp_path):
    """With its own view a pass draws the same positions as a camera with this view, bit for bit."""
    room = scene_of("room")
    turned = replace(room.view, eye=room.view.target, target=room.view.eye, fov=70.0)
    seen, depth = Resource("seen", "rgba32f"), replace(DEPTH, name="own_depth")
    (tmp_path / "positions.frag").write_text(
        '#version 430\n#include "fragment.glsl"\nout vec4 o;\nvoid main() { o = vec4(shaded_surface().position, 1); }\n'
    )

    def looks(view):
        def build(canvas):
            target, drawn = canvas.target(seen, depth=depth), canvas.geometry("geometry.vert", shader)

            def run():
                target.use(view=view)
                canvas.device.state("<")
                canvas.prepare(drawn.program)
                drawn.draw("opaque")

            return run

        return Pass("looks", (), (seen, depth), build)

    shader, images = tmp_path / "positions.frag", []
    for scene, view in ((room, turned), (replace(room, view=turned), None), (room, None)):
        with rendered(gl, looks(view), scene=scene) as drawing:
            drawing.draw()
            images.append(drawing.read(seen)[0])
    assert np.array_equal(images[0], images[1]), f"{np.abs(images[0] - images[1]).max():.3g} apart"
    assert np.mean(images[0] != images[2]) > 0.3, "the two views show the same"


WORN = Effect(
    "worn",
    "nothing",
    "this test",
    HALF,
    lambda **_: (),
    {
        "taps": Number(8, 1, 64, "Taps a pixel."),
        "depth": Number(0.5, 0.0, 1.0, "Metres."),
        "size": Choice(("full", "half"), "Of its target."),
    },
)


@pytest.mark.parametrize(
    "given, name",
    [
        ({}, "worn"),
        ({"size": "half", "taps": "4"}, "worn:taps=4:size=half"),
        ({"depth": "0.25"}, "worn:depth=0.25"),
        ({"depth": "0.5", "taps": "8"}, "worn"),
    ],
)
def test_an_effect_is_named_by_the_settings_that_are_not_the_default(given, name):
    assert chosen(WORN, given).name == name


@pytest.mark.parametrize(
    "given, said",
    [
        ({"steps": "3"}, "effect worn has no setting 'steps'; known: taps, depth, size"),
        ({"taps": "65"}, "effect worn: taps=65 is not a whole number from 1 to 64"),
        ({"taps": "2.5"}, "effect worn: taps=2.5 is not a whole number from 1 to 64"),
        ({"depth": "nan"}, "effect worn: depth=nan is not a number from 0 to 1"),
        ({"size": "third"}, "effect worn: size=third is not full or half"),
    ],
)
def test_invalid_setting_is_a_one_line_error(given, said):
    with pytest.raises(EffectError) as refused:
        chosen(WORN, given)
    assert str(refused.value) == said
