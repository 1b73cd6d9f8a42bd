"""GLSL, for OpenGL and Vulkan, and GLSL ES, which wants precisions."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .tree import Table
from .writer import Writer, words


class GlslWriter(Writer):
    """GLSL 4.3 and later."""

    functions: Mapping[str, str] = MappingProxyType({"atan2": "atan"})
    reserved = words("half input output sample filter common partition active superp")


class EsslWriter(GlslWriter):
    """GLSL ES 3.1 and later."""

    head = "precision highp float;\nprecision highp int;"

    def _table(self, table: Table) -> str:
        return f"uniform highp sampler2D {table.name};"
