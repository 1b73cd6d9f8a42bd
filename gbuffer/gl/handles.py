"""The types of device objects, for use in other packages: only this one imports moderngl."""

from moderngl import Buffer, Framebuffer, Program, Query, Texture, Texture3D, VertexArray

__all__ = ["Buffer", "Framebuffer", "Program", "Query", "Texture", "Texture3D", "VertexArray"]
