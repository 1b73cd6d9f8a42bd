"""The types of objects on a device, for use elsewhere: only this folder imports moderngl."""

from moderngl import Buffer, Framebuffer, Program, Query, Texture, Texture3D, VertexArray

__all__ = ["Buffer", "Framebuffer", "Program", "Query", "Texture", "Texture3D", "VertexArray"]
