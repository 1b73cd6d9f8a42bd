"""Best-fit normals without a lookup: the encoder tries every length and keeps the most accurate of these 8-bit codes.

UNORM8 has no code for 0: its values are the odd multiples of 1/255, so that the largest component can be exactly on
128 of them.
"""

from pathlib import Path

from ..codecs.encoding import Encoding
from ..vec import Vec3, dot, floor, jnp, maximum, select, unit

LEVELS = 256
# A code replaces a longer one if it is better by more than rounding: codes along one line are as good, but for that.
BETTER = 1 - 2.0**-10


def _code(n: Vec3, k) -> Vec3:
    # c = the odd numbers nearest to k n / max |n|
    largest = maximum(maximum(abs(n.x), abs(n.y)), abs(n.z))
    half = n * (0.5 * k / largest)
    return Vec3(*(2.0 * floor(h) + 1.0 for h in half))


def encode(n: Vec3, view: Vec3) -> Vec3:
    """Map a unit normal to the vector of odd multiples of 1/255 nearest to its direction; on a tie, the longest."""
    from jax.lax import fori_loop  # a second to import, which `normalbench list` does not take

    def tried(step, carry):
        best, least = carry
        k = (LEVELS - 1.0) - 2.0 * jnp.asarray(step, n.x.dtype)
        c = _code(n, k)
        # the squared sine of the angle between: |n - c (c . n) / (c . c)|^2
        aside = n - c * (dot(c, n) / dot(c, c))
        misfit = dot(aside, aside)
        is_better = misfit < least * BETTER
        return select(is_better, k, best), select(is_better, misfit, least)

    start = (jnp.full_like(n.x, LEVELS - 1.0), jnp.full_like(n.x, 2.0))
    best, _ = fori_loop(0, LEVELS // 2, tried, start)
    return _code(n, best) * (1.0 / (LEVELS - 1))


def decode(e: Vec3, view: Vec3) -> Vec3:
    """Return the stored vector at unit length; a stored zero, which no normal produces, gives +x."""
    return unit(e)


ENCODING = Encoding(
    name="best_fit_searched",
    title="best-fit normals, searched",
    encode=encode,
    decode=decode,
    components=3,
    domain="sphere",
    citation="A. Kaplanyan, CryENGINE 3: Reaching the Speed of Light, SIGGRAPH 2010",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(8, 2),
    ulps_reason="of two codes whose squared angles differ by a thousandth either may be taken; one normalise",
    levels=(LEVELS,) * 3,  # whole already: what cuts off would cut at random
    searches=True,
    constants={"BEST_FIT_LEVELS": LEVELS, "BEST_FIT_BETTER": BETTER},
)
