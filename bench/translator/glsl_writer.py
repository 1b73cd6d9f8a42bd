"""GLSL, for OpenGL and Vulkan, and GLSL ES, which wants precisions."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .parser import COMPARISONS
from .tree import Binary, Choice, Table, size_of
from .writer import PRIMARY, Writer, words

NAMES: Mapping[str, str] = MappingProxyType({mark: name for name, mark in COMPARISONS.items()})


class GlslWriter(Writer):
    """GLSL 4.3 and later."""

    functions: Mapping[str, str] = MappingProxyType({"atan2": "atan"})

    def _binary(self, value: Binary) -> tuple[str, int]:
        if value.kind.startswith("bvec") and value.operator in NAMES:
            return f"{NAMES[value.operator]}({self._text(value.left)}, {self._text(value.right)})", PRIMARY
        return super()._binary(value)

    def _choice(self, value: Choice) -> tuple[str, int]:
        if size_of(value.condition.kind) == 1:
            return super()._choice(value)
        return f"mix({', '.join(map(self._text, (value.other, value.chosen, value.condition)))})", PRIMARY

    reserved = words("half input output sample filter common partition active superp")


class EsslWriter(GlslWriter):
    """GLSL ES 3.1 and later."""

    head = "precision highp float;\nprecision highp int;"

    def _table(self, table: Table) -> str:
        return f"uniform highp sampler2D {table.name};"
