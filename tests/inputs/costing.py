"""Encodings of GLSL that a test makes up."""

from dataclasses import replace
from pathlib import Path

from normalbench.encodings.catalogue import ENCODINGS


def glsl(tmp_path: Path, name: str, encode: str, decode: str, size: int, before: str = ""):
    """An encoding of the GLSL given, after functions of its own; its Python is another's, which nothing here runs."""
    path = tmp_path / f"{name}.glsl"
    path.write_text(
        f"{before}vec{size} {name}_encode(vec3 n, vec3 view) {{ return {encode}; }}\n"
        f"vec3 {name}_decode(vec{size} e, vec3 view) {{ return {decode}; }}\n"
    )
    model = ENCODINGS["xy" if size == 2 else "xyz"]
    return replace(model, name=name, glsl=path)
