"""The catalogue of normal encodings. Adding one is its pair of files in `normals/` and one line here."""

from __future__ import annotations

from importlib import import_module

from .encoding import Encoding
from .errors import CatalogueError

NAMES = (
    "xyz",
    "xyz_renormalised",
    "xy",
    "xy_sign",
    "spherical",
    "spherical_lut",
    "spheremap",
    "spheremap_classic",
    "cryengine3",
    "stereographic",
    "per_pixel_view",
    "octahedral",
    "best_fit",
)


def _load(name: str) -> Encoding:
    try:
        encoding = import_module(f".normals.{name}", __package__).ENCODING
    except Exception as error:  # whatever a user's own file raises
        raise CatalogueError(f"encodings/normals/{name}.py: {type(error).__name__}: {error}") from error
    if encoding.name != name:
        raise CatalogueError(f"encodings/normals/{name}.py: its ENCODING is named {encoding.name!r}, not {name!r}")
    return encoding


ENCODINGS: dict[str, Encoding] = {name: _load(name) for name in NAMES}
