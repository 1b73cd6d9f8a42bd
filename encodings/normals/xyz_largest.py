"""The normal over its largest component: a point of the cube around the sphere, renormalised when decoded."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec3, maximum, unit


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Map a unit normal to the point in its direction on the surface of the cube [-1, 1]^3."""
    # e = n / max(|n.x|, |n.y|, |n.z|)
    a = abs(n)
    return n * (1.0 / maximum(maximum(a.x, a.y), a.z))


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the unit vector toward a point of the cube; a stored zero, which no normal produces, gives +x."""
    # n = e / |e|
    return unit(e)


ENCODING = Encoding(
    name="xyz_largest",
    title="xyz over the largest, renormalised",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="NVIDIA, Real-Time Denoisers, NRD.hlsli, NRD_NORMAL_ENCODING 0, 1, 3 and 4",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(2, 2),
    ulps_reason="one reciprocal and one product; one normalise",
)
