"""The comparison of each kind of encoding in the two languages."""

from collections.abc import Mapping

from normalbench.encodings.kinds import CURVE, DEPTH, FRAME, LIGHT, MOTION, NORMAL, Kind

from . import curves, depth, frames, light, motion, normals
from .comparison import Parity

PARITY: Mapping[Kind, Parity] = {
    NORMAL: normals.PARITY,
    DEPTH: depth.PARITY,
    FRAME: frames.PARITY,
    LIGHT: light.PARITY,
    MOTION: motion.PARITY,
    CURVE: curves.PARITY,
}
