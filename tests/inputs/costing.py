"""Made-up GLSL encodings for tests."""

from dataclasses import replace
from pathlib import Path

from normalbench.encodings.catalogue import ENCODINGS


def glsl(tmp_path: Path, name: str, encode: str, decode: str, size: int, before: str = ""):
    """Return an encoding with this GLSL, preceded by its own functions in `before`. Its Python belongs to another
    encoding, because no test runs the Python."""
    path = tmp_path / f"{name}.glsl"
    path.write_text(
        f"{before}vec{size} {name}_encode(vec3 n, vec3 view) {{ return {encode}; }}\n"
        f"vec3 {name}_decode(vec{size} e, vec3 view) {{ return {decode}; }}\n"
    )
    model = ENCODINGS["xy" if size == 2 else "xyz"]
    return replace(model, name=name, glsl=path)
