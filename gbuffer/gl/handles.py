"""The types of what lives on a device, for whoever holds some: moderngl is imported in this folder alone."""

from moderngl import Buffer, Framebuffer, Program, Query, Texture, Texture3D, VertexArray

__all__ = ["Buffer", "Framebuffer", "Program", "Query", "Texture", "Texture3D", "VertexArray"]
