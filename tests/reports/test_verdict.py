"""The page's statement about the agreement of the backends."""

import math

from normalbench.reports.page.verdict import agreement


def row(encoding: str, psnr_db: float | None, **more) -> dict:
    about = {"encoding": encoding, "storage": "rg8", "rounding": "nearest", "normals": "scene", "backend": "jax"}
    return about | {"bits": 16, "psnr_db": psnr_db} | more


def test_the_largest_difference_between_two_backends_is_stated():
    rows = [row("whole", 50.0), row("other", 49.0), row("exact", math.inf), row("lost", None)]
    others = [r | {"backend": "glsl"} for r in rows]
    others[0]["psnr_db"], others[1]["psnr_db"] = 50.01, 48.7
    assert agreement([*rows, *others]) == "JAX and GLSL agree within 0.3 dB."
    assert agreement([*rows, *(r | {"backend": "glsl"} for r in rows)]) == "JAX and GLSL agree within 0.001 dB."


def test_a_single_backend_has_no_statement():
    assert agreement([]) == agreement([row("whole", 50.0)]) == ""
    assert agreement([row("whole", 50.0), row("whole", 45.0, normals="sphere", backend="glsl")]) == ""
