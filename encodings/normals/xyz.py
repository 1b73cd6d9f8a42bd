"""All three components: the baseline for the two-component methods."""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec3


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Return a unit normal unchanged: the code is exact until it is stored."""
    return n


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the stored vector unchanged, so that an error in its length counts too."""
    return e


ENCODING = Encoding(
    name="xyz",
    title="X, Y and Z",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="baseline of A. Pranckevicius, Compact Normal Storage for Small G-Buffers, 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 0),
    ulps_reason="nothing is computed",
)
