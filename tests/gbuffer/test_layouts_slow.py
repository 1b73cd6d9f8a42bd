"""Layouts: what lies where, what clashes, and that every preset gives back what was put in to within its bits."""

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


def test_noise_that_a_layout_asks_for_is_its_codes(gl):
    """What is kept is what a plan with that noise keeps, and the same codes nearby: none is off by more than a step."""
    codec = Codec(ENCODINGS["xyz"], STORAGES["rgb10a2"], "dithered")
    noisy, plain = (LAYOUTS["fp32"].with_codec(replace(codec, rounding=way)) for way in ("dithered", "nearest"))
    found = []
    for asked in (plan(noisy), plan(plain, dither=codec.dither(0)), plan(plain)):
        with rendering(gl, PIPELINES["prepass"], ROOM, asked) as made:
            made.draw()
            found.append(made.gbuffer()[1][..., :3])
    by_layout, by_plan, without = found
    assert noisy.rounding == "dithered" and np.array_equal(by_layout, by_plan)
    moved = abs(by_layout - without).max(axis=-1)
    assert (moved > 0).mean() > 0.3 and moved.max() < 1.01 * codec.storage.step(0)
    with pytest.raises(LayoutError, match="fields across channels are drawn without noise"):
        LAYOUTS["fp32"].with_codec(replace(codec, storage=STORAGES["rgba8_11_11_10"]))


@pytest.mark.parametrize("name", ["sqrt", "cube_root"])
def test_packed_motion_is_the_codecs(gl, name):
    """A code of motion in words of 14 bits is what `vectors` measures in SNORM 14:14; and a camera at rest moves
    nothing by a thousandth of a pixel of 1920."""
    x, y, z = ROOM.view.eye
    moved = replace(ROOM, previous=replace(ROOM.view, eye=(x + 0.3, y - 0.1, z + 0.2)))
    mine = layout(
        Target("rgba32f", "normal.x normal.y motion.x motion.y"),
    )
    packed = layout(Target("rgba32f", "normal.x normal.y"), Target("rgba8", f"{name}(motion.x):14 {name}(motion.y):14"))
    kept_motions = {}
    for scene in (moved, replace(ROOM, previous=ROOM.view)):
        for one in (mine, packed):
            with rendering(gl, PIPELINES["prepass"], scene, plan(one)) as made:
                made.draw()
                number = len(one.targets) - 1 if one is packed else 0
                texture = made.frame.textures(GBUFFER)[number]
                kept_motions[scene is moved, one is packed] = texture.read()
    exact = np.frombuffer(kept_motions[True, False], np.float32).reshape(-1, 4)[:, 2:]
    words = np.frombuffer(kept_motions[True, True], ">u4")
    here = np.abs(exact).max(axis=1) > 0
    codec = MotionCodec(MOTION_ENCODINGS[name], by_rule("snorm", (14, 14)))
    one = 2**13 - 1
    code = np.stack(codec.stored(Vec2(*exact[here].T), 1.0), axis=-1) * one + one
    got = np.stack([words[here] >> 18, words[here] >> 4 & (2**14 - 1)], axis=-1)
    # A unit in the last place decides where a number lies on a tie.
    apart = np.abs(got - np.rint(code))
    assert here.sum() > 1500 and apart.max() <= 1 and np.mean(apart > 0) < 0.002, f"{np.mean(apart > 0):.4%} differ"
    rest = np.frombuffer(kept_motions[False, True], ">u4")[here]
    codes = (np.stack([rest >> 18, rest >> 4 & (2**14 - 1)]).astype(np.float64) - one) / one
    still = np.stack(MOTION_ENCODINGS[name].decode(Vec2(*codes), 1.0))
    assert abs(still).max() < 0.001 / 1920, f"{abs(still).max():.3g} of a screen at rest"
