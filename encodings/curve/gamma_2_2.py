"""Power: x / range to the power 1 / 2.2, as colours are stored in a format without its own curve."""

from pathlib import Path

from ..codecs.curve_codec import CurveEncoding
from ..vec import maximum

GAMMA = 2.2


def encode(x, range):
    """Map a quantity (float32 or float64, any shape) to (x / range)^(1 / GAMMA); negative x and NaN count as 0."""
    # e = (x / range)^(1 / gamma)
    return (maximum(x, 0.0) / range) ** (1.0 / GAMMA)


def decode(e, range):
    """Return the quantity that a number represents, e^GAMMA range, of the same shape."""
    # x = e^gamma range
    return e**GAMMA * range


ENCODING = CurveEncoding(
    name="gamma_2_2",
    title="the fraction of the range to the power 1 / 2.2",
    encode=encode,
    decode=decode,
    storages=("r8", "rgba8"),
    citation="Bevy 0.20, deferred/functions.wesl: base colour",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 8),
    ulps_reason="a power, by a logarithm and a power of two",
    constants={"GAMMA_2_2": GAMMA},
)
