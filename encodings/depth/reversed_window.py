"""Reversed z/w: 1 at the near plane and 0 at the far plane, where floats have their finest steps."""

from pathlib import Path

from ..codecs.depth_codec import DepthEncoding
from ..shared.position import Projection
from ..vec import maximum


def encode(depth, near, far):
    """Map depth to reversed window depth, without the cancellation in 1 - z/w; depth nearer than `near` becomes 1."""
    # r = near (far - d) / (d (far - near))
    d = maximum(depth, near)
    return near * (far - d) / (d * (far - near))


def decode(number, near, far):
    """Return the depth for a reversed window depth."""
    # d = near far / (near + r (far - near))
    return near * far / (near + number * (far - near))


def clip_row(near, far):
    """Return a and b of the projection's z row, so that (a z + b) / -z is 1 at z = -near and 0 at z = -far."""
    return near / (far - near), near * far / (far - near)


ENCODING = DepthEncoding(
    name="reversed_window",
    title="reversed z/w",
    encode=encode,
    decode=decode,
    projection=Projection(clip_row, (1.0, 0.0)),
    storages=("depth16", "depth24", "depth32f"),
    citation="E. Lapidous and G. Jiao, Optimal Depth Buffer for Low-Cost Graphics Hardware, Graphics Hardware 1999",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(3, 2),
    ulps_reason="two differences, two products, a division by a reciprocal: half a unit each; likewise back",
)
