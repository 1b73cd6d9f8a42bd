"""The catalogues of encodings. To add an encoding, add its pair of files to its kind's folder, and one line here.

The catalogues are read-only. Tuned encodings and users' encodings are values of the same types, but are in no
catalogue.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from importlib import import_module
from types import MappingProxyType
from typing import Any

from .codecs.curve_codec import CurveEncoding
from .codecs.depth_codec import DepthEncoding
from .codecs.encoding import Encoding
from .codecs.files import CatalogueError
from .codecs.frame_encoding import FrameEncoding
from .codecs.light_codec import LightCodec
from .codecs.light_encoding import LightEncoding
from .codecs.motion_codec import MotionEncoding
from .kinds import CURVE, DEPTH, FRAME, LIGHT, MOTION, NORMAL, AnyEncoding, Kind
from .storages.storage import LIGHT_STORAGES

PAIRS = (
    "xyz",
    "xyz_renormalised",
    "xyz_largest",
    "xy",
    "xy_sign",
    "spherical",
    "spherical_lut",
    "latitude_longitude",
    "spheremap",
    "spheremap_classic",
    "cryengine3",
    "stereographic",
    "per_pixel_view",
    "view_octahedral",
    "view_equal_area",
    "octahedral",
    "hemi_octahedral",
    "signed_octahedral",
    "equal_area_octahedral",
    "cube",
    "warped_cube",
    "tetrahedral",
    "best_fit",
    "best_fit_searched",
    "spherical_fibonacci",
    "optimised_rings",
)
# Encodings that are there with precise rounding as well: of the codes around, the one that decodes nearest.
PRECISE = {f"{name}_precise": name for name in ("octahedral", "equal_area_octahedral")}
NAMES = (*PAIRS, *PRECISE)
LIGHT_NAMES = ("plain", "linear", "log", "rgbm", "nao32", "rgb9e5", "chroma_half", "hue_saturation")

# A layout keeps the first depth that has the sign its normal needs, or has none, if it names no other.
DEPTH_NAMES = ("linear", "linear_sign", "logarithmic", "window", "reversed_window")

MOTION_NAMES = ("linear", "sqrt", "cube_root", "log")

# Of roughness, metalness, reflectance, occlusion, and the channels of colours and of emission.
CURVE_NAMES = (
    *("linear", "squared", "square_root", "inverted", "gamma_2_2", "srgb", "fast_srgb", "log"),
    *("ray_bits", "reflectivity"),
)

# The last ones are of rotations alone, which have no handedness.
FRAME_NAMES = ("smallest_three", "octahedral_angle", "hexadecachoral", "qtangent", "axis_angle")
FRAME_NAMES += ("rotation_smallest_three", "rotation_vector", "rotation_rodrigues", "rotation_xyz")


def _load(kind: Kind, names: tuple[str, ...]) -> Mapping[str, Any]:
    return MappingProxyType({name: _loaded_encoding(kind, name) for name in names})


def _loaded_encoding(kind: Kind, name: str) -> Any:
    place = f"encodings/{kind.folder}/{name}.py"
    try:
        encoding = import_module(f".{kind.folder}.{name}", __package__).ENCODING
    except Exception as error:  # whatever a user's own file raises
        raise CatalogueError(f"{place}: {type(error).__name__}: {error}") from error
    if getattr(encoding, "kind", None) is not kind:
        raise CatalogueError(f"{place}: ENCODING is not an encoding of {kind.plural}")
    if encoding.name != name:
        raise CatalogueError(f"{place}: ENCODING has the name {encoding.name!r} instead of {name!r}")
    return encoding


def _precise_encoding(name: str, encoding: Encoding) -> Encoding:
    title, citation = f"{encoding.title}, precise", f"{encoding.citation}; rounding: Z. Cigolle et al., JCGT 3(2), 2014"
    return replace(encoding, name=name, title=title, citation=citation, is_precise=True, functions=encoding.prefix)


def _with_precise(pairs: Mapping[str, Encoding]) -> Mapping[str, Encoding]:
    return MappingProxyType({**pairs, **{name: _precise_encoding(name, pairs[pair]) for name, pair in PRECISE.items()}})


ENCODINGS: Mapping[str, Encoding] = _with_precise(_load(NORMAL, PAIRS))
LIGHT_ENCODINGS: Mapping[str, LightEncoding] = _load(LIGHT, LIGHT_NAMES)
DEPTH_ENCODINGS: Mapping[str, DepthEncoding] = _load(DEPTH, DEPTH_NAMES)
FRAME_ENCODINGS: Mapping[str, FrameEncoding] = _load(FRAME, FRAME_NAMES)
MOTION_ENCODINGS: Mapping[str, MotionEncoding] = _load(MOTION, MOTION_NAMES)
CURVE_ENCODINGS: Mapping[str, CurveEncoding] = _load(CURVE, CURVE_NAMES)
BY_KIND: Mapping[Kind, Mapping[str, AnyEncoding]] = MappingProxyType(
    {
        NORMAL: ENCODINGS,
        DEPTH: DEPTH_ENCODINGS,
        FRAME: FRAME_ENCODINGS,
        LIGHT: LIGHT_ENCODINGS,
        MOTION: MOTION_ENCODINGS,
        CURVE: CURVE_ENCODINGS,
    }
)

# What `--light-buffer` names: each light encoding in each storage that it is made for.
LIGHT_BUFFERS: Mapping[str, LightCodec] = MappingProxyType(
    {
        codec.name: codec
        for encoding in LIGHT_ENCODINGS.values()
        for codec in (LightCodec(encoding, LIGHT_STORAGES[storage]) for storage in encoding.storages)
    }
)


def is_in_catalogue(encoding: Encoding) -> bool:
    """Whether an encoding is itself an entry of ENCODINGS, rather than a variant of an entry or a user's encoding."""
    return ENCODINGS.get(encoding.name) is encoding
