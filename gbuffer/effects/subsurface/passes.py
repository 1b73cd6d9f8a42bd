"""The passes of subsurface scattering: write skin's light, mark its pixels in a stencil, blur marked pixels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from math import pi
from types import MappingProxyType
from typing import Any

import numpy as np

from ...frame.canvas import NEAREST, Canvas, counted
from ...frame.contract import Pass, Run
from ...frame.resource import DEPTH_STENCIL, SURFACES, Resource
from ...frame.resources import BY_KIND, LIGHT, SHADOW_SIZE, SURFACE, TERMS
from ...gl import raw
from ...gl.handles import Query
from ..noise import NOISE
from .profile import GAUSSIANS, VARIANCES, WEIGHTS, burley_distances, burley_radii, gaussian_kernel, separable_kernel

# Diffuse light of skin before its albedo, and the skin's depth in metres; zero where there is no skin.
SKIN_LIGHT = Resource("skin_light", "rgba32f", follows=SURFACES)
# A stencil of its own: the frame's has as many samples as the frame, and the light here has one.
SKIN_MASK = Resource("skin_mask", DEPTH_STENCIL, follows=SURFACES)
# Blurred along rows, and not yet along columns.
SKIN_ACROSS = Resource("skin_across", "rgba32f", follows=SURFACES)
SKIN_GAUSSIANS = tuple(Resource(f"skin_gaussian_{i}", "rgba32f", follows=SURFACES) for i in range(1, 5))
# What the light is after it went through the skin, as SKIN_LIGHT holds it; `material.frag` reads it.
SCATTERED = Resource("scattered", "rgba32f", follows=SURFACES)
# How far from the sun it reaches the first surface; the frame's own shadow map holds the far sides of what casts.
SUN_ENTRY = Resource("sun_entry", "shadows", (SHADOW_SIZE, SHADOW_SIZE))

# The profile's millimetres that `width` metres stand for: the reach of the separable kernel.
MILLIMETRES = 3.0
# SeparableSSS.h takes its width w for half the height of a picture of 2 z tan(fov/2): a kernel of its reach 3 goes 2 w
# far. `width` here is how far it goes, in metres, and the header's numbers for its width are turned into those for 2 w.
HEADER_WIDTH = 2.0
CONSTANTS: Mapping[str, float] = {
    # Millimetres for each metre of thickness, times width / (1 - translucency)
    "THICKNESS": 8.25 * HEADER_WIDTH,
    # Widths that a point is moved into the skin: the header's 0.005 at the 0.012 of its demo.
    "SHRINK": 0.005 / (0.012 * HEADER_WIDTH),
    "BACK_WRAP": 0.3,  # how far light on the far side is wrapped around
}


@dataclass(frozen=True)
class Scatter:
    """Settings that all passes share.

    Attributes:
        width: width of the scattering, in metres.
        follow: share of the light that a depth step of one width blocks.
        samples: taps per blur.
    """

    width: float
    follow: float
    samples: int

    def defines(self, light: Resource, **more: object) -> dict[str, object]:
        """Return the macros of a blur of `light`, and the macros in `more`; FOLLOW is per metre of depth."""
        scale = {"SOURCE": light.name, "METRES": self.width / MILLIMETRES, "SAMPLES_TAKEN": self.samples}
        return {**scale, "FOLLOW": self.follow / self.width, **more}


def sun_entry() -> Pass:
    """Return the pass that draws the surfaces that sunlight reaches first; it is skipped if there are no shadows."""
    return Pass("sun_entry", (), (SUN_ENTRY,), _sun_entry, after=("lights",))


def _sun_entry(canvas: Canvas) -> Run:
    target, casters = canvas.target(depth=SUN_ENTRY), canvas.geometry("shadow_map.vert", "nothing.frag")

    def run() -> None:
        target.use()
        canvas.device.state(NEAREST)
        canvas.prepare(casters.program)
        for name in ("casters", "thin casters"):
            casters.draw(name)

    return run


def skin_light(width: float, translucency: float, transmits: bool) -> Pass:
    """Return the pass that writes skin's light, with transmitted sunlight if `transmits`, and marks the stencil."""
    reads = (*SURFACE, LIGHT, *((SUN_ENTRY,) if transmits else ()))
    numbers = {
        "TRANSMITS": int(transmits),
        "SHRINK": CONSTANTS["SHRINK"] * width,
        "THICKNESS_SCALE": CONSTANTS["THICKNESS"] * (1 - translucency) / width,
        "BACK_WRAP": CONSTANTS["BACK_WRAP"],
        "PROFILE_GAUSSIANS": len(VARIANCES),
        "VARIANCES": listed(VARIANCES),
        "WEIGHTS": listed(WEIGHTS),
    }
    return Pass(
        "skin_light",
        reads,
        (SKIN_LIGHT, SKIN_MASK),
        partial(_skin_light, numbers),
        after=("lights",),
        expects={"LIGHT_HOLDS": (TERMS, BY_KIND)},
        needs=frozenset({"shading_model"}),
    )


def _skin_light(numbers: Mapping[str, Any], canvas: Canvas) -> Run:
    target, covers = canvas.target(SKIN_LIGHT, depth=SKIN_MASK), canvas.fullscreen("skin_light.frag", **numbers)
    context = canvas.device.context

    def run() -> None:
        target.use()
        canvas.device.state(None)
        context.enable_direct(raw.STENCIL_TEST)
        # What the shader discards is not marked.
        raw.once_a_pixel(1)
        canvas.prepare(covers.program)
        covers.render(vertices=3)
        context.disable_direct(raw.STENCIL_TEST)

    return run


class Blur:
    """A blur pass: one shader over the marked pixels.

    Attributes:
        queries: the list to which each draw adds a query; None for no queries.
    """

    def __init__(self, shader: str, into: Resource, numbers: Mapping[str, Any], canvas: Canvas):
        self._canvas, self._target = canvas, canvas.target(into, depth=SKIN_MASK)
        self._covers = canvas.fullscreen(shader, **numbers)
        self.queries: list[Query] | None = None

    def __call__(self) -> None:
        context = self._canvas.device.context
        self._target.use()
        self._canvas.device.state(None)
        context.enable_direct(raw.STENCIL_TEST)
        # The mark stays for the next blur.
        raw.shade_marked(again=True)
        self._canvas.prepare(self._covers.program)
        with counted(self._canvas.device.context, self.queries):
            self._covers.render(vertices=3)
        context.disable_direct(raw.STENCIL_TEST)


def separable(scatter: Scatter) -> tuple[Pass, ...]:
    """Return two passes that blur skin's light along rows and then along columns, with the same kernel."""
    return _pair("", scatter, separable_kernel(scatter.samples), SKIN_LIGHT, SCATTERED)


def gaussians(scatter: Scatter, pairs: int) -> tuple[Pass, ...]:
    """Return `pairs` pairs of passes, one pair per Gaussian. Each pair blurs the previous result along rows and then
    along columns; the last pass adds up all Gaussians."""
    sum_of, levels, passes = GAUSSIANS[pairs], SKIN_GAUSSIANS[: pairs - 1], []
    begun = (SKIN_LIGHT, *levels)
    for number, (variance, light) in enumerate(zip(sum_of.increments.tolist(), begun, strict=True), 1):
        kernel = gaussian_kernel(variance, scatter.samples)
        if number < pairs:
            passes += _pair(f"_{number}", scatter, kernel, light, levels[number - 1])
        else:
            shares = {"GAUSSIANS": pairs, "SHARES": listed(sum_of.weights)}
            passes += _pair(f"_{number}", scatter, kernel, light, SCATTERED, begun, shares)
    return tuple(passes)


def burley(scatter: Scatter, seed: int) -> tuple[Pass, ...]:
    """Return one pass, in a tuple, that blurs skin's light with Burley's profile over a disc of taps."""
    distances = burley_distances()
    numbers = {
        "RADII": listed(burley_radii(scatter.samples)),
        "DISTANCES": listed(distances),
        "WIDEST": float(distances.max()),
        "GOLDEN": (3 - 5**0.5) / 2,
        "TURN": 2 * pi,
        "SEED": seed,
        **NOISE,
    }
    # The profile itself falls off with the distance in space: following is on or off.
    told = scatter.defines(SKIN_LIGHT, **numbers) | {"FOLLOW": float(scatter.follow > 0)}
    return (_blur_pass("skin_disc", "skin_disc.frag", (SKIN_LIGHT,), SCATTERED, told),)


def _pair(
    name: str,
    scatter: Scatter,
    kernel: np.ndarray,
    light: Resource,
    into: Resource,
    sums: tuple[Resource, ...] = (),
    shares: Mapping[str, Any] = MappingProxyType({}),
) -> tuple[Pass, Pass]:
    """Return two passes that blur `light` along rows and then along columns into `into`. The second also adds up the
    resources in `sums`, if any, with the weights in the macros `shares`."""
    told = {"KERNEL": listed(kernel), "GAUSSIANS": 0}
    rows = scatter.defines(light, ALONG_X=1, **told)
    columns = scatter.defines(SKIN_ACROSS, ALONG_X=0, **(told | dict(shares)))
    return (
        _blur_pass(f"skin_rows{name}", "skin_blur.frag", (light,), SKIN_ACROSS, rows),
        _blur_pass(f"skin_columns{name}", "skin_blur.frag", (SKIN_ACROSS, *sums), into, columns),
    )


def _blur_pass(name: str, shader: str, reads: tuple[Resource, ...], into: Resource, numbers: Mapping[str, Any]) -> Pass:
    tells = {"HAS_SCATTERED": 1} if into == SCATTERED else {}
    build = partial(Blur, shader, into, numbers)
    return Pass(name, (*reads, SKIN_MASK), (into,), build, after=("lights",), tells=tells)


def listed(numbers: np.ndarray) -> tuple[float, ...]:
    """Return the numbers of an array as floats, row by row, to pass to GLSL."""
    return tuple(float(x) for x in numbers.ravel())
