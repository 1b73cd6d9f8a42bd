"""Linear depth: the depth as a fraction of the far plane's distance or, in float formats, the depth itself."""

from pathlib import Path

from ..codecs.depth_codec import DepthEncoding
from ..vec import maximum


def encode(depth, near, far):
    """Map depth to a fraction of `far`; depth behind the eye becomes 0."""
    # l = d / far
    return maximum(depth, 0.0) / far


def decode(number, near, far):
    """Return the depth, given as a fraction of `far`."""
    # d = l far
    return number * far


ENCODING = DepthEncoding(
    name="linear",
    title="linear",
    encode=encode,
    decode=decode,
    own_units=True,
    storages=("packed16", "packed24", "r16f", "r32f"),
    citation="M. Drobot, Architektury Deferred, slides 54-57: planar view depth, for the eye's ray",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(1, 1),
    ulps_reason="one division, which a GPU makes of a reciprocal; one product",
)
