"""Logarithmic depth: every step is the same fraction of the depth."""

from pathlib import Path

from ..codecs.depth_codec import DepthEncoding
from ..elementary import CONSTANTS, exp2_of, log2_of
from ..vec import maximum


def encode(depth, near, far):
    """Map depth to its logarithmic position between the planes, 0 to 1; depth nearer than `near` becomes 0."""
    # l = log2(d / near) / log2(far / near)
    return log2_of(maximum(depth, near) / near) / log2_of(far / near)


def decode(number, near, far):
    """Return the depth that a number from `encode` represents: near (far / near)^number."""
    # d = near 2^(l log2(far / near))
    return near * exp2_of(number * log2_of(far / near))


ENCODING = DepthEncoding(
    name="logarithmic",
    title="logarithmic",
    encode=encode,
    decode=decode,
    storages=("packed16", "packed24"),
    citation="B. Kemen, Logarithmic Depth Buffer, 2009; B. Lloyd et al., ACM TOG 27(4), 2008",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 4),
    ulps_reason="two logarithms and their quotient; a logarithm, a product and a power",
    constants=CONSTANTS,
)
