"""The catalogue of normal encodings. Adding one is its pair of files in `normals/` and one line here."""

from __future__ import annotations

from importlib import import_module

from .encoding import Encoding

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
)

ENCODINGS: dict[str, Encoding] = {name: import_module(f".normals.{name}", __package__).ENCODING for name in NAMES}
