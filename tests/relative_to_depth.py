"""Measure the gain of storing a normal in the frame of the depth's normal, by surface, next to two more bits.

    python -m tests.relative_to_depth
    python -m tests.relative_to_depth --picture

print the table of docs/beyond-octahedral.md, in half a minute, and draw its picture. The frame is that of T. Duff et
al., Building an Orthonormal Basis, Revisited (2017); a local number c is stored as sign(c) |c|^p.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from PIL import Image

import normalbench as nb

WIDTH, HEIGHT, FIELD, NEAR = 640, 480, 60.0, 0.1
# The sphere's segments around and from pole to pole.
SEGMENTS = (32, 16)
POWER = 0.5
UNROUNDED = "octahedral/rg32f"
# Degrees below which an angle is rounding, and decibels above which all of it is.
EXACT, MOST_DB = 1e-5, 60.0
SHOWN, PICTURE = (
    ("mapped mirror", "mapped sphere", "segmented sphere"),
    Path(__file__).parents[1] / "docs" / "pictures" / "relative-to-depth.png",
)
# Pixels of the picture's panels.
ACROSS = 160
# How depth is kept: a float of the share near / distance, and 24 or 16 bits of it.
DEPTHS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "R32F": lambda share: share.astype(np.float32).astype(np.float64),
    "D24": lambda share: np.round(share * (2**24 - 1)) / (2**24 - 1),
    "D16": lambda share: np.round(share * (2**16 - 1)) / (2**16 - 1),
}


def unit(vectors: np.ndarray) -> np.ndarray:
    """Return unit vectors of any shape (..., 3)."""
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def rays() -> np.ndarray:
    """Return the rays through the pixels' centres, with z = -1, of shape (HEIGHT, WIDTH, 3)."""
    high = np.tan(np.radians(FIELD / 2))
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH] + 0.5
    return np.stack([(2 * x / WIDTH - 1) * high * WIDTH / HEIGHT, (1 - 2 * y / HEIGHT) * high, -np.ones_like(x)], -1)


def surfaces() -> Iterator[tuple[str, np.ndarray, np.ndarray, np.ndarray]]:
    """Yield each surface's name, distances along z (0 for the background), shading normals and triangles' normals,
    in view space."""
    ray = rays()
    for name, normal, distance in (("wall", (0.3, 0.1, 1.0), 3.0), ("mapped floor", (0, 1, 0), 1.5)):
        flat = np.broadcast_to(unit(np.array(normal, float)), ray.shape)
        facing = (ray * flat).sum(-1)
        depth = np.where(facing < -1e-3, -distance / np.minimum(facing, -1e-3), 0.0)
        depth = np.where(depth < 60, depth, 0.0)
        if name == "wall":
            yield name, depth, flat, flat
            continue
        place = ray * depth[..., None]
        yield name, depth, bumped(flat, place, 0.45), flat
        yield "mapped mirror", depth, bumped(flat, place, 0.05), flat
    middle = np.array([0.0, 0.0, -3.0])
    b, c = ray @ middle, middle @ middle - 1.0
    root = b * b - (ray * ray).sum(-1) * c
    depth = np.where(root > 0, (b - np.sqrt(np.maximum(root, 0))) / (ray * ray).sum(-1), 0.0)
    smooth = unit(ray * depth[..., None] - middle)
    yield "smooth sphere", depth, smooth, smooth
    yield "mapped sphere", depth, bumped(smooth, ray * depth[..., None], 0.45), smooth
    yield ("segmented sphere", *segmented(ray, middle))


def bumped(flat: np.ndarray, place: np.ndarray, height: float) -> np.ndarray:
    """Return normals that waves of several lengths turn by up to about `height` radians each way."""
    waves = [(7.0, 3.0, 0.0), (-5.0, 11.0, 1.0), (17.0, -13.0, 2.0), (23.0, 29.0, 3.0)]
    x, y, z = np.moveaxis(place, -1, 0)
    across = sum(np.sin(a * x + b * (y + z) + c) for a, b, c in waves) / 2
    along = sum(np.cos(b * x - a * (y + z) + c) for a, b, c in waves) / 2
    first, second = basis(flat)
    return unit(flat + height * (across[..., None] * first + along[..., None] * second))


def segmented(ray: np.ndarray, middle: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return distances, smooth normals and flat normals of a sphere of flat segments, seen from outside."""
    around, down = SEGMENTS
    u, v = np.meshgrid((np.arange(around) + 0.5) / around * 2 * np.pi, (np.arange(down) + 0.5) / down * np.pi)
    planes = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], -1).reshape(-1, 3)
    # A segment's corners are on the sphere: its plane is nearer to the middle.
    away = np.cos(np.pi / around) * np.sin(v) ** 2 + np.cos(v) ** 2
    away = (away * np.cos(np.pi / (2 * down))).ravel()
    depth, last, which = np.full(ray.shape[:2], -np.inf), np.full(ray.shape[:2], np.inf), np.zeros(ray.shape[:2], int)
    for index, (plane, distance) in enumerate(zip(planes, away, strict=True)):
        facing, to = ray @ plane, distance + plane @ middle
        t = to / np.where(facing == 0, 1e-12, facing)
        is_later = (facing < 0) & (t > depth)
        depth, which = np.where(is_later, t, depth), np.where(is_later, index, which)
        last = np.where(facing > 0, np.minimum(last, t), last)
    depth = np.where(depth < last, depth, 0.0)
    return depth, unit(ray * depth[..., None] - middle), planes[which]


def basis(n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two tangents for each normal (Duff et al. 2017)."""
    x, y, z = np.moveaxis(n, -1, 0)
    sign = np.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return np.stack([1 + sign * x * x * a, sign * b, -sign * x], -1), np.stack([b, sign + y * y * a, -y], -1)


def from_depth(share: np.ndarray, kind: type = np.float64) -> np.ndarray:
    """Return the normal that depth gives at each pixel: in each direction the neighbours on the side on which depth
    goes on straight, five taps a direction (2 d1 - d2 - d0 is the least); computed in `kind`."""
    share = share.astype(kind)
    place = rays().astype(kind) * (kind(NEAR) / np.maximum(share, kind(1e-9)))[..., None]

    def step(axis: int) -> np.ndarray:
        d = [np.roll(share, -k, axis) for k in (-2, -1, 0, 1, 2)]
        before, after = abs(2 * d[1] - d[0] - d[2]), abs(2 * d[3] - d[4] - d[2])
        forward, backward = np.roll(place, -1, axis) - place, place - np.roll(place, 1, axis)
        return np.where((after <= before)[..., None], forward, backward)

    g = np.cross(step(0), step(1))
    norm = np.linalg.norm(g, axis=-1, keepdims=True)
    g = np.where(norm > 0, g / np.maximum(norm, kind(1e-30)), [0.0, 0.0, 1.0])
    return np.where((g * place).sum(-1, keepdims=True) > 0, -g, g).astype(np.float64)


def encoded(n: np.ndarray) -> np.ndarray:
    """Return the octahedral numbers of normals, in [-1, 1]^2 with +z in the middle."""
    return np.asarray(nb.encode(UNROUNDED, n.astype(np.float32)).values, np.float64)


def decoded(e: np.ndarray) -> np.ndarray:
    """Return the normals of octahedral numbers."""
    return np.asarray(nb.decode(UNROUNDED, e.astype(np.float32)), np.float64)


def stored(e: np.ndarray, bits: int, power: float = 1.0) -> np.ndarray:
    """Return numbers after rounding to a centred code of `bits` bits, in which 0 is exact."""
    levels = 2 ** (bits - 1) - 1
    bent = np.copysign(abs(e) ** power, e)
    kept = np.round(bent * levels) / levels
    return np.copysign(abs(kept) ** (1 / power), kept)


def relative(n: np.ndarray, written: np.ndarray, read: np.ndarray, bits: int) -> np.ndarray:
    """Return normals after a trip through the frame of `written`, and back through that of `read`."""
    first, second = basis(written)
    local = np.stack([(n * first).sum(-1), (n * second).sum(-1), (n * written).sum(-1)], -1)
    back_again = decoded(stored(encoded(local), bits, POWER))
    first, second = basis(read)
    return unit(back_again[..., :1] * first + back_again[..., 1:2] * second + back_again[..., 2:] * read)


def angles(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the angles between unit vectors, in degrees."""
    return np.degrees(2 * np.arcsin(np.clip(np.linalg.norm(a - b, axis=-1) / 2, 0, 1)))


def moved(share: np.ndarray, kind: str, rng: np.random.Generator) -> np.ndarray:
    """Return depth as a reader sees it whose depth is off by one unit of its storage in two of three pixels."""
    ulp = np.spacing(share.astype(np.float32)).astype(np.float64) if kind == "R32F" else 1 / (2 ** int(kind[1:]) - 1)
    return np.where(share > 0, share + ulp * rng.integers(-1, 2, share.shape), share)


def rows(bits: int = 8) -> Iterator[list[str]]:
    """Yield a row of the page's table for each surface: the gain in dB of the RMS angle over octahedral of as many
    bits, and for depth also the share of pixels that a reader whose depth is off sees more than 1 degree off."""
    rng = np.random.default_rng(7)
    for name, depth, n, flat in surfaces():
        seen = depth > 0
        exact, inner = np.where(seen, NEAR / np.maximum(depth, NEAR), 0.0), seen & seen_around(seen)

        def gain(back: np.ndarray, n=n, inner=inner) -> float:
            plain = angles(n, decoded(stored(encoded(n), bits)))[inner]
            return float(10 * np.log10(np.mean(plain**2) / max(np.mean(angles(n, back)[inner] ** 2), EXACT**2)))

        cells = [name]
        for kind, store in DEPTHS.items():
            g, other = from_depth(store(exact)), from_depth(moved(store(exact), kind, rng))
            torn = 100 * np.mean(angles(n, relative(n, g, other, bits))[inner] > 1)
            cells.append(f"{gain(relative(n, g, g, bits)):.1f}" + (f", {torn:.0f} % off" if torn >= 1 else ""))
        exactly = gain(relative(n, flat, flat, bits))
        cells.append("exact" if exactly > MOST_DB else f"{exactly:.1f}")
        yield [*cells, f"{gain(decoded(stored(encoded(n), bits + 1))):.1f}"]


def seen_around(seen: np.ndarray) -> np.ndarray:
    """Return whether a surface covers all pixels within two of a pixel, so that silhouettes do not decide."""
    steps = [(axis, k) for axis in (0, 1) for k in (-2, -1, 1, 2)]
    return np.logical_and.reduce([np.roll(seen, k, axis) for axis, k in steps])


def _rms(angle: np.ndarray) -> float:
    return float(np.sqrt(np.mean(angle**2))) if angle.size else 0.0


def asides(bits: int = 8) -> Iterator[str]:
    """Yield lines on what the table leaves out: tilts of maps, silhouettes, arithmetic and more bits."""
    for name, depth, n, flat in surfaces():
        seen = depth > 0
        share = np.where(seen, NEAR / np.maximum(depth, NEAR), 0.0)
        g, other = from_depth(DEPTHS["D24"](share)), from_depth(DEPTHS["D24"](share), np.float32)
        edges, inner = seen & ~seen_around(seen), seen & seen_around(seen)
        plain, back = (angles(n, turned) for turned in (decoded(stored(encoded(n), bits)), relative(n, g, g, bits)))
        ten = [_rms(angles(n, turned)[inner]) for turned in (decoded(stored(encoded(n), 10)), relative(n, g, g, 10))]
        torn = 100 * np.mean(angles(n, relative(n, g, other, bits))[inner] > 1)
        yield (
            f"{name}: tilt {_rms(angles(n, flat)[inner]):.0f} degrees RMS; 99 % and largest angle"
            f" {' and '.join(f'{np.percentile(a[inner], 99):.2f}, {a[inner].max():.2f}' for a in (plain, back))};"
            f" edges {' and '.join(f'{_rms(a[edges]):.2f}' for a in (plain, back))};"
            f" 10:10 gains {20 * np.log10(ten[0] / max(ten[1], EXACT)):.1f} dB; reader in float32 {torn:.2f} % off"
        )


def picture() -> None:
    """Draw the page's picture: the angles on three surfaces, from 0 to 1 degree, of octahedral 8:8 and 9:9, of the
    same relative to depth's normal in D24, and of a reader whose D16 is off."""
    rng, lines = np.random.default_rng(7), []
    for name, depth, n, _ in surfaces():
        if name not in SHOWN:
            continue
        seen = depth > 0
        share = np.where(seen, NEAR / np.maximum(depth, NEAR), 0.0)
        fine, coarse = (from_depth(DEPTHS[kind](share)) for kind in ("D24", "D16"))
        off = from_depth(moved(DEPTHS["D16"](share), "D16", rng))
        turned = (
            decoded(stored(encoded(n), 8)),
            decoded(stored(encoded(n), 9)),
            relative(n, fine, fine, 8),
            relative(n, coarse, off, 8),
        )
        y, x = (int(place.mean()) - ACROSS // 2 for place in np.nonzero(seen))
        crop = np.s_[y : y + ACROSS, x : x + ACROSS]
        lines.append(np.hstack([np.where(seen, np.clip(angles(n, other), 0, 1), 0)[crop] for other in turned]))
    image = Image.fromarray(np.round(255 * colormaps["viridis"](np.vstack(lines))[..., :3]).astype(np.uint8))
    image.quantize(32).save(PICTURE, optimize=True)


def main() -> None:
    """Print the rows of the page's table and the lines next to it; with --picture, draw the page's picture."""
    if "--picture" in sys.argv[1:]:
        return picture()
    for line in asides():
        print(line)
    for cells in rows():
        print("|", " | ".join(cells), "|")
    return None


if __name__ == "__main__":
    main()
