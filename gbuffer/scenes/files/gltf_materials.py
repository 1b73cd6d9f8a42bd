"""Materials of glTF files: metallic-roughness parameters and the textures that vary them.

`MetalRough` has two numbers for blending and cut-outs, alpha and cutoff. An opaque material has an alpha of 1, as
have the texels of its texture. A cut-out material also has an alpha of 1: its alpha factor is included in the cutoff.
A blended material has an alpha below 1 if any texel of its texture has an alpha below 1.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..metal_rough import DIELECTRIC, Map, MetalRough, Wrap
from .gltf_data import Gltf, Object
from .source import resource
from .texels import PictureError, sides, texels

WRAPS: dict[object, Wrap] = {10497: "repeat", 33648: "mirror", 33071: "clamp"}
# Of all pictures of a file together.
MAX_TEXELS = 2**28
# The largest float32 below 1: a material that blends is told by an alpha below 1.
BLENDS = 1.0 - 2.0**-24
EMISSION, IOR = "KHR_materials_emissive_strength", "KHR_materials_ior"
TRANSFORM, WEBP, KTX2 = "KHR_texture_transform", "EXT_texture_webp", "KHR_texture_basisu"
# What a primitive without a material is made of (glTF 2.0, 3.9.2).
DEFAULT = MetalRough(base=(1.0, 1.0, 1.0), metalness=1.0, roughness=1.0)


class Materials:
    """The materials of a file, read one after another; an image that several materials use is decoded once.

    Attributes:
        notes: features of the materials that are not drawn.
    """

    def __init__(self, gltf: Gltf):
        self.notes: list[str] = []
        self._gltf = gltf
        self._pictures: dict[int, np.ndarray] = {}
        self._made: dict[tuple[int, str], np.ndarray] = {}
        self._texels_in_all = 0

    def all(self) -> Iterator[tuple[MetalRough, bool]]:
        """Yield each material, and whether its back faces are drawn. Raises SceneFileError."""
        for index in range(len(self._gltf.list_of(self._gltf.json, "materials", "the file"))):
            data = self._gltf.entry("materials", index, f"materials[{index}]")
            yield self._material(data, f"materials[{index}]"), data.get("doubleSided") is True

    def _material(self, data: Object, place: str) -> MetalRough:
        gltf = self._gltf
        pbr = gltf.child(data, "pbrMetallicRoughness", place)
        normal, occlusion = (gltf.child(data, key, place) for key in ("normalTexture", "occlusionTexture"))
        *base, factor = np.clip(gltf.numbers(pbr, "baseColorFactor", place, (1.0,) * 4), 0.0, 1.0).tolist()
        mode = data.get("alphaMode", "OPAQUE")
        base_map = self._map(pbr, "baseColorTexture", place, "opaque" if mode == "OPAQUE" else "colour")
        alpha, cutoff = self._coverage(data, place, mode, factor, base_map)
        return MetalRough(
            base=_triple(base),
            metalness=self._share(pbr, "metallicFactor", place),
            roughness=self._share(pbr, "roughnessFactor", place),
            reflectance=self._reflectance(data, place),
            emission=self._emission(data, place),
            alpha=alpha,
            cutoff=cutoff,
            normal_scale=gltf.number(normal, "scale", place, 1.0),
            occlusion_strength=self._share(occlusion, "strength", place),
            base_map=base_map,
            rough_metal_map=self._map(pbr, "metallicRoughnessTexture", place, "numbers"),
            normal_map=self._map(data, "normalTexture", place, "numbers"),
            occlusion_map=self._map(data, "occlusionTexture", place, "numbers"),
            emission_map=self._map(data, "emissiveTexture", place, "colour"),
        )

    def _share(self, holder: Object, key: str, place: str) -> float:
        return float(np.clip(self._gltf.number(holder, key, place, 1.0), 0.0, 1.0))

    def _coverage(self, data: Object, place: str, mode: object, factor: float, base: Map | None) -> tuple[float, float]:
        """Return a material's alpha, and the threshold below which its map's alpha hides the surface; 0 hides
        nothing. Raises SceneFileError if the mode is unknown."""
        if mode == "OPAQUE":
            return 1.0, 0.0
        if mode == "MASK":
            least = self._gltf.number(data, "alphaCutoff", place, 0.5)
            # A picture's alpha x factor < least; at a factor of 0 nothing is left.
            return 1.0, max(least, 0.0) / factor if factor else 2.0 * (least > 0)
        if mode != "BLEND":
            raise self._gltf.error(f"{place}.alphaMode", f"is {mode!r}, not OPAQUE, MASK or BLEND")
        is_clear = base is not None and bool(np.any(base.texels[..., 3] < np.iinfo(base.texels.dtype).max))
        return (min(factor, BLENDS) if is_clear else factor), 0.0

    def _emission(self, data: Object, place: str) -> tuple[float, float, float]:
        strength = self._gltf.number(self._gltf.extension(data, EMISSION, place), "emissiveStrength", place, 1.0)
        emission = np.array(self._gltf.numbers(data, "emissiveFactor", place, (0.0, 0.0, 0.0)))
        return _triple(np.maximum(emission * strength, 0.0).tolist())

    def _reflectance(self, data: Object, place: str) -> float:
        """Return ((n - 1) / (n + 1))^2 for the refractive index n in KHR_materials_ior, or DIELECTRIC without that
        extension. An index of 0 means full reflection. Raises SceneFileError for other indices below 1."""
        extension = self._gltf.extension(data, IOR, place)
        if not extension:
            return DIELECTRIC
        index = self._gltf.number(extension, "ior", place, 1.5)
        if index != 0 and index < 1:
            raise self._gltf.error(f"{place}.ior", f"is {index}; a refractive index must be 0 or at least 1")
        return ((index - 1) / (index + 1)) ** 2

    # Pictures.

    def _map(self, holder: Object, key: str, place: str, kind: str) -> Map | None:
        """Return a map of `kind`: "colour", "opaque" for a colour without alpha, or "numbers". Return None if the map
        is missing, or if it cannot be used, which is noted."""
        gltf, place = self._gltf, f"{place}.{key}"
        if key not in holder:
            return None
        info = gltf.child(holder, key, place)
        texture = gltf.entry("textures", info.get("index"), place)
        image = self._image(texture)
        moved = gltf.extension(info, TRANSFORM, place)
        uv_set = gltf.whole(moved, "texCoord", place, gltf.whole(info, "texCoord", place, 0))
        if image is None:
            return None
        if uv_set > 1:
            self.notes.append(f"{place} is ignored: it uses TEXCOORD_{uv_set}, and only 0 and 1 are supported")
            return None
        pixels = self._texels(image, place, kind)
        is_srgb = kind != "numbers" and pixels.dtype == np.uint8
        return Map(pixels, is_srgb, self._wrap(texture, place), uv_set, self._placed(moved, place))

    def _image(self, texture: Object) -> object:
        """Return the index of a texture's image; None if the texture has no readable image."""
        extensions = texture.get("extensions")
        extensions = extensions if isinstance(extensions, dict) else {}
        webp = extensions.get(WEBP)
        if isinstance(webp, dict) and "source" in webp:
            return webp["source"]
        if "source" not in texture:
            what = "KTX2 textures are not supported" if KTX2 in extensions else "some textures have no image"
            self.notes.append(f"{what}: plain colours are used")
        return texture.get("source")

    def _wrap(self, texture: Object, place: str) -> tuple[Wrap, Wrap]:
        sampler = self._gltf.entry("samplers", texture["sampler"], place) if "sampler" in texture else {}
        codes = [self._gltf.whole(sampler, key, place, 10497) for key in ("wrapS", "wrapT")]
        for code in codes:
            if code not in WRAPS:
                raise self._gltf.error(
                    f"{place}: its sampler", f"has the wrap mode {code}, not one of {sorted(map(str, WRAPS))}"
                )
        return WRAPS[codes[0]], WRAPS[codes[1]]

    def _placed(self, moved: Object, place: str) -> np.ndarray:
        """Return the matrix of KHR_texture_transform, (2, 3): translation x rotation x scale.

        A positive rotation turns (1, 0) up in the image, towards smaller v: counter-clockwise, according to the
        extension's text. The GLSL in the extension turns the other way; files and programs follow the text (glTF pull
        request 1624).
        """
        numbers = self._gltf.numbers
        (x, y), (along_u, along_v) = (
            numbers(moved, key, place, default) for key, default in (("offset", (0.0, 0.0)), ("scale", (1.0, 1.0)))
        )
        angle = self._gltf.number(moved, "rotation", place, 0.0)
        c, s = np.cos(angle), np.sin(angle)
        return np.array([(along_u * c, along_v * s, x), (-along_u * s, along_v * c, y)])

    def _texels(self, index: object, place: str, kind: str) -> np.ndarray:
        """Return an image's texels, (height, width, 4), converted by `_as_kind`; each image is read only once. Raises
        SceneFileError."""
        gltf = self._gltf
        image = gltf.entry("images", index, place)
        assert isinstance(index, int)
        if index not in self._pictures:
            self._pictures[index] = self._unpacked(image, f"images[{index}]")
        if (index, kind) not in self._made:
            self._made[index, kind] = _as_kind(self._pictures[index], kind)
        return self._made[index, kind]

    def _unpacked(self, image: Object, place: str) -> np.ndarray:
        data = self._data(image, place)
        try:
            width, height = sides(data)
            self._texels_in_all += width * height
            if self._texels_in_all > MAX_TEXELS:
                what = f"has {width} x {height} pixels; the maximum for all images together is {MAX_TEXELS} (2^28)"
                raise self._gltf.error(place, what, "reduce their size")
            return texels(data)
        except PictureError as error:
            name = image.get("uri", image.get("name"))
            shown = f"{place} ({name[:60]!r})" if isinstance(name, str) and not name.startswith("data:") else place
            what, _, remedy = str(error).partition("; ")
            raise self._gltf.error(shown, what, remedy) from error

    def _data(self, image: Object, place: str) -> bytes:
        if "uri" in image:
            return resource(self._gltf.path, image["uri"], place)
        if "bufferView" not in image:
            raise self._gltf.error(place, "has neither a uri nor a bufferView")
        return bytes(self._gltf.view_bytes(image["bufferView"], place))


def _as_kind(image: np.ndarray, kind: str) -> np.ndarray:
    """Return an image's texels for a map of `kind`. "numbers" are unchanged; 16-bit sRGB colours are converted to
    linear, and "opaque" also sets alpha to the largest integer."""
    if kind == "numbers":
        return image
    most = np.iinfo(image.dtype).max
    if image.dtype == np.uint16:
        image = image.copy()
        image[..., :3] = np.round(_linear_of_deep()[image[..., :3]] * most)
    if kind == "opaque" and np.any(image[..., 3] < most):
        image = np.concatenate([image[..., :3], np.full_like(image[..., 3:], most)], axis=2)
    return image


def _linear_of_deep() -> np.ndarray:
    """Return the linear value of each of the 65,536 16-bit sRGB values, float64."""
    from ....encodings.storages.rounding import from_srgb  # JAX, which few files need here

    return np.asarray(from_srgb(np.arange(65536) / 65535), np.float64)


def _triple(values: list[float]) -> tuple[float, float, float]:
    r, g, b = values
    return r, g, b
