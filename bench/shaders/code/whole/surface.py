"""Surface attributes that a layout stores, as the fields of a structure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from .....encodings.catalogue import MOTION_ENCODINGS
from .....encodings.codecs.light_encoding import LightEncoding
from .....encodings.storages.storage import DITHERED
from .....gbuffer.layouts.kept import COLOURS, F0, F0_COLOUR, MOTION, Kept, quantity_of
from .....gbuffer.layouts.layout import Layout
from .....gbuffer.layouts.words import COMPONENTS, OTHER, Word, all_placed
from ....ground.output.errors import UsageError
from ...translator.writer import BUILTINS
from ..emit import LANGUAGES

# The types of fields of several numbers.
NUMBERS = {**dict.fromkeys(COLOURS, ("vec3", "rgb")), MOTION: ("vec2", "xy")}
WHOLE_NUMBERS = ("shading_model", "instance")
# What no field is called, so that it has the same name in every language.
WORDS_OF_LANGUAGES = BUILTINS.union(*(language.writer.reserved for language in LANGUAGES.values()))


@dataclass(frozen=True)
class Field:
    """A field of the surface structure.

    Attributes:
        name: its name in the structure.
        kind: its GLSL type.
        components: the layout components that make up the field, in order; empty for the normal.
        words: the words that store these components, a single word for `other`; empty for the normal, whose words
            store its code.
        kept: the curve or the encoding of the stored numbers, or None.
    """

    name: str
    kind: str
    components: tuple[str, ...]
    words: tuple[Word, ...] = ()
    kept: Kept | None = None


@dataclass(frozen=True)
class Contents:
    """The contents of a layout.

    Raises:
        UsageError: no code can be written for part of the layout, such as a normal that is rounded with noise; the
            message is one line.
    """

    layout: Layout

    def __post_init__(self) -> None:
        if why := _unwritten(self.layout):
            raise UsageError(f"layout {self.layout.name}: no code can be written for {why}")

    @cached_property
    def words(self) -> tuple[Word, ...]:
        """All words in target order, including `other` words."""
        name, targets = self.layout.name, self.layout.targets
        return tuple(word for i, target in enumerate(targets) for word in all_placed(name, i, target))

    @cached_property
    def fields(self) -> tuple[Field, ...]:
        """The fields: the normal, then the material's fields, then the `other` fields."""
        return (Field("normal", "vec3", ()), *self._material_fields(), *self._other_fields())

    def _material_fields(self) -> Iterator[Field]:
        by_component = {word.component: word for word in self.words if word.component != OTHER}
        for first in dict.fromkeys(map(quantity_of, COMPONENTS)):
            kind, numbers = NUMBERS.get(first, ("uint" if first in WHOLE_NUMBERS else "float", ""))
            parts = _components(first, numbers)
            if first == "normal" or parts[0] not in by_component:
                continue
            words = tuple(by_component[part] for part in parts)
            yield Field(self._name(first), kind, parts, words, words[0].kept)

    def _name(self, component: str) -> str:
        """Return a component's field name; if the layout has no metallic, `base_color` becomes `diffuse_color`."""
        if component == "base_color" and "metallic" not in self.layout.components:
            return "diffuse_color"
        # Of metal/rough materials a roughness lies where others have a power.
        return {"power": "roughness", F0_COLOUR: F0}.get(component, component)

    def _other_fields(self) -> Iterator[Field]:
        others = [word for word in self.words if word.component == OTHER]
        labels = [word.label for word in others]
        taken = {field.name for field in self._material_fields()} | {"normal", OTHER}
        for number, word in enumerate(others, 1):
            storage = self.layout.targets[word.target].storage
            is_whole = word.bits or (storage.kind == "unorm" and word.first >= storage.curved)
            is_free = word.label and labels.count(word.label) == 1 and word.label not in taken | WORDS_OF_LANGUAGES
            name = word.label if is_free else f"{word.label or OTHER}_{number}"
            yield Field(name, "uint" if is_whole else "float", (name,), (word,))


def _components(quantity: str, numbers: str) -> tuple[str, ...]:
    """Return the components of a quantity, such as motion.x and motion.y; for one number, the quantity."""
    return tuple(f"{quantity.partition('.')[0]}.{number}" for number in numbers) or (quantity,)


def _unwritten(layout: Layout) -> str:
    """Return a description of the part of a layout that cannot be written as code; empty if all of it can."""
    encoding, components = layout.encoding, layout.components - {"power"}
    if layout.has_signed_depth and "depth" not in components:
        return f"the sign of {encoding.name}, which needs a depth in a target"
    if encoding.is_precise or layout.rounding == DITHERED:
        how = "precisely" if encoding.is_precise else "with noise"
        return f"a normal that is rounded {how} ({encoding.name}, {layout.rounding})"
    if {"power", "roughness"} <= {word.component for word in layout.words}:
        return "both a specular power and a roughness"
    for name, (_, numbers) in NUMBERS.items():
        there = [component in components for component in _components(name, numbers)]
        if any(there) and not all(there):
            return f"some components of {name} without the others"
    return _unwritten_other(layout)


def _unwritten_other(layout: Layout) -> str:
    for index, target in enumerate(layout.targets):
        equal = target.storage.field_bits
        for word in all_placed(layout.name, index, target):
            if word.component == OTHER and word.bits and word.first + word.bits > equal:
                return f"other:{word.bits} within {target.format}, whose first {equal} bits hold fields"
    return ""


def code_is_whole(kept: Kept | None) -> bool:
    """Whether a field's numbers form a single code, as for light and motion vectors."""
    return kept is not None and (isinstance(kept.encoding, LightEncoding) or kept.encoding in MOTION_ENCODINGS.values())
