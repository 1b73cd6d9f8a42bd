"""z/w of the usual projection, as in OpenGL's depth buffer: 0 at the near plane and 1 at the far plane."""

from pathlib import Path

from ..codecs.depth_codec import DepthEncoding
from ..shared.position import Projection
from ..vec import maximum


def encode(depth, near, far):
    """Map depth to window depth; depth nearer than `near` becomes 0."""
    # w = (d - near) far / (d (far - near))
    d = maximum(depth, near)
    return (d - near) * far / (d * (far - near))


def decode(number, near, far):
    """Return the depth for a window depth. 1 - w is exact where it matters; far - w (far - near) would cancel."""
    # d = near far / (near + (1 - w) (far - near))
    return near * far / (near + (1.0 - number) * (far - near))


def clip_row(near, far):
    """Return a and b of the projection's z row, so that (a z + b) / -z is -1 at z = -near and 1 at z = -far."""
    return (near + far) / (near - far), 2 * near * far / (near - far)


ENCODING = DepthEncoding(
    name="window",
    title="z/w",
    encode=encode,
    decode=decode,
    projection=Projection(clip_row, (2.0, -1.0)),
    storages=("depth16", "depth24", "depth32f"),
    citation="OpenGL 4.6, section 13.8; M. Drobot, Architektury Deferred, slides 48-53",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(3, 2),
    ulps_reason="two differences, two products, a division by a reciprocal: half a unit each; likewise back",
)
