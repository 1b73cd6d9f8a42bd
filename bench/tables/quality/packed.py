"""The catalogue's most accurate codecs at the bit counts of encodings that pack themselves."""

from __future__ import annotations

from functools import cache

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ....encodings.storages.storage import STORAGES
from ...subjects.normals.normal_sets import NORMAL_SETS
from ..table import Row

# Normals that a best code is found on.
COUNT = 2**14


def best_columns(codec: Codec) -> Row:
    """Return columns with the catalogue's most accurate codec of the same bit count or the closest lower one, and its
    mean angle. Empty for an encoding that does not pack itself.
    """
    encoding = codec.encoding
    return _best_columns(encoding.packed_bits, encoding.domain) if encoding.is_packed else {}


@cache
def _best_columns(bits: int, domain: str) -> Row:
    chosen = _codecs(bits, domain)
    if not chosen:
        return {}
    # It imports what pick needs, which few codes do.
    from ..pick import measure as pick

    normals = NORMAL_SETS["hemisphere" if domain == "hemisphere" else "sphere"](COUNT, 0)
    means = pick.mean_angles(chosen, normals)
    name = min(means, key=lambda codec_name: means[codec_name])
    return {"best_codec": name, "best_mean_deg": means[name]}


def _codecs(bits: int, domain: str) -> list[Codec]:
    """Return the catalogue's codecs for a domain with `bits` bits, or with the closest lower number of bits."""
    holding = [
        encoding for encoding in ENCODINGS.values() if encoding.domain in ("sphere", domain) and not encoding.sign_bits
    ]
    codecs = [Codec(encoding, storage) for encoding in holding for storage in STORAGES.values()]
    fitting = [codec for codec in codecs if codec.fits and codec.bits <= bits]
    most = max((codec.bits for codec in fitting), default=0)
    return [codec for codec in fitting if codec.bits == most]
