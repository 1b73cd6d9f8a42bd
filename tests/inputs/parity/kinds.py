"""How each kind of encoding is compared in the two languages."""

from collections.abc import Mapping

from normalbench.encodings.codecs.kind import NORMAL, Kind

from . import normals
from .comparison import Parity

PARITY: Mapping[Kind, Parity] = {NORMAL: normals.PARITY}
