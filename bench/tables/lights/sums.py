"""The error from adding up light: the model of each light buffer next to the OpenGL device's own result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.light_buffer import IDEAL, Blending, accumulate
from ....encodings.codecs.light_codec import LightCodec
from ....encodings.shared.chromaticity import coloured, luminance
from ....encodings.storages.rounding import to_srgb
from ....encodings.storages.storage import Storage
from ....encodings.vec import Vec3, Vec4
from ....gbuffer.codecs.light.light_passes import LightPasses, Sum
from ....gbuffer.display import displayed
from ....gbuffer.gl.device import Device
from ...shaders.code.twin import NoTwinError
from ..table import Row

CHANNELS = "rgba"
# How devices have been found to add light up, the plainest first.
ROUNDINGS = {
    "nearest": IDEAL,
    "truncated": Blending("truncate"),
    "source first": Blending(rounds_source=True),
    "source first, products by shifts": Blending(rounds_source=True, by_shifts=True),
}
# The share of pixels that a way to round must explain; transcendental functions differ by a unit or two, and so may the
# code of a number beside a tie.
EXPLAINED = 0.99
ORDERS = ("as drawn", "dimmest first", "brightest first")
COLOURS = {"white": (1.0, 1.0, 1.0), "red": (1.0, 0.0, 0.0), "green": (0.0, 1.0, 0.0), "blue": (0.0, 0.0, 1.0)}
# Of fields and of ramps; a lamp's reach.
PIXELS, GRADIENT, REACH = 1024, 4096, 4.0


def planes(array: np.ndarray) -> Vec4:
    """Return an array of shape (..., 4) as four float32 planes."""
    return Vec4(*(jnp.asarray(np.ascontiguousarray(array[..., i], np.float32)) for i in range(4)))


def array(planes: Sequence[Any]) -> np.ndarray:
    """Return planes as one float32 array of shape (..., channels): the inverse of `planes`."""
    return np.stack([np.asarray(c, np.float32) for c in planes], axis=-1)


@partial(jax.jit, static_argnames=("encoding", "blending"))
def _sum_and_texels(encoding: LightCodec, lights: Vec4, count, blending: Blending) -> tuple[Vec4, Vec4]:
    texels = accumulate(encoding, lights, count, blending)
    return encoding.decode(texels), texels


@dataclass(frozen=True)
class Rounding:
    """The device's rounding when it adds up light, in words, and the share of pixels that a model reproduces."""

    name: str
    share: float


class Adder:
    """A context manager that adds up light in one encoding, by the model and, if there is one, by the OpenGL device.

    Raises:
        ShaderError: the encoding's GLSL does not compile.
    """

    def __init__(self, encoding: LightCodec, device: Device | None):
        self.encoding = encoding
        self._has_model = has_light_twin(encoding)
        self._passes = LightPasses(device, encoding) if device else None

    def __enter__(self) -> Adder:
        return self

    def __exit__(self, *_: object) -> None:
        if self._passes:
            self._passes.__exit__()

    @property
    def channels(self) -> int:
        """The number of channels of light: 4 if the encoding has alpha, otherwise 3."""
        return 4 if self.encoding.has_alpha else 3

    def model(self, lights: np.ndarray, count: int | None = None, blending: Blending = IDEAL) -> Sum | None:
        """Return the sum of the first `count` lights by the model, by default of all lights; None for an encoding
        that exists only in shaders.

        Args:
            lights: float32 of shape (lights, width, 4)."""
        if not self._has_model:
            return None
        light, texels = _sum_and_texels(
            self.encoding, planes(lights), len(lights) if count is None else count, blending
        )
        return Sum(array(light), array(texels))

    def device(self, lights: np.ndarray, count: int | None = None) -> Sum | None:
        """Return the sum of the first `count` lights by the OpenGL device; None without one. Raises FormatError."""
        return self._passes.accumulate(lights[:count]) if self._passes else None

    @cached_property
    def rounding(self) -> Rounding | None:
        """The plainest rounding that best explains the OpenGL device's sums; None without a device or a model."""
        lights = (np.random.default_rng(0).uniform(0, 1, (64, PIXELS, 4)) ** 2 * 0.05).astype(np.float32)
        got = self.device(lights) if self._has_model else None
        if not got:
            return None
        shares: dict[str, float] = {}
        for name, blending in ROUNDINGS.items():
            shares[name] = self._explained_share(lights, blending, got)
            if shares[name] == 1.0:
                break
        name = max(shares, key=lambda name: shares[name])
        if shares[name] >= EXPLAINED:
            return Rounding(name, shares[name])
        alone = self.device(lights[:1])
        assert alone
        if any(self._explained_share(lights[:1], blending, alone) >= EXPLAINED for blending in ROUNDINGS.values()):
            return Rounding("its own blending", shares[name])
        return Rounding(f"its own conversion{self._conversion_error()}", shares[name])

    def _explained_share(self, lights: np.ndarray, blending: Blending, got: Sum) -> float:
        model = self.model(lights, None, blending)
        assert model
        apart = steps_apart(self.encoding.storage, model.texels, got.texels)
        # An integer is the same or is not; floats may be a unit apart.
        allowed = 0.5 if self.encoding.storage.kind == "unorm" else 1.0
        return float(np.mean(np.all(apart <= allowed, axis=-1)))

    def _conversion_error(self) -> str:
        """Return text on the largest error of the fixed-point numbers that the device stores, such as `, 0.50 steps
        off`, which is the best possible; empty for other formats."""
        if self.encoding.storage.kind != "unorm":
            return ""
        lights = np.repeat(np.linspace(0, self.encoding.limit, 2**14, dtype=np.float32)[:, None], 4, axis=1)[None]
        got, storage = self.device(lights), self.encoding.storage
        assert got
        given = array(self.encoding.encode(planes(lights[0])))
        codes, exact = (steps_of(storage, texels) for texels in (got.texels, given))
        return f", {np.abs(np.round(codes) - exact).max():.2f} steps off"


def steps_apart(storage: Storage, texels: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the distances between texels in steps of the format, of shape (..., channels of the format)."""
    if storage.kind == "unorm":
        return np.abs(steps_of(storage, texels) - steps_of(storage, other))
    apart = []
    for i in range(storage.channels):
        a, b = texels[..., i].astype(np.float64), other[..., i].astype(np.float64)
        form = storage.float_form(i)
        exponent = np.floor(np.log2(np.maximum(np.abs(a), 2.0 ** (1 - form.one))))
        apart.append(np.abs(a - b) / np.exp2(exponent - form.mantissa))
    return np.stack(apart, axis=-1)


def steps_of(storage: Storage, texels: np.ndarray) -> np.ndarray:
    """Return fixed-point texels in steps of the format, not necessarily whole, of shape (..., channels)."""
    curved = [np.asarray(to_srgb(jnp.asarray(texels[..., i], jnp.float32))) for i in range(storage.curved)]
    straight = [texels[..., i] for i in range(storage.curved, storage.channels)]
    scales = [storage.scale(channel) for channel in range(storage.channels)]
    return np.stack([*curved, *straight], axis=-1).astype(np.float64) * scales


def has_light_twin(codec: LightCodec) -> bool:
    """Whether a light encoding has a JAX version. Raises any error of its Python code."""
    try:
        jax.eval_shape(codec.encode, Vec4(*[jax.ShapeDtypeStruct((1,), jnp.float32)] * 4))
    except NoTwinError:
        return False
    return True


def worst_rounding(adder: Adder, light: np.ndarray) -> np.ndarray | None:
    """Return the largest change in each channel when light is stored once; None without a model.

    Args:
        light: array of shape (width, 4); pixels above the encoding's limit do not count."""
    below = np.where(np.max(light, axis=1, keepdims=True) <= adder.encoding.limit, light, 0.0).astype(np.float32)
    # A light that multiplies is stored beside none.
    stored = adder.model(below[None])
    return np.abs(stored.light - below).max(axis=0) if stored else None


def _channel_labels(by_channel: list[tuple[Any, ...]]) -> dict[tuple[Any, ...], str]:
    """Return a label, rgba or rgb and a, for each distinct tuple of figures.

    Args:
        by_channel: the figures of each channel."""
    names: dict[tuple[Any, ...], str] = {}
    for channel, what in zip(CHANNELS, by_channel, strict=False):
        names[what] = names.get(what, "") + channel
    return names


def equal_lights(adder: Adder, sums: Sequence[float], counts: Sequence[int]) -> Iterator[Row]:
    """Yield rows for blending N equal lights with sum S one by one: the result, its error and the error's bound."""
    for total in sums:
        ramp = np.repeat(np.linspace(0, min(total, adder.encoding.limit), GRADIENT)[:, None], 4, axis=1)
        half_step = worst_rounding(adder, ramp)
        for count in counts:
            lights = np.full((max(counts), 1, 4), total / count, np.float32)
            model, gl = adder.model(lights, count), adder.device(lights, count)
            by_channel = [
                (
                    *(float(stored.light[0, i]) if stored else None for stored in (model, gl)),
                    None if half_step is None else count * float(half_step[i]) + max(total - adder.encoding.limit, 0),
                )
                for i in range(adder.channels)
            ]
            for (by_model, by_gl, bound), channel in _channel_labels(by_channel).items():
                row: Row = {"channel": channel, "sum": total, "lights": count, "model": by_model, "gl": by_gl}
                yield row | {"error": _off(by_model, total), "gl_error": _off(by_gl, total), "bound": bound}


def _off(summed: float | None, total: float) -> float | None:
    return None if summed is None else summed - total


def falloff(distance: np.ndarray, radius: float) -> np.ndarray:
    """Return a lamp's share of light at a distance, by the formula in `light.glsl`: 1 at 0, and 0 at the radius."""
    window = np.maximum(1 - (distance / radius) ** 4, 0)
    return window**2 / (distance**2 + 1)


def coloured_lights(count: int, total: float, seed: int) -> np.ndarray:
    """Return the light of random lamps over a field of pixels, (count, PIXELS, 4), scaled so that the largest sum in
    any channel and pixel is `total`.

    Three channels are diffuse light, the fourth is a highlight's luminance; brightness varies by a factor of up to
    30.
    """
    rng = np.random.default_rng(seed)
    pixels, lamps = rng.uniform(-3, 3, (PIXELS, 2)), rng.uniform(-3, 3, (count, 2))
    distance = np.linalg.norm(pixels[None] - lamps[:, None], axis=-1)
    colour = rng.uniform(0.05, 1, (count, 3)) * 30.0 ** rng.uniform(-1, 0, (count, 1))
    diffuse = colour[:, None] * falloff(distance, REACH)[..., None]
    highlight = np.asarray(luminance(Vec3(*np.moveaxis(diffuse, -1, 0)))) * np.exp(-(distance**2))
    lights = np.concatenate([diffuse, highlight[..., None]], axis=-1)
    return (lights * (total / lights.sum(axis=0).max())).astype(np.float32)


def ordered(lights: np.ndarray, order: str) -> np.ndarray:
    """Return lights sorted in one of ORDERS, the same for every pixel."""
    by_brightness = np.argsort(lights.sum(axis=(1, 2)), kind="stable")
    return lights[{ORDERS[0]: np.arange(len(lights)), ORDERS[1]: by_brightness, ORDERS[2]: by_brightness[::-1]}[order]]


def random_lights(adder: Adder, total: float, counts: Sequence[int], seed: int) -> Iterator[Row]:
    """Yield rows with the errors from summing coloured lights in three orders, and the bound on the errors."""
    for count in counts:
        lights = coloured_lights(count, total, seed)
        exact = lights.sum(axis=0, dtype=np.float64)[:, : adder.channels]
        step, beyond = worst_rounding(adder, _partial_sums(lights.sum(axis=0))), exact.max() - adder.encoding.limit
        bound = None if step is None else count * float(step[: adder.channels].max()) + max(float(beyond), 0.0)
        padded = np.zeros((max(counts), *lights.shape[1:]), np.float32)
        for order in ORDERS:
            padded[:count] = ordered(lights, order)
            row: Row = {"order": order, "sum": total, "lights": count, "bound": bound}
            for name, stored in (("model", adder.model(padded, count)), ("gl", adder.device(padded, count))):
                apart = np.abs(stored.light[:, : adder.channels] - exact) if stored else None
                row[f"{name}_rms"] = float(np.sqrt(np.mean(apart**2))) if apart is not None else None
                row[f"{name}_max"] = float(apart.max()) if apart is not None else None
            yield row


def _partial_sums(light: np.ndarray) -> np.ndarray:
    """Return ramps from 0 to the brightest pixel of each channel, (GRADIENT, 4), for light of shape (width, 4)."""
    shares = np.linspace(0, 1, GRADIENT // 4)[:, None, None]
    return (shares * light[light.argmax(axis=0)]).reshape(-1, 4)


def gradient(peak: float) -> np.ndarray:
    """Return white light from a lamp's centre to its edge, float32 of shape (GRADIENT, 4)."""
    light = peak * falloff(np.linspace(0, REACH, GRADIENT), REACH)
    return np.repeat(light[:, None], 4, axis=1).astype(np.float32)


def banding(adder: Adder, peaks: Sequence[float]) -> Iterator[Row]:
    """Yield rows with the levels that remain of a lamp's falloff, and the largest step, in light and as displayed."""
    for peak in peaks:
        light = gradient(peak)
        by_channel: list[tuple[Any, ...]] = []
        kept = [adder.model(light[None]), adder.device(light[None])]
        for i in range(adder.channels):
            by_channel.append(
                tuple(
                    value for stored in kept for value in (_band_figures(stored.light[:, i]) if stored else (None,) * 3)
                )
            )
        for figures, channel in _channel_labels(by_channel).items():
            row: Row = {"channel": channel, "peak": peak, "exact_step": float(np.abs(np.diff(light[:, 0])).max())}
            names = ("levels", "largest_step", "shown_step", "gl_levels", "gl_largest_step", "gl_shown_step")
            yield row | dict(zip(names, figures, strict=True))


def _band_figures(light: np.ndarray) -> tuple[int, float, float]:
    steps = np.abs(np.diff(light.astype(np.float64)))
    shown = np.abs(np.diff(displayed(light))) * 255
    return len(np.unique(light)), float(steps.max()), float(shown.max())


def chromaticity(adder: Adder) -> Iterator[Row]:
    """Yield rows with the error of a highlight's colour, which is rebuilt from the colour of the diffuse light, and
    the ratio of this error to the error of the stored value."""
    for name, colour in COLOURS.items():
        lights = np.zeros((GRADIENT, 4), np.float32)
        lights[:, :3] = colour
        specular = np.linspace(0, 1, GRADIENT)[:, None] * np.array(colour)
        lights[:, 3] = luminance(Vec3(*specular.T))
        row: Row = {"colour": name}
        for prefix, kept in (("", adder.model(lights[None])), ("gl_", adder.device(lights[None]))):
            if kept:
                alpha = np.abs(kept.light[:, 3] - lights[:, 3]).max()
                rebuilt = array(coloured(planes(kept.light).xyz, planes(kept.light).w))
                error = np.abs(rebuilt - specular).max()
                row |= {f"{prefix}stored_error": float(alpha), f"{prefix}error": float(error)}
                row[f"{prefix}amplification"] = float(error / alpha) if alpha else None
        yield row
