"""The rows of `lights`: each experiment on each light buffer, by the model and by the GL device."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.light_codec import LightCodec
from ....encodings.vec import Vec4
from ....gbuffer.codecs.light.light_passes import Resolved
from ....gbuffer.gl.device import Device, FormatError
from ....gbuffer.gl.shader import ShaderError
from ....gbuffer.pipelines import Pipeline
from ...ground.output.errors import MissingError, UsageError
from ...shaders.code.twin import NoTwinError
from .images import Lit, Resolves, Shot, targets_of, with_power
from .sums import Adder, banding, chromaticity, equal_lights, gradient, has_light_twin, random_lights
from .table import TABLE

# Why the GL device may not be able to give a row.
UNMEASURABLE = (ShaderError, FormatError)
Row = dict[str, Any]


@dataclass(frozen=True)
class Sums:
    """What is added up: sums of light, numbers of lights, peaks of falloff, and a seed."""

    sums: tuple[float, ...]
    counts: tuple[int, ...]
    peaks: tuple[float, ...]
    seed: int

    def equal(self, adder: Adder) -> Iterator[Row]:
        """Equal lights, blended one by one."""
        return equal_lights(adder, self.sums, self.counts)

    def random(self, adder: Adder) -> Iterator[Row]:
        """Coloured lights with falloff, in three orders; up to the least of the sums."""
        return random_lights(adder, min(self.sums), self.counts, self.seed)

    def banding(self, adder: Adder) -> Iterator[Row]:
        """A lamp's falloff."""
        return banding(adder, self.peaks)

    def chromaticity(self, adder: Adder) -> Iterator[Row]:
        """A highlight's colour rebuilt, by codes that hold what it is rebuilt from."""
        return chromaticity(adder) if adder.encoding.has_alpha else iter(())


SUM_EXPERIMENTS: dict[str, Callable[[Sums, Adder], Iterator[Row]]] = {
    "equal": Sums.equal,
    "random": Sums.random,
    "banding": Sums.banding,
    "chromaticity": Sums.chromaticity,
}
IMAGE_EXPERIMENTS = ("resolve", "image")
EXPERIMENTS = (*SUM_EXPERIMENTS, *IMAGE_EXPERIMENTS)
# What rows are sorted by, so that light buffers stand beside each other under the same conditions.
CONDITIONS = (
    "scene",
    "pipeline",
    "power",
    "light_targets",
    "samples",
    "backend",
    "sum",
    "lights",
    "order",
    "peak",
    "colour",
)


def check_light_twin(encoding: LightCodec) -> None:
    """Traces a light encoding's Python half. Raises UsageError where it fails; one line with its file."""
    light = Vec4(*[jax.ShapeDtypeStruct((1,), jnp.float32)] * 4)
    try:
        found = jax.eval_shape(lambda light: encoding.decode(encoding.encode(light)), light)
        if len(found) != 4:
            raise TypeError(f"{len(found)} numbers of light, not 4")
    except NoTwinError:
        return
    except Exception as error:  # whatever a user's own file raises
        place = encoding.glsl.with_suffix(".py")
        raise UsageError(f"{place}: {type(error).__name__}: {error}") from error


def _filled_row(experiment: str, encoding: LightCodec, device: Device | None, **more: Any) -> Row:
    described = {"experiment": experiment, "light_buffer": encoding.name}
    return TABLE.empty() | described | {"device": device.renderer if device else None} | more


def sum_rows(names: list[str], encoding: LightCodec, sums: Sums, device: Device | None) -> Iterator[Row]:
    """Rows of some of SUM_EXPERIMENTS; where the device cannot measure, the model's alone and the reason."""
    try:
        with Adder(encoding, device) as adder:
            rounding = adder.rounding
            found = [(name, row) for name in names for row in SUM_EXPERIMENTS[name](sums, adder)]
    except UNMEASURABLE as error:
        for row in sum_rows(names, encoding, sums, None):
            yield row | {"skipped": str(error)}
        return
    how = {"rounds": rounding.name, "agree_percent": 100 * rounding.share} if rounding else {}
    for name, row in found:
        yield _filled_row(name, encoding, device, seed=sums.seed, **how, **row)


def resolve_rows(
    device: Device, shot: Shot, encodings: list[LightCodec], given: dict[int, list[int]], seen: Callable[..., None]
) -> Iterator[Row]:
    """Rows of `resolve`.

    Args:
        given: the samples that the device has, and what was asked for each of them; 1 is always measured.
        seen: called with encoding, samples, the images by the device, those at one sample, and the right one.
    """
    all_made = {samples: Resolves(device, shot, encodings, samples) for samples in sorted({1, *given})}
    for encoding in encodings:
        for samples, asked in given.items():
            made, single = all_made[samples], all_made[1]
            described = {"scene": shot.name, "size": f"{shot.size[0]}x{shot.size[1]}", "seed": shot.seed}
            described |= {"samples": samples, "samples_asked": ",".join(map(str, asked))}
            if encoding in made.failed:
                yield _filled_row("resolve", encoding, device, **described, skipped=made.failed[encoding])
                continue
            images: dict[str, tuple[Resolved, Resolved]] = {}
            # The hardware averages a target's channels, and not the numbers that lie across them.
            if has_light_twin(encoding) and not encoding.storage.is_packed:
                images["model"] = (made.model(encoding), single.model(encoding))
            images["gl"] = (made.device(encoding), single.device(encoding))
            for backend, (found, aliased) in images.items():
                figures = made.compared(found, aliased)
                yield _filled_row("resolve", encoding, device, backend=backend, **described, **figures)
            seen(encoding, samples, *images["gl"], made.right)


def image_rows(
    device: Device,
    pipeline: Pipeline,
    shot: Shot,
    power: float,
    encodings: list[LightCodec],
    targets: list[int],
    seen: Callable[..., None],
) -> Iterator[Row]:
    """Rows of `image`, of a scene whose materials all have one specular power.

    Args:
        targets: how many the light buffer may have.
        seen: called with encoding, targets, the image and the reference.
    """
    lit = Lit(device, pipeline, with_power(shot, power))
    for encoding in encodings:
        for count in targets_of(pipeline, encoding, targets):
            described = {"pipeline": pipeline.name, "scene": shot.name, "power": power, "seed": shot.seed}
            described |= {"size": f"{shot.size[0]}x{shot.size[1]}", "light_targets": count}
            try:
                figures, image = lit.measure(encoding, count)
            except UNMEASURABLE as error:
                yield _filled_row("image", encoding, device, **described, skipped=str(error))
                continue
            yield _filled_row("image", encoding, device, **described, **figures)
            seen(encoding, count, image, lit.reference)


def sorted_rows(rows: list[Row]) -> list[Row]:
    """The rows by experiment and then by CONDITIONS, each in the order in which its values came up."""
    places = {
        column: {value: i for i, value in enumerate(dict.fromkeys(row[column] for row in rows))}
        for column in CONDITIONS
    }
    return sorted(
        rows, key=lambda row: (EXPERIMENTS.index(row["experiment"]), *(places[c][row[c]] for c in CONDITIONS))
    )


def banded(encoding: LightCodec, peak: float, device: Device | None) -> np.ndarray:
    """A lamp's falloff as a light buffer keeps it by the model, (width, 3); on the device where there is no model.

    Raises:
        MissingError: there is neither.
    """
    with Adder(encoding, device if not has_light_twin(encoding) else None) as adder:
        light = gradient(peak)[None]
        found = adder.model(light) or adder.device(light)
    if not found:
        raise MissingError(f"{encoding.name} is written for shaders alone, and there is no GL device")
    return found.light[:, :3]
