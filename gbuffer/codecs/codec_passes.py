"""Round trips of normals through a real render target: one fragment pass encodes, a second decodes the texture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...encodings import vec
from ...encodings.codecs.codec import Codec
from ...encodings.codecs.encoding import AXES, Encoding
from ...encodings.storages.storage import R32F, ROUNDINGS, STORAGES, Storage, rounds_to
from ..gl.device import Device
from ..gl.shader import ShaderError
from .harness import Passes, check_functions, dithering, exact, takes_view

# What a renderer of 32 bits does not draw.
BY_JAX = "use quality, mix or motion with JAX"
KINDS = ("unorm", "snorm", "float")


def encoding_defines(encoding: Encoding, as_half: bool = False) -> dict[str, object]:
    """Return the macros that adapt `code.glsl` to an encoding.

    Args:
        as_half: whether the shader is compiled with 16-bit types, as encodings in half arithmetic require.

    Raises:
        ShaderError: the encoding's GLSL file cannot be read or lacks one of the two functions; or the encoding is a
            chain of codecs, or uses half arithmetic without `as_half`.
    """
    if encoding.before:
        raise ShaderError(f"{encoding.name}: a chain of codecs cannot be drawn into a G-buffer; {BY_JAX}")
    if encoding.is_half and not as_half:
        raise ShaderError(f"{encoding.name}: OpenGL computes shaders in 32 bits; for half arithmetic {BY_JAX}")
    check_functions(encoding.glsl, encoding.signatures)
    return {
        "CODE": f"vec{encoding.components + encoding.sign_bits}",
        **_function_defines(encoding),
        "COMPONENTS": encoding.components,
        "SIGN_BITS": encoding.sign_bits,
        "LEVELS": levels_of(encoding),
        "PRECISE": int(encoding.is_precise),
        **vec.CONSTANTS,
        **encoding.constants,
    }


def _function_defines(encoding: Encoding) -> dict[str, object]:
    names: dict[str, object] = {side.upper(): f"{encoding.prefix}_{side}" for side in ("encode", "decode")}
    short = {name: function for name, function in names.items() if not takes_view(encoding.glsl, str(function))}
    own: dict[str, object] = {f"SHORT_{name}": function for name, function in short.items()}
    names |= {name: f"viewed_{name.lower()}" for name in short}
    if not encoding.is_turned:
        return own | names
    order, back = AXES[encoding.axis]
    own |= {"OWN_" + name: function for name, function in names.items()}
    own |= {"AXES": order, "AXES_BACK": back, "AXES_SIGN": float(encoding.sign)}
    return own | {"ENCODE": "turned_encode", "DECODE": "turned_decode"}


def levels_of(encoding: Encoding) -> tuple[int, ...]:
    """Return the number of values that each of a code's three numbers can have; 0 for ordinary numbers."""
    return tuple(encoding.levels_of(component) for component in range(3))


def storage_kind(storage: Storage) -> int:
    """Return a format's kind as numbered in `storage.glsl`: UNORM 0, SNORM 1, half 2, small float 3, float32 4."""
    if storage.kind == "float":
        return {16: 2, 32: 4}.get(storage.bits[0], 3)
    return KINDS.index(storage.kind)


def rounding_defines(
    device: Device, storage: Storage, rounding: str = "nearest", channels: Sequence[str] = ()
) -> tuple[str, dict[str, object]]:
    """Return whether the device or the shader rounds numbers for a storage, and the macros of `storage_defines`.

    Args:
        rounding: one of ROUNDINGS.
        channels: rounding of each channel, if channels differ.

    Returns:
        "device" if the format's own conversion rounds as requested, else "shader"; and the macros.
    """
    # Cut off, a centred integer goes toward its zero in the middle, and not toward that of its target.
    is_cut_otherwise = storage.is_centred and rounding != "nearest"
    is_own = storage.is_packed or is_cut_otherwise
    is_native = not is_own and device.native_rounding(storage.target) == rounding
    roundings = channels or [rounding] * storage.channels
    return "device" if is_native else "shader", storage_defines(storage, roundings, not is_native)


def storage_defines(storage: Storage, roundings: Sequence[str], shader_rounds: bool) -> dict[str, object]:
    """Return the macros that adapt `storage.glsl` to a storage, with a rounding from ROUNDINGS for each channel. The
    shader rounds if `shader_rounds` is true, else the device."""
    channels = [i % storage.channels for i in range(4)]
    scales = [storage.scale(i) for i in channels]
    return {
        "STORAGE_KIND": storage_kind(storage),
        "STORAGE_BIASED": int(storage.is_biased),
        "STORAGE_PART": storage.part,
        "STORAGE_WORD": int(storage.is_word),
        "STORAGE_MOST": tuple(float(storage.most(i)) for i in channels),
        **_form_defines(storage),
        "STORAGE_CENTRED": int(storage.is_centred),
        "STORAGE_CHANNELS": storage.channels,
        "STORAGE_SCALE": tuple(float(scale) for scale in scales),
        "STORAGE_STEP": tuple(float(np.float32(1 / scale)) for scale in scales),
        "STORAGE_BITS": tuple(storage.bits[i] for i in channels),
        "STORAGE_ROUNDING": tuple(ROUNDINGS.index(roundings[i]) for i in channels),
        "SHADER_ROUNDS": int(shader_rounds),
    }


def _form_defines(storage: Storage) -> dict[str, object]:
    form = storage.form
    defines = {"STORAGE_EXPONENT": form.exponent, "STORAGE_SIGNED": int(form.is_signed)} if form else {}
    return {"STORAGE_FLOATS": int(form is not None), **defines}


@dataclass(frozen=True)
class Decoded:
    """Decoded texels: `normals` as decoded, (height, width, 3); `codes` as stored, (height, width, 4); float32."""

    normals: np.ndarray
    codes: np.ndarray


class CodecPasses(Passes):
    """A codec on an OpenGL device; a context manager that releases its resources there.

    Attributes:
        rounded_by: "device" if the format's own conversion rounds as the codec requires, else "shader".

    Raises:
        ShaderError: the encoding's GLSL does not compile.
    """

    def __init__(self, device: Device, codec: Codec):
        encoding, storage = codec.encoding, codec.storage
        self._before = CodecPasses(device, encoding.before) if encoding.before else None
        channels = [codec.rounding_of(channel) for channel in range(storage.channels)]
        self.rounded_by, rounds = rounding_defines(device, storage, rounds_to(codec.rounding), channels)
        added, noise = dithering(codec.dither(0).added if codec.is_dithered else None)
        defines = encoding_defines(replace(encoding, before=None)) | rounds | added
        formats = {"texels": storage.target} | ({"signed_depths": R32F} if encoding.sign_bits else {})
        shaders, names = ("encode.frag", "decode.frag"), {"ENCODING": encoding.glsl}
        super().__init__(device, shaders, defines, names, formats, lambda: {**encoding.tables(), **noise()})

    def __exit__(self, *error: object) -> None:
        if self._before:
            self._before.__exit__(*error)
        super().__exit__(*error)

    def round_trip(self, normals: np.ndarray, views: np.ndarray) -> Decoded:
        """Return normals, given with view positions, after encoding, storage and decoding; and the stored codes.

        Args:
            normals, views: float32 of shape (height, width, 4).

        Raises:
            FormatError: the device cannot render to the storage's format.
        """
        if self._before:
            normals = _unit_pixels(self._before.round_trip(normals, views).normals)
        decoded, codes = self._through([STORAGES["rgba32f"]] * 2, normals=normals, views=views)
        return Decoded(decoded[..., :3], codes)


def _unit_pixels(normals: np.ndarray) -> np.ndarray:
    """Return directions, (height, width, 3), at length 1, with 0 as the fourth number: (height, width, 4)."""
    length = np.sqrt(np.sum(normals * normals, axis=-1, keepdims=True))
    return np.concatenate([normals / np.maximum(length, vec.TINY), np.zeros_like(length)], axis=-1)


def exact_values(device: Device, encoding: Encoding, normals, views, given) -> tuple[np.ndarray, np.ndarray]:
    """Return the codes of normals, and the normals of given codes, from a compute shader, without storage.

    Args:
        normals, views, given: float32 arrays of shape (count, 4).

    Returns:
        codes and decoded normals, float32 arrays of shape (count, 4).
    """
    defines, names = encoding_defines(encoding), {"ENCODING": encoding.glsl}
    codes, decoded = exact(device, "parity.comp", defines, names, [normals, views, given], 2, encoding.tables)
    return codes, decoded
