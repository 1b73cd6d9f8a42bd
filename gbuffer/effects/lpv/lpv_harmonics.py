"""Constants of light propagation volumes: two bands of spherical harmonics and the solid angles of a cell's faces.

All are closed forms, which a test checks by integration.
"""

from __future__ import annotations

from math import atan, pi, sqrt

# Y_00 and the factor of Y_1-1, Y_10, Y_11 (Ramamoorthi and Hanrahan 2001, equation 3)
SH0, SH1 = sqrt(1 / (4 * pi)), sqrt(3 / (4 * pi))
# max(n.w, 0) in these bands: A_0 Y_00 and A_1 Y_1m with A_0 = pi, A_1 = 2 pi / 3 (the same, equation 8)
LOBE0, LOBE1 = pi * SH0, 2 * pi / 3 * SH1


def _square(half: float, distance: float) -> float:
    """Return the solid angle of a square with sides of 2 `half`, seen along its axis from a distance."""
    # Omega = 4 atan(a b / (d sqrt(a^2 + b^2 + d^2)))
    return 4 * atan(half * half / (distance * sqrt(2 * half * half + distance * distance)))


# From the centre of a cell into the next one: the far face lies 1.5 cells away. What passes the face between the two,
# a sixth of the sphere, meets the far face or one of four side faces.
FRONT = _square(0.5, 1.5)
SIDE = (4 * pi / 6 - FRONT) / 4
# The direction of a side face's centre: half a cell aside, one cell ahead.
ASIDE, AHEAD = 1 / sqrt(5), 2 / sqrt(5)

CONSTANTS = {
    "SH0": SH0,
    "SH1": SH1,
    "LOBE0": LOBE0,
    "LOBE1": LOBE1,
    "FRONT_ANGLE": FRONT,
    "SIDE_ANGLE": SIDE,
    "SIDE_ASIDE": ASIDE,
    "SIDE_AHEAD": AHEAD,
    # A face emits what arrives at it as a cosine lobe: flux / pi x lobe has that flux again.
    "PER_FLUX": 1 / pi,
}
