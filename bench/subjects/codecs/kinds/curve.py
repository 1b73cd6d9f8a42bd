"""Users' own encodings of roughness and similar quantities: curves."""

from __future__ import annotations

import numpy as np

from .....encodings.catalogue import CURVE_ENCODINGS
from .....encodings.codecs.curve_codec import CurveEncoding
from .....encodings.kinds import CURVE
from .own import COUNT, Own, OwnKind, Values, number, of_range, one_number_errors, rows


def _quantities(_: Own) -> Values:
    """Return evenly spaced values from 0 to 1, for functions with a range of 1."""
    return Values(rows(np.linspace(0, 1, COUNT)), of_range(COUNT))


def _curve_encoding(own: Own) -> CurveEncoding:
    usual = CURVE_ENCODINGS["linear"].storages
    return CurveEncoding(**own.described(), storages=usual, inverse_error=own.found.get("error_max", 0.0))


KIND = OwnKind(
    kind=CURVE,
    values=_quantities,
    errors=one_number_errors,
    unit="of the range",
    nearly=1e-2,
    exactly=lambda _: {"0": Values(rows(np.zeros(1)), of_range(1)), "1": Values(rows(np.ones(1)), of_range(1))},
    encoding=_curve_encoding,
    facts=lambda *_: {},
    said=number,
)
