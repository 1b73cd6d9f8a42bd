"""A context in which a program is linked and drawn once, for what its driver says of it. Imports moderngl alone."""

from __future__ import annotations

from typing import Any

import moderngl

# Of a triangle, which covers the target's one pixel.
CORNERS = 3


class NoContextError(Exception):
    """The driver makes no context, or does not link a program; one line."""


def context() -> Any:
    """A context without a window. Raises NoContextError."""
    options: dict[str, Any] = {"backend": "egl"}
    try:
        return moderngl.create_context(standalone=True, require=330, **options)
    except Exception as error:  # glcontext raises plain ones
        raise NoContextError(_first_line(error)) from error


def renderer(made: Any) -> str:
    """What the driver calls the GPU."""
    return str(made.info["GL_RENDERER"])


def version(made: Any) -> str:
    """GL's version and the driver's."""
    return str(made.info["GL_VERSION"])


def draw(made: Any, vertex: str, fragment: str) -> None:
    """Links the two shaders, as GLSL, and draws a triangle into a float target. Raises NoContextError."""
    try:
        program = made.program(vertex_shader=vertex, fragment_shader=fragment)
    except moderngl.Error as error:
        raise NoContextError(_first_line(error)) from error
    target = made.texture((1, 1), 4, dtype="f4")
    drawn_to = made.framebuffer([target])
    drawn_to.use()
    array = made.vertex_array(program, [])
    array.render(moderngl.TRIANGLES, vertices=CORNERS)
    made.finish()
    for one in (array, drawn_to, target, program):
        one.release()


def _first_line(error: Exception) -> str:
    """What a compiler complains of first; a headline and a line of dashes stand before it."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip(" =-")]
    return next((line for line in lines if "rror" in line and ":" in line), lines[0] if lines else type(error).__name__)
