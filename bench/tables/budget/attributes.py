"""The surface attributes that a G-buffer stores, their possible encodings, and the words for them in a layout."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from types import MappingProxyType

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.catalogue import CURVE_ENCODINGS, ENCODINGS, LIGHT_BUFFERS
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.curve_codec import CurveCodec
from ....encodings.codecs.light_codec import LightCodec
from ....encodings.storages.rules import by_rule
from ....encodings.storages.storage import STORAGES, TARGET_FORMATS
from ....encodings.vec import Vec3, Vec4
from ....gbuffer.scenes.metal_rough import DIELECTRIC

# What a channel holds.
UNORM, SRGB, FLOAT, RGB9E5 = "unorm", "srgb", "float", "rgb9e5"
NORMAL = "normal"
# The words of a layout that what an image shows lies in.
COMPONENTS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "normal": ("normal.x", "normal.y", "normal.z"),
        "base_color": ("base_color.r", "base_color.g", "base_color.b"),
        "roughness": ("roughness",),
        "metallic": ("metallic",),
        "f0": ("f0",),
        "ao": ("ao",),
    }
)
# What a surface has of an attribute that no G-buffer keeps.
WITHOUT: Mapping[str, float] = MappingProxyType({"metallic": 0.0, "f0": DIELECTRIC, "ao": 1.0, "emissive": 0.0})
# The curve that leaves numbers as they are.
ITSELF = "linear"


@dataclass(frozen=True)
class Surfaces:
    """The surfaces visible in pixels, as float32: world-space normals, base colours and emitted light of shape
    (height, width, 3), all others of shape (height, width). Each field is named like its attribute."""

    normal: np.ndarray
    base_color: np.ndarray
    roughness: np.ndarray
    metallic: np.ndarray
    f0: np.ndarray
    ao: np.ndarray
    emissive: np.ndarray


@dataclass(frozen=True)
class Code:
    """An encoding of an attribute in a G-buffer.

    Attributes:
        attribute: name of the attribute.
        name: name of the encoding, such as `octahedral 11:11`.
        words: words of a layout, without bits, in the order of the components.
        bits: number of bits of each component.
        kind: the kind of channel that the encoding needs if it does not share one: UNORM, SRGB or FLOAT.
        blends: whether the mean of two texels encodes the mean, so that decals may blend into the encoding.
        in_fields: whether the encoding may share a channel with others, as a bit field.
        is_exact: whether the bits must round-trip unchanged.
        trip: a function that returns surfaces after a round trip; None if the image does not read the attribute.
    """

    attribute: str
    name: str
    words: tuple[str, ...]
    bits: tuple[int, ...]
    kind: str = UNORM
    blends: bool = False
    in_fields: bool = True
    is_exact: bool = False
    trip: Callable[[Surfaces], Surfaces] | None = None

    @property
    def key(self) -> tuple[str, str]:
        """The names that identify the encoding: its attribute and its own name."""
        return self.attribute, self.name

    @property
    def total_bits(self) -> int:
        return sum(self.bits)


def _sized(bits: tuple[int, ...]) -> str:
    return ":".join(map(str, bits))


@cache
def _compiled(codec: Codec) -> Callable[[Vec3], Vec3]:
    def trip(n: Vec3) -> Vec3:
        return codec.round_trip(n, n)

    return jax.jit(trip)


def _normal_trip(codec: Codec, surfaces: Surfaces) -> Surfaces:
    planes = _compiled(codec)(Vec3(*np.moveaxis(surfaces.normal, -1, 0)))
    return replace(surfaces, normal=np.stack([np.asarray(plane) for plane in planes], axis=-1))


def _curve_trip(attribute: str, codecs: tuple[CurveCodec, ...], surfaces: Surfaces) -> Surfaces:
    given = getattr(surfaces, attribute)
    channels = [given] if given.ndim == 2 else list(np.moveaxis(given, -1, 0))
    back = [np.asarray(codec.round_trip(x)) for x, codec in zip(channels, codecs, strict=True)]
    return replace(surfaces, **{attribute: back[0] if given.ndim == 2 else np.stack(back, axis=-1)})


def _normal(encoding: str, bits: tuple[int, ...], storage: str = "", kind: str = UNORM, blends: bool = False) -> Code:
    normal_storage = STORAGES[storage] if storage else by_rule("unorm", bits)
    codec = Codec(ENCODINGS[encoding], normal_storage)
    words = tuple(f"normal.{axis}" for axis in "xyz"[: len(bits)])
    name = f"{encoding} {_sized(bits)}" + (" in halves" if kind == FLOAT else "")
    return Code(
        "normal", name, words, bits, kind, blends, kind == UNORM and not blends, trip=partial(_normal_trip, codec)
    )


def _normals() -> Iterator[Code]:
    for bits in range(10, 17):
        yield _normal("octahedral", (bits, bits))
    yield _normal("xyz_renormalised", (10,) * 3, blends=True)
    yield _normal("xyz_renormalised", (16,) * 3, blends=True)
    yield _normal("xyz_renormalised", (16,) * 3, "rgba16f", FLOAT, blends=True)


def _on_curve(
    attribute: str, component: str, curve: str, bits: tuple[int, ...], kind: str = UNORM, limit: float | None = None
) -> Code:
    encoding = CURVE_ENCODINGS[curve]
    codecs = tuple(CurveCodec(encoding, by_rule("unorm", (b,)), limit or encoding.usual_range) for b in bits)
    over = "" if limit is None else f" to {limit:g}"
    name = f"{curve if kind != SRGB else 'sRGB'} {_sized(bits)}{over}"
    is_itself = curve == ITSELF
    shown = component if kind == SRGB or (is_itself and limit is None) else _curved(curve, limit, component)
    words = tuple(f"{shown}".replace(component, f"{component}.{c}") for c in "rgb") if len(bits) == 3 else (shown,)
    blends = kind == SRGB or is_itself
    return Code(attribute, name, words, bits, kind, blends, kind == UNORM, trip=partial(_curve_trip, attribute, codecs))


def in_halves(attribute: str) -> Iterator[Code]:
    """Yield the only encoding of an attribute in 16-bit floats, for layouts with float targets."""
    if attribute == "normal":
        yield _normal("octahedral", (16, 16), "rg16f", FLOAT)
        return
    codec, words = CurveCodec(CURVE_ENCODINGS[ITSELF], TARGET_FORMATS["r16f"], 1.0), COMPONENTS[attribute]
    trip = partial(_curve_trip, attribute, (codec,) * len(words))
    yield Code(attribute, "in halves", words, (16,) * len(words), FLOAT, True, False, trip=trip)


def _curved(curve: str, limit: float | None, component: str) -> str:
    return f"{curve}({component})" if limit is None else f"{curve}:{limit:g}({component})"


def _base_colors() -> Iterator[Code]:
    yield _on_curve("base_color", "base_color", "srgb", (8, 8, 8), SRGB)
    # Textures have 8 bits: more would keep nothing that they have.
    for bits in ((7, 7, 6), (7, 7, 7), (8, 8, 8)):
        yield _on_curve("base_color", "base_color", "square_root", bits)
    yield _on_curve("base_color", "base_color", ITSELF, (10, 10, 10))


def _singles(attribute: str, sizes: Iterable[int], curve: str = ITSELF) -> Iterator[Code]:
    """Yield the encodings of a one-component attribute, one per bit count."""
    (component,) = COMPONENTS[attribute]
    for bits in sizes:
        yield _on_curve(attribute, component, curve, (bits,))


@dataclass(frozen=True)
class Attribute:
    """A surface attribute that a G-buffer stores.

    Attributes:
        name: name of the attribute.
        codes: possible encodings, from the minimum upwards.
        usual_bits: minimum number of bits if no scene shows the errors of the encodings.
        is_seen: whether an image reads the attribute; if not, its number of bits is fixed by contract.
    """

    name: str
    codes: tuple[Code, ...]
    usual_bits: int = 0
    is_seen: bool = True


def exact_bits(name: str, word: str, bits: int) -> Attribute:
    """Return an attribute whose bits must round-trip unchanged, such as an ID."""
    parts = tuple(min(bits - start, MOST_PART) for start in range(0, bits, MOST_PART))
    code = Code(name, f"{bits} bits", (word,) * len(parts), parts, is_exact=True)
    return Attribute(name, (code,), bits, False)


# The bits of one word of a layout that holds a whole number.
MOST_PART = 16
# The codes of motion, each with the pixels a frame of 1920 x 1080 up to which it is off by less than 1/16 pixel; rest
# is exact in all of them. The last one is for a word with others, which saves bits and is no upscaler's input.
HALF_MOTION = Code("motion", "linear in halves", ("motion.x", "motion.y"), (16, 16), FLOAT, in_fields=False)
FAST_MOTION = Code("motion", "linear 16:16", ("linear(motion.x)", "linear(motion.y)"), (16, 16))
ROOT_MOTION = Code("motion", "sqrt 14:14", ("sqrt(motion.x)", "sqrt(motion.y)"), (14, 14))
UP_TO_PIXELS: Mapping[Code, float] = MappingProxyType({HALF_MOTION: 100.0, FAST_MOTION: 500.0, ROOT_MOTION: 64.0})


def motion(speed: float, is_packed: bool = False) -> Attribute:
    """Return the motion attribute with encodings for a speed in pixels per frame: half floats, as upscalers read
    them, or 16 bits per component for higher speeds; with `is_packed` also square roots, if they suit the speed."""
    whole = next(code for code in (HALF_MOTION, FAST_MOTION) if speed <= UP_TO_PIXELS[code])
    packed = (ROOT_MOTION,) if is_packed and speed <= UP_TO_PIXELS[ROOT_MOTION] else ()
    codes = (whole, *packed)
    return Attribute("motion", codes, min(code.total_bits for code in codes), False)


def _emission(name: str, buffer: str, word: str, bits: tuple[int, ...], kind: str) -> Code:
    trip = partial(_light_trip, LIGHT_BUFFERS[buffer])
    return Code("emissive", name, (word,), bits, kind, in_fields=False, trip=trip)


def _light_trip(codec: LightCodec, surfaces: Surfaces) -> Surfaces:
    r, g, b = (jnp.asarray(plane) for plane in np.moveaxis(surfaces.emissive, -1, 0))
    back = codec.round_trip(Vec4(r, g, b, jnp.ones_like(r)))
    return replace(surfaces, emissive=np.stack([np.asarray(plane) for plane in back[:3]], axis=-1))


# Light has no largest value: its floor is the relative error of these codes, of the largest channel half of 2^-8 for
# RGB9E5, half of 2^-6 for R11G11B10F.
EMISSION = Attribute(
    "emissive",
    (
        _emission("RGB9E5", "rgb9e5", "rgb9e5(emissive)", (32,), RGB9E5),
        _emission("R11G11B10F", "r11g11b10f", "emissive", (11, 11, 10), FLOAT),
        _emission("in halves", "rgba16f", "emissive", (16, 16, 16), FLOAT),
    ),
    32,
)


def _reflectances() -> Iterator[Code]:
    for bits in range(3, 9):
        # The usual 0.04 lies on a code: one that it lies between is off everywhere, by half a step. Engines' 0.08 is in
        # the range.
        share = (2 ** (bits - 1) - 1) / (2**bits - 1)
        yield _on_curve("f0", "f0", ITSELF, (bits,), limit=_short(DIELECTRIC / share))


def _short(limit: float) -> float:
    """Return a range rounded to the six digits with which a layout writes it."""
    return float(f"{limit:.6g}")


SEEN: Mapping[str, Attribute] = MappingProxyType(
    {
        attribute.name: attribute
        for attribute in (
            Attribute("normal", tuple(_normals()), 20),
            Attribute("base_color", tuple(_base_colors()), 18),
            Attribute(
                "roughness",
                (
                    *_singles("roughness", range(6, 13)),
                    *_singles("roughness", range(6, 13), "square_root"),
                    # In a channel of its own: nobody splits 16 bits for it.
                    replace(_on_curve("roughness", "roughness", ITSELF, (16,)), in_fields=False),
                ),
                8,
            ),
            Attribute(
                "metallic",
                tuple(_singles("metallic", range(3, 9))),
                # Filtered maps have values between 0 and 1.
                4,
            ),
            Attribute("f0", tuple(_reflectances()), 5),
            Attribute("ao", tuple(_singles("ao", range(4, 9))), 6),
        )
    }
)


def usual(attribute: Attribute) -> Attribute:
    """Return an attribute with only its encodings of the usual number of bits or more, for an attribute that no scene
    shows."""
    return replace(attribute, codes=tuple(c for c in attribute.codes if c.total_bits >= attribute.usual_bits))
