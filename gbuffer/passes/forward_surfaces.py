"""The scene's meshes, lit as they are drawn."""

from ..frame.canvas import Canvas


class ForwardSurfaces:
    """The scene's meshes, lit as they are drawn: with or without the sun, and by a range of lamps.

    Attributes:
        lamps: index of the first lamp, and index after the last lamp.
    """

    def __init__(self, canvas: Canvas, by_sun: bool):
        self._canvas, buffers = canvas, canvas.frame.scene_buffers
        self._surfaces = canvas.geometry("geometry.vert", "forward.frag", LIT_BY_SUN=int(by_sun))
        self.lamps = (buffers.first_lamp, len(buffers.lights))

    def prepare(self, base: float) -> None:
        """Bind the program and its inputs; `base` is the factor on ambient and emitted light, 0 to leave them out."""
        self._canvas.prepare(self._surfaces.program)
        self._surfaces.program["base"] = base

    def draw(self, name: str | int, first: int, last: int) -> None:
        """Draw one of the scene's lists, lit by lamps `first` to `last` - 1."""
        self._surfaces.program["lit_by"] = (first, last)
        self._surfaces.draw(name)
