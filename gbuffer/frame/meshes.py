"""The scene's meshes under one program."""

from __future__ import annotations

from ..gl.handles import Program
from .frame import Frame


class Geometry:
    """The scene's meshes under one program."""

    def __init__(self, frame: Frame, program: Program):
        self._frame, self.program = frame, program
        # The compiler drops what nobody reads; its bytes are skipped.
        attributes = {"in_position": 3, "in_normal": 3, "in_tangent": 4, "in_uv": 2, "in_second_uv": 2}
        form = " ".join(f"{n}f" if name in program else f"{4 * n}x" for name, n in attributes.items())
        read = [name for name in attributes if name in program]
        self._arrays = [
            frame.array(program, [(vertices, form, *read)], triangles)
            for vertices, triangles in frame.scene_buffers.meshes
        ]

    def draw(self, name: str | int, cull: str = "back") -> None:
        """Draw a list of `SceneBuffers.draws`, by its name or by a light's index.

        Args:
            cull: the faces to cull, "back" or "front"; two-sided meshes are drawn without culling."""
        buffers, device = self._frame.scene_buffers, self._frame.device
        device.context.cull_face = cull
        for draw in buffers.draws[name]:
            device.cull(not buffers.two_sided[draw.mesh])
            self.program["first"] = draw.first
            buffers.bind_maps(self.program, draw.material)
            self._arrays[draw.mesh].render(instances=draw.count)
