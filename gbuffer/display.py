"""The path from linear light to the image sent to a display: exposure, tone mapping, clipping, the sRGB curve."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..encodings.storages.rounding import SRGB_KNEE, SRGB_OFFSET, SRGB_POWER, SRGB_SLOPE


def _none(x: np.ndarray) -> np.ndarray:
    return x


def _reinhard(x: np.ndarray) -> np.ndarray:
    # L / (1 + L), for each channel
    return x / (1 + x)


def _aces(x: np.ndarray) -> np.ndarray:
    # x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)


# Light of one channel, 0 or more, to what is shown of it. Reinhard et al., Photographic Tone Reproduction for Digital
# Images, 2002, equation 3; Narkowicz, ACES Filmic Tone Mapping Curve, 2016.
TONE_MAPPINGS: Mapping[str, Callable[[np.ndarray], np.ndarray]] = MappingProxyType(
    {"none": _none, "reinhard": _reinhard, "aces": _aces}
)
# A measured exposure clips at most this share of the covered pixels, and is a multiple of this many stops.
CLIPPED, STEP = 0.01, 0.01
# The most stops either way.
MAX_EXPOSURE = 20.0


@dataclass(frozen=True)
class Display:
    """Settings of the image sent to a display.

    Attributes:
        exposure: exposure in stops; light is multiplied by 2^exposure.
        tone_mapping: one of TONE_MAPPINGS.
    """

    exposure: float = 0.0
    tone_mapping: str = "none"

    def light(self, linear: np.ndarray) -> np.ndarray:
        """Return linear light of any shape, exposed and tone mapped; values above 1 are not clipped yet."""
        exposed = np.maximum(np.asarray(linear, np.float64), 0.0) * 2.0**self.exposure
        return TONE_MAPPINGS[self.tone_mapping](exposed)

    def image(self, linear: np.ndarray) -> np.ndarray:
        """Return linear light exposed, tone mapped, clipped to [0, 1] and sRGB-encoded; not quantised to 8 bits."""
        return displayed(self.light(linear))

    def clipped(self, linear: np.ndarray) -> float:
        """Return the fraction of pixels, (count, 3), with a channel above 1 after tone mapping; 0 without pixels."""
        return float(np.mean(self.light(linear).max(axis=-1) > 1.0)) if len(linear) else 0.0


CLIPPED_ALONE = Display()


def displayed(linear: np.ndarray) -> np.ndarray:
    """Return linear light as sent to a display: clipped to [0, 1] and sRGB-encoded (IEC 61966-2-1), not yet 8-bit."""
    x = np.clip(np.asarray(linear, np.float64), 0.0, 1.0)
    curved = (1 + SRGB_OFFSET) * np.maximum(x, SRGB_KNEE) ** (1 / SRGB_POWER) - SRGB_OFFSET
    return np.where(x <= SRGB_KNEE, SRGB_SLOPE * x, curved)


def measured_exposure(linear: np.ndarray) -> float:
    """Return the highest exposure in stops that clips at most a fraction CLIPPED of the pixels, (count, 3). Only
    pixels with finite light above 0 count. The exposure is a multiple of STEP, from -MAX_EXPOSURE to MAX_EXPOSURE;
    it is 0 if no pixel has such light."""
    highest = np.asarray(linear, np.float64).max(axis=-1)
    highest = highest[np.isfinite(highest) & (highest > 0)]
    if not len(highest):
        return 0.0
    # Of the pixels themselves: what lies between two of them could clip one more.
    most = float(np.quantile(highest, 1 - CLIPPED, method="higher"))
    stops = math.floor(-math.log2(most) / STEP) * STEP
    return round(min(max(stops, -MAX_EXPOSURE), MAX_EXPOSURE), 2)
