"""The numbers of the two structures in order, as rows of 32-bit words for the programs around a file."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ...translator.tree import scalar_of, size_of
from .text import Texts


@dataclass(frozen=True)
class Leaf:
    """A number in a structure: its path, such as `target_0.x`, and whether it is a whole number."""

    path: str
    is_whole: bool


def surface_leaves(texts: Texts) -> list[Leaf]:
    """Return the numbers of a surface, in the order of its structure: the path, and whether it is a whole number."""
    return _leaves((field.name, field.kind) for field in texts.contents.fields)


def target_leaves(texts: Texts) -> list[Leaf]:
    """Return the numbers of the targets, in the order of their structure; unused channels are included."""
    return _leaves((target.name, target.kind) for target in texts.targets)


def _leaves(named: Iterable[tuple[str, str]]) -> list[Leaf]:
    leaves = []
    for name, kind in named:
        paths = [f"{name}.{axis}" for axis in "xyzw"[: size_of(kind)]] if size_of(kind) > 1 else [name]
        leaves += [Leaf(path, scalar_of(kind) == "uint") for path in paths]
    return leaves
