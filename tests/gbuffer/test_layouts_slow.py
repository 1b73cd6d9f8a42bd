"""Layouts: field positions, conflicts, and presets that return every value to within the precision of its bits."""

from dataclasses import replace

import numpy as np
import pytest
from test_layouts import ROOM, layout, plan

from normalbench.encodings.catalogue import ENCODINGS, MOTION_ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.codecs.motion_codec import MotionCodec
from normalbench.encodings.storages.rules import by_rule
from normalbench.encodings.storages.storage import STORAGES
from normalbench.encodings.vec import Vec2
from normalbench.gbuffer.frame.resources import GBUFFER
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import LayoutError, Target
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering


def test_a_layout_with_noise_uses_the_noise_of_its_codec(gl):
    """The normals equal those of a plan with the same noise. They are at most one step from those without noise."""
    codec = Codec(ENCODINGS["xyz"], STORAGES["rgb10a2"], "dithered")
    noisy, plain = (LAYOUTS["fp32"].with_codec(replace(codec, rounding=way)) for way in ("dithered", "nearest"))
    normals = []
    for asked in (plan(noisy), plan(plain, dither=codec.dither(0)), plan(plain)):
        with rendering(gl, PIPELINES["prepass"], ROOM, asked) as drawing:
            drawing.draw()
            normals.append(drawing.gbuffer()[1][..., :3])
    by_layout, by_plan, without = normals
    assert noisy.rounding == "dithered" and np.array_equal(by_layout, by_plan)
    moved = abs(by_layout - without).max(axis=-1)
    assert (moved > 0).mean() > 0.3 and moved.max() < 1.01 * codec.storage.step(0)
    with pytest.raises(LayoutError, match="fields across channels cannot be dithered"):
        LAYOUTS["fp32"].with_codec(replace(codec, storage=STORAGES["rgba8_11_11_10"]))


@pytest.mark.parametrize("name", ["sqrt", "cube_root"])
def test_packed_motion_equals_the_motion_of_the_codec(gl, name):
    """A motion encoding in 14-bit words stores the codes that `vectors` measures in SNORM 14:14. With a camera at
    rest, motion is at most a thousandth of a pixel at a width of 1920 pixels."""
    x, y, z = ROOM.view.eye
    moved = replace(ROOM, previous=replace(ROOM.view, eye=(x + 0.3, y - 0.1, z + 0.2)))
    mine = layout(
        Target("rgba32f", "normal.x normal.y motion.x motion.y"),
    )
    packed = layout(Target("rgba32f", "normal.x normal.y"), Target("rgba8", f"{name}(motion.x):14 {name}(motion.y):14"))
    kept_motions = {}
    for scene in (moved, replace(ROOM, previous=ROOM.view)):
        for kept_layout in (mine, packed):
            with rendering(gl, PIPELINES["prepass"], scene, plan(kept_layout)) as drawing:
                drawing.draw()
                number = len(kept_layout.targets) - 1 if kept_layout is packed else 0
                texture = drawing.frame.textures(GBUFFER)[number]
                kept_motions[scene is moved, kept_layout is packed] = texture.read()
    exact = np.frombuffer(kept_motions[True, False], np.float32).reshape(-1, 4)[:, 2:]
    words = np.frombuffer(kept_motions[True, True], ">u4")
    here = np.abs(exact).max(axis=1) > 0
    codec = MotionCodec(MOTION_ENCODINGS[name], by_rule("snorm", (14, 14)))
    scale = 2**13 - 1
    code = np.stack(codec.stored(Vec2(*exact[here].T), 1.0), axis=-1) * scale + scale
    got = np.stack([words[here] >> 18, words[here] >> 4 & (2**14 - 1)], axis=-1)
    # A unit in the last place decides where a number lies on a tie.
    apart = np.abs(got - np.rint(code))
    assert here.sum() > 1500 and apart.max() <= 1 and np.mean(apart > 0) < 0.002, f"{np.mean(apart > 0):.4%} differ"
    rest = np.frombuffer(kept_motions[False, True], ">u4")[here]
    codes = (np.stack([rest >> 18, rest >> 4 & (2**14 - 1)]).astype(np.float64) - scale) / scale
    still = np.stack(MOTION_ENCODINGS[name].decode(Vec2(*codes), 1.0))
    assert abs(still).max() < 0.001 / 1920, f"{abs(still).max():.3g} of a screen at rest"
