"""The rows of `mix`: the result of each operation on a codec's texels, by the model and by the OpenGL device."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import jax
import numpy as np

from ....encodings.codecs.codec import Codec
from ....gbuffer.codecs.codec_passes import Decoded
from ....gbuffer.codecs.mixing.passes import BY_DEVICE, SIDE, MixPasses
from ....gbuffer.gl.device import Device, device
from ...shaders.code.twin import has_twin
from ..table import Row
from ..unmeasurable import UNMEASURABLE
from .figures import Figures, outside, percent
from .means import BY_NORMALS, STORED_AGAIN
from .model import BY_MODEL, MODEL, WAYS, Given, Texels, Way
from .patches import TEXELS, Mixes
from .programs import Programs
from .reference import angles_between
from .table import AGREE_DEG, OF_INTEGER, TABLE
from .worst import climbed

# JAX compiles for one number of normals.
BLOCK = 2**14
# The share of results, in percent, that a way to mix must explain.
EXPLAINED = 99.9
# Numbers that are the same but for the last bits of float32.
SAME = 2.0**-20


@dataclass(frozen=True)
class MixCase:
    """A codec on one set of patches by one backend, measured in a row for each operation.

    Attributes:
        codec, mixes, backend, operations: what is measured.
        power: the specular power to which Toksvig's formula is applied.
        domain: the domain of the normals to mix, if smaller than the encoding's domain; otherwise empty.
        worst_case: whether to search for the worst mix.
    """

    codec: Codec
    mixes: Mixes
    backend: str
    operations: tuple[str, ...]
    power: float
    domain: str = ""
    worst_case: bool = False

    @property
    def name(self) -> str:
        patches = self.mixes.patches
        angle = "" if patches.angle_deg is None else f" {patches.angle_deg:g}"
        angle += f" edge {patches.edge_deg:g}" if patches.edge_deg else ""
        return f"{self.codec.name} {patches.name}{angle} {self.backend}"


@dataclass(frozen=True, eq=False)
class Result:
    """The results of the operations of a case.

    Attributes:
        texels: decoded texels of the patches, (TEXELS, patches, 3).
        mixed: result of each operation, decoded, not renormalised, (patches, 3).
        how: columns on how the texels were mixed, by operation.
        said: columns on the device.
    """

    texels: np.ndarray
    mixed: Mapping[str, np.ndarray]
    how: Mapping[str, Row]
    said: Row


class Modelled:
    """A codec's texels by the model."""

    def __init__(self, codec: Codec, mixes: Mixes):
        self._codec, self._mixes, self._programs = codec, mixes, Programs(codec, BLOCK)
        self._texels = Texels(codec)
        self._views = mixes.patches.views

    def decoded(self, codes: np.ndarray) -> np.ndarray:
        """Return the normals decoded from codes (numbers, ..., patches), of shape (..., patches, 3)."""
        shape = codes.shape[1:]
        views = np.broadcast_to(self._views, (*shape, 3)).reshape(-1, 3)
        return self._programs.normals(codes.reshape(len(codes), -1), views).reshape(*shape, 3)

    def _raw_and_stored(self, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        shape = normals.shape[:-1]
        views = np.broadcast_to(self._views, normals.shape).reshape(-1, 3)
        codes = self._programs.codes(normals.reshape(-1, 3), views)
        raw, stored = (code.reshape(len(code), *shape) for code in codes)
        return raw, stored

    def texels(self) -> np.ndarray:
        """Return the stored codes of the patches' texels, of shape (numbers, TEXELS, patches)."""
        return self._raw_and_stored(self._mixes.patches.normals)[1]

    def given(self, codes: np.ndarray) -> Given:
        """Return the input of the model: stored codes of the texels, and the values that shaders write onto them."""
        over = np.stack([self._mixes.patches.normals[1], self._mixes.decals])
        written = self._texels.of(self._raw_and_stored(over)[0])
        # What was stored is written once more: float32 has moved it by a unit, and means of texels lie on ties.
        return Given(self._texels.written(self._texels.of(codes), self._codec.rounding), written[:, 0], written[:, 1])

    def mixed(self, operation: str, given: Given, way: Way) -> np.ndarray:
        """Return the numbers that an operation on stored codes gives in the model, of shape (numbers, patches)."""
        return self._texels.code(BY_MODEL[operation](self._texels, given, self._mixes, way))

    def of_normals(self, operation: str, texels: np.ndarray) -> np.ndarray:
        """Return the result of an operation on decoded texels (TEXELS, patches, 3), of shape (patches, 3)."""
        normals = BY_NORMALS[operation](texels.astype(np.float64), self._mixes)
        return self.decoded(self._raw_and_stored(normals)[1]) if operation in STORED_AGAIN else normals


def _result_by_jax(case: MixCase) -> Result:
    model = Modelled(case.codec, case.mixes)
    codes = model.texels()
    texels, given = model.decoded(codes), model.given(codes)
    stored = [name for name in case.operations if name in BY_MODEL]
    numbers = [model.mixed(name, given, MODEL) for name in stored]
    mixed = dict(zip(stored, model.decoded(np.stack(numbers, axis=1)), strict=True)) if stored else {}
    mixed |= {name: model.of_normals(name, texels) for name in case.operations if name in BY_NORMALS}
    how = {name: {"mixed_by": str(MODEL) if name in BY_MODEL else None} for name in case.operations}
    return Result(texels, mixed, how, {"device": jax.devices()[0].device_kind})


def _result_by_glsl(case: MixCase) -> Result:
    gl: Device = device()
    with MixPasses(gl, case.codec, case.mixes.meetings(), case.mixes.samples) as passes:
        texels = passes.texels()
        images = {name: BY_DEVICE[name](passes) for name in case.operations}
    height, width, _ = texels.normals.shape
    blocks = (_blocked_image(a, height // SIDE, width // SIDE) for a in (texels.normals, texels.codes))
    decoded, codes = blocks
    flat = {name: Decoded(image.normals.reshape(-1, 3), image.codes.reshape(-1, 4)) for name, image in images.items()}
    numbers = case.codec.encoding.components + case.codec.encoding.sign_bits
    how = _compared(case, np.moveaxis(codes[..., :numbers], -1, 0), flat)
    return Result(decoded, {name: mixed.normals for name, mixed in flat.items()}, how, {"device": gl.renderer})


def _blocked_image(image: np.ndarray, height: int, width: int) -> np.ndarray:
    """Return an image of `height` by `width` patches, rearranged to the shape (TEXELS, patches, channels)."""
    split = image.reshape(height, SIDE, width, SIDE, -1)
    return split.transpose(1, 3, 0, 2, 4).reshape(TEXELS, height * width, -1)


def _compared(case: MixCase, codes: np.ndarray, decoded: Mapping[str, Decoded]) -> dict[str, Row]:
    """Return columns for each operation: the way of mixing that best explains the device's numbers, if codes are
    mixed, and the percentage of results that agree. Empty for an encoding that exists only in shaders.

    The model mixes the codes that the device stored.
    """
    if not has_twin(case.codec.encoding):
        return {name: {} for name in decoded}
    model = Modelled(case.codec, case.mixes)
    given = model.given(codes)
    return {
        name: _way_columns(model, name, given, mixed, case.mixes.patches.count)
        if name in BY_MODEL
        else {"agree_percent": _agreed_percent(model.of_normals(name, model.decoded(codes)), mixed.normals, case)}
        for name, mixed in decoded.items()
    }


def _agreed_percent(model: np.ndarray, normals: np.ndarray, case: MixCase) -> float:
    count = case.mixes.patches.count
    return percent(angles_between(model[:count], normals[:count]) <= AGREE_DEG)


def _way_columns(model: Modelled, operation: str, given: Given, decoded: Decoded, count: int) -> Row:
    best, least, numbers, off = MODEL, np.inf, np.empty(0), 0.0
    for way in WAYS[operation]:
        tried = model.mixed(operation, given, way)
        apart = np.abs(tried.T[:count] - decoded.codes[:count, : len(tried)]).max(axis=1)
        missed = float(np.mean(~(apart <= SAME)))
        if missed < least:
            best, least, numbers, off = way, missed, tried, float(apart.max())
        if not least:
            break
    agreed = percent(angles_between(model.decoded(numbers)[:count], decoded.normals[:count]) <= AGREE_DEG)
    own = f"its own arithmetic, up to {off:.2g} off"
    return {"mixed_by": str(best) if agreed >= EXPLAINED else own, "agree_percent": agreed}


BY_THE_MODEL = "jax"
BACKENDS: Mapping[str, Callable[[MixCase], Result]] = MappingProxyType(
    {BY_THE_MODEL: _result_by_jax, "glsl": _result_by_glsl}
)


def measure(case: MixCase) -> list[Row]:
    """Return a row for each operation of a case; rows that cannot be measured have the reason in `skipped`."""
    described = _case_columns(case)
    domain = case.domain or case.codec.encoding.domain
    if not case.mixes.patches.held_by(domain).any():
        reason = outside(case.mixes.patches.name, domain)
        return [described | {"operation": name, "skipped": reason} for name in case.operations]
    refused = [name for name in case.operations if name in BY_MODEL] if case.codec.is_integer else []
    allowed = tuple(name for name in case.operations if name not in refused)
    rows = [described | {"operation": name, "skipped": OF_INTEGER} for name in refused]
    rows += _measured(replace(case, operations=allowed), domain) if allowed else []
    return sorted(rows, key=lambda row: case.operations.index(row["operation"]))


def _measured(case: MixCase, domain: str) -> list[Row]:
    """Return a row for each operation of a case; if the backend cannot measure it, with the reason in `skipped`."""
    described = _case_columns(case)
    try:
        outcome = BACKENDS[case.backend](case)
    except UNMEASURABLE as error:
        return [described | {"operation": name, "skipped": str(error)} for name in case.operations]
    figures = Figures(case.mixes, domain, case.power, outcome.texels, outcome.mixed)
    return [
        described
        | {"operation": name}
        | figures.of(name)
        | _worst_columns(case, figures, name)
        | outcome.how[name]
        | outcome.said
        for name in case.operations
    ]


def _worst_columns(case: MixCase, figures: Figures, operation: str) -> Row:
    """Return the largest error that a search with the model finds for an operation on codes, and the normals of that
    mix; empty if no search is requested, or the case is not measured by the model."""
    is_searched = case.worst_case and operation in BY_MODEL and case.backend == BY_THE_MODEL
    errors = figures.errors(operation) if is_searched else np.array([-1.0])
    if errors.max() < 0:
        return {}
    domain = case.domain or case.codec.encoding.domain

    def figures_of(mixes: Mixes) -> Figures:
        result = _result_by_jax(replace(case, mixes=mixes, operations=(operation,)))
        return Figures(mixes, domain, case.power, result.texels, result.mixed)

    worst = climbed(case.mixes, errors, lambda mixes: figures_of(mixes).errors(operation), case.mixes.patches.seed)
    row = figures_of(worst).of(operation)
    named = {name: row[name] for name in ("worst_first", "worst_second", "worst_right", "worst_result")}
    return {"angle_worst_deg": row["angle_max_deg"]} | named


def _case_columns(case: MixCase) -> Row:
    patches = case.mixes.patches
    return TABLE.empty() | {
        "encoding": case.codec.encoding.name,
        "storage": case.codec.storage.name,
        "normals": patches.name,
        "angle_deg": patches.angle_deg,
        "edge_deg": patches.edge_deg,
        "backend": case.backend,
        "bits": case.codec.bits,
        "samples": case.mixes.samples,
        "power": case.power,
        "code_space": patches.code_space,
        "seed": patches.seed,
    }
