"""Columns of the quality table for a codec and a domain, next to the measured columns: the supremum, the odd codes and
the bound. A domain is "sphere", "hemisphere", or None for a set that is not uniform."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....reports.sheets import Row
from ...ground.output.errors import UsageError
from ...shaders.code.twin import has_twin
from ..metrics.code_limits import AREAS, broken, code_limit, is_measurable
from ..metrics.totals import Statistics

T = TypeVar("T")


def supremum(codec: Codec, domain: str | None, area: float, s: Statistics) -> Row:
    """Return the columns of the supremum: its angle, its normal and the method that found it, or only the reason why
    it was not searched for. Without a domain the set is finite, and the columns contain its measured maximum.

    Raises UsageError as `_exactly` does.
    """
    if not domain:
        return {"angle_sup_deg": s.angle_max_deg, "sup_found_by": "every normal", "sup_moved_deg": 0.0}
    if not has_twin(codec.encoding):
        return {"sup_found_by": "nothing: it has no Python twin"}
    if not codec.encoding.is_exact:
        return {
            "sup_found_by": "nothing: half arithmetic and chains of codecs have no exact map, which the search needs"
        }
    if AREAS[domain] < area:
        return {"sup_found_by": f"nothing: the bound and codes cover only the {domain}; the set is larger"}
    from . import recorded

    worst = _exactly(recorded.supremum, codec, domain)
    x, y, z = worst.normal
    row = {"angle_sup_deg": worst.angle_deg, "sup_x": x, "sup_y": y, "sup_z": z}
    return row | {"sup_found_by": worst.found_by, "sup_moved_deg": worst.moved_deg}


def odd(codec: Codec, domain: str | None) -> Row:
    """Return the columns that count odd codes on a domain, or on the encoding's own domain if `domain` is None; {}
    for too many codes or an encoding without an exact map.

    Raises UsageError as `_exactly` does.
    """
    from .odd_codes import odd_codes

    counts = _exactly(odd_codes, codec, domain or codec.encoding.domain) if _has_exact_map(codec.encoding) else None
    if not counts:
        return {}
    return {"codes_unused": counts.unused, "codes_duplicate": counts.duplicate, "codes_unstable": counts.unstable}


def _has_exact_map(encoding: Encoding) -> bool:
    return has_twin(encoding) and encoding.is_exact


def _exactly(search: Callable[[Codec, bool], T], codec: Codec, domain: str) -> T:
    """Return the result of a search in float64, over z >= 0 unless the domain is "sphere". Raises UsageError if a
    user's own twin supports only float32."""
    try:
        return search(codec, domain != "sphere")
    except TypeError as error:
        where = codec.encoding.twin
        message = str(error).splitlines()[0]
        raise UsageError(f"{where}: fails in float64: {message}; leave out --worst-case and --codes") from error


def held(codec: Codec, domain: str | None, s: Statistics, sup_deg: float | None) -> Row:
    """Return the columns of the bounds, and each bound as a percentage of the codec's figure; for the maximum, the
    figure is the supremum if that is known. Return {} without a domain.

    If float32 normals cannot resolve errors of that size, the percentages and the check against the bounds are left
    out.
    """
    if not domain:
        return {}
    least = code_limit(codec.codes, AREAS[domain])
    row: Row = {"limit_mean_deg": least.mean_deg, "limit_rms_deg": least.rms_deg, "limit_max_deg": least.max_deg}
    if not is_measurable(least):
        return row
    return row | {
        "reached_mean_percent": _percent_of(least.mean_deg, s.angle_mean_deg),
        "reached_rms_percent": _percent_of(least.rms_deg, s.angle_rms_deg),
        "reached_max_percent": _percent_of(least.max_deg, s.angle_max_deg if sup_deg is None else sup_deg),
        "below_limit": broken(codec.codes, AREAS[domain], s),
    }


def _percent_of(least: float, figure: float) -> float:
    return 100 * least / figure if figure else math.inf
