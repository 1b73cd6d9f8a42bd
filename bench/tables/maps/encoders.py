"""Texture encoders: packages that compress blocks, imported on first use."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import version
from typing import Any

import numpy as np

from ...ground.output.errors import MissingError

# How hard encoders try: etcpak's BC7 from 0 to 4, quicktex' BC5 from 0 to its largest search and its BC3 from 0 to 18,
# astcenc from 0 to 100.
BC7_EFFORT, ASTC_EFFORT, BC3_EFFORT = 4, 60, 5


@dataclass(frozen=True)
class Texels:
    """The input of a texture encoder.

    Attributes:
        texels: 8-bit RGBA texels, row by row.
        size: width and height, multiples of 4.
        used: channels that matter.
    """

    texels: bytes
    size: tuple[int, int]
    used: str


@dataclass(frozen=True)
class Encoder:
    """A package that compresses textures.

    Attributes:
        package: name of the package in pip; empty if there is no package.
        modules: modules to import.
        said: effort of the compression, as shown in a row.
        make: returns blocks, row by row, given the modules and the texels.
        undo: returns texels, float32 of shape (height, width, 4), given the modules, the blocks and the size; None if
            not needed.
    """

    package: str
    modules: tuple[str, ...]
    said: str
    make: Callable[[Sequence[Any], Texels], bytes]
    undo: Callable[[Sequence[Any], bytes, tuple[int, int]], np.ndarray] | None = None

    @property
    def release(self) -> str:
        """The package and its version; empty without a package."""
        return f"{self.package} {version(self.package)}" if self.package else ""

    @property
    def name(self) -> str:
        """The package, its version and the effort as one text, separated by commas."""
        return ", ".join(filter(None, (self.release, self.said)))

    @property
    def missing(self) -> str:
        """The reason why the encoder cannot be used, and how to install its package; empty if it can be used."""
        try:
            self._modules()
        except ImportError as error:
            return f"requires {self.package} ({error}); run: pip install {self.package}"
        return ""

    def encoded(self, given: Texels) -> bytes:
        """Return the blocks of an image, row by row. Raises MissingError if the package is not installed."""
        return self.make(self._found_modules(), given)

    def decoded(self, blocks: bytes, size: tuple[int, int]) -> np.ndarray:
        """Return the texels of compressed blocks, float32 of shape (height, width, 4) in [0, 1]. Raises MissingError
        if the package is not installed."""
        assert self.undo
        return self.undo(self._found_modules(), blocks, size)

    def _modules(self) -> list[Any]:
        return [import_module(name) for name in self.modules]

    def _found_modules(self) -> list[Any]:
        if missing := self.missing:
            raise MissingError(missing)
        return self._modules()


def _as_it_is(_: Sequence[Any], given: Texels) -> bytes:
    return given.texels


def _as_it_was(_: Sequence[Any], texels: bytes, size: tuple[int, int]) -> np.ndarray:
    return np.frombuffer(texels, np.uint8).reshape(size[1], size[0], 4).astype(np.float32) / np.float32(255)


def _bc5_bytes(modules: Sequence[Any], given: Texels) -> bytes:
    quicktex, bc5 = modules
    return bc5.BC5Encoder().encode(quicktex.RawTexture.frombytes(given.texels, *given.size)).tobytes()


def _bc3_bytes(modules: Sequence[Any], given: Texels) -> bytes:
    quicktex, bc3 = modules
    return bc3.BC3Encoder(BC3_EFFORT).encode(quicktex.RawTexture.frombytes(given.texels, *given.size)).tobytes()


def _bc7_bytes(modules: Sequence[Any], given: Texels) -> bytes:
    (etcpak,) = modules
    effort = etcpak.BC7CompressBlockParams()
    effort.init_linear_weights()
    effort.m_weights = [int(channel in given.used) for channel in "rgba"]
    effort.m_uber_level = BC7_EFFORT
    return etcpak.compress_bc7(given.texels, *given.size, effort)


def _rg11_bytes(modules: Sequence[Any], given: Texels) -> bytes:
    (etcpak,) = modules
    return etcpak.compress_eac_rg(given.texels, *given.size)


def _astc_context(astc: Any, used: str) -> Any:
    settings = astc.ASTCConfig(astc.ASTCProfile.LDR, 4, 4, quality=ASTC_EFFORT)
    for channel in "rgba":
        setattr(settings, f"cw_{channel}_weight", float(channel in used))
    return astc.ASTCContext(settings)


def _astc_bytes(modules: Sequence[Any], given: Texels) -> bytes:
    (astc,) = modules
    image = astc.ASTCImage(astc.ASTCType.U8, *given.size, data=given.texels)
    return _astc_context(astc, given.used).compress(image, astc.ASTCSwizzle())


def _astc_texels(modules: Sequence[Any], blocks: bytes, size: tuple[int, int]) -> np.ndarray:
    """Return the texels of ASTC blocks, float32 of shape (height, width, 4), decoded with the precision that the
    specification requires, 16-bit floats."""
    (astc,) = modules
    image = astc.ASTCImage(astc.ASTCType.F32, *size)
    _astc_context(astc, "rgba").decompress(blocks, image, astc.ASTCSwizzle())
    return np.frombuffer(image.data, np.float32).reshape(size[1], size[0], 4)


NONE = Encoder("", (), "uncompressed", _as_it_is, _as_it_was)
QUICKTEX = Encoder("quicktex", ("quicktex", "quicktex.s3tc.bc5"), "rgbcx, default search", _bc5_bytes)
BC3 = Encoder("quicktex", ("quicktex", "quicktex.s3tc.bc3"), f"rgbcx, level {BC3_EFFORT} of 18", _bc3_bytes)
BC7 = Encoder("etcpak", ("etcpak",), f"bc7enc, effort {BC7_EFFORT} of 4", _bc7_bytes)
RG11 = Encoder("etcpak", ("etcpak",), "EAC", _rg11_bytes)
ASTC = Encoder("astc-encoder-py", ("astc_encoder",), f"astcenc, effort {ASTC_EFFORT} of 100", _astc_bytes, _astc_texels)
