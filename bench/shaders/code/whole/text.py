"""GLSL text of a layout's two functions, as lines for the template `gbuffer.glsl.j2`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from .....encodings.codecs.light_encoding import LightEncoding
from .....gbuffer.gl.shader import glsl_value
from .....gbuffer.layouts.layout import Layout
from .....gbuffer.layouts.words import Word
from .bits import packed_texts, parts_of, taken_text
from .numbers import Number
from .surface import Contents, Field, code_is_whole

AXES = "xyzw"
# How many parts of an integer are joined in a line, and the longest text that stands in the line of its target.
JOINED, SHORT = 3, 12


@dataclass(frozen=True)
class TargetText:
    """The GLSL name and type of a target, as a field of the structure."""

    name: str
    kind: str


@dataclass(frozen=True)
class Texts:
    """The lines of a layout's functions."""

    contents: Contents

    @property
    def _layout(self) -> Layout:
        return self.contents.layout

    @property
    def context(self) -> dict[str, Any]:
        """The template's variables."""
        return {
            "fields": self.contents.fields,
            "targets": self.targets,
            "packing": list(self._packing()),
            "unpacking": list(self._unpacking()),
        }

    @property
    def targets(self) -> list[TargetText]:
        """The targets: each a vec4, or as many unsigned integers as the format has channels."""
        kinds = {1: "uint", 2: "uvec2", 4: "uvec4"}
        storages = [target.storage for target in self._layout.targets]
        return [
            TargetText(f"target_{i}", kinds[storage.channels] if storage.is_integer else "vec4")
            for i, storage in enumerate(storages)
        ]

    # A surface to its targets.

    def _packing(self) -> Iterator[str]:
        names = {f"normal.{axis}": f"normal.{axis}" for axis in "xyz"}
        for field in self.contents.fields[1:]:
            yield from self._coded(field, names)
            if field.words[0].component == "depth":
                yield from self._depth_number(field.words[0], names)
            elif Number(self._layout, field.words[0]).is_carrier:
                yield self._carried(field.words[0], names)
        for index, target in enumerate(self.targets):
            yield from self._packed_target(index, target, names)

    def _coded(self, field: Field, names: dict[str, str]) -> Iterator[str]:
        """Yield GLSL lines that apply a field's curve or encoding, if any; add the components' texts to `names`."""
        parts = [f"s.{field.name}"]
        if field.kind.startswith("vec"):
            parts = [f"s.{field.name}.{axis}" for axis in AXES[: len(field.components)]]
        if field.kept is None:
            names |= dict(zip(field.components, parts, strict=True))
        elif code_is_whole(field.kept):
            yield self._whole_code(field)
            components = _components_of(field)
            names |= {name: f"{field.name}.{AXES[i]}" for i, name in enumerate(components)}
        else:
            encoding, limit = field.kept.encoding, glsl_value(field.kept.range)
            for component, part in zip(field.components, parts, strict=True):
                names[component] = _local(component)
                yield f"float {_local(component)} = {encoding.name}_encode_curve({part}, {limit});"

    def _depth_number(self, word: Word, names: dict[str, str]) -> Iterator[str]:
        """Yield GLSL lines that compute a depth's stored number, signed if the layout needs it; add it to `names`."""
        depth, names["depth"] = "s.depth", "depth_number"
        if self._layout.has_signed_depth:
            depth = "signed_depth"
            yield f"float {depth} = {names[self._sign]} * s.depth;"
        yield f"float depth_number = DEPTH_ENCODE(depth_or_far({depth}, far), near, {self._far(word)});"

    def _far(self, word: Word) -> str:
        """Return the GLSL text for the far plane: "1.0" if floats hold depths in the scene's units, else "far"."""
        return "1.0" if self._layout.depth_encoding.own_units and Number(self._layout, word).is_open else "far"

    @property
    def _sign(self) -> str:
        """The component of the normal's code that is stored as a sign, such as normal.z."""
        return self._layout.carried or f"normal.{AXES[self._layout.encoding.components]}"

    def _carried(self, word: Word, names: dict[str, str]) -> str:
        name = f"signed_{_local(word.component)}"
        code = Number(self._layout, word).carried_text(names[word.component], names[self._sign])
        names[word.component] = name
        return f"float {name} = {code};"

    def _whole_code(self, field: Field) -> str:
        assert field.kept
        encoding = field.kept.encoding
        if isinstance(encoding, LightEncoding):
            return f"vec4 {field.name} = {encoding.prefix}_encode(light_or_none(vec4(s.{field.name}, 0.0)));"
        motion = f"{encoding.prefix}_encode_motion(s.{field.name}, {glsl_value(field.kept.range)})"
        return f"vec2 {field.name} = {motion};"

    def _packed_target(self, index: int, target: TargetText, names: dict[str, str]) -> Iterator[str]:
        storage = self._layout.targets[index].storage
        words = [word for word in self.contents.words if word.target == index]
        for word in (word for word in words if word.bits):
            text = names.get(word.component) or f"s.{self._other_name(word)}"
            yield f"uint {self._integer_name(word)} = {Number(self._layout, word).bits_text(text)};"
        channels = []
        for channel in range(storage.channels):
            lines, text = self._channel(words, index, channel, names)
            yield from lines
            channels.append(text)
        if not storage.is_integer:
            channels += ["0.0"] * (4 - len(channels))
        yield f"{target.kind} {target.name} = {_listed(target.kind, channels)};"

    def _channel(self, words: list[Word], index: int, channel: int, names: dict[str, str]) -> tuple[list[str], str]:
        """Return the GLSL lines to place before a target's line, and the text of a channel's value (0 if empty)."""
        name = f"channel_{index}_{AXES[channel]}"
        own = next((word for word in words if not word.bits and word.first == channel), None)
        if own:
            text = names.get(own.component) or f"s.{self._other_name(own)}"
            code = Number(self._layout, own).channel_text(text, self._is_float(own))
            return ([], code) if len(code) <= SHORT or code.isidentifier() else ([f"float {name} = {code};"], name)
        storage = self._layout.targets[index].storage
        size = storage.bits[channel]
        joined = packed_texts([(p, self._integer_name(p.word)) for p in parts_of(words, channel, storage)], size)
        if not joined:
            return [], "0u" if storage.is_integer else "0.0"
        lines = [f"uint {name} = {' | '.join(joined[:JOINED])};"]
        for more in range(JOINED, len(joined), JOINED):
            lines.append(f"{name} |= {' | '.join(joined[more : more + JOINED])};")
        return lines, name if storage.is_integer else f"float({name}) / {float(storage.scale(channel))}"

    # And back.

    def _unpacking(self) -> Iterator[str]:
        names: dict[Word, str] = {}
        for index in range(len(self.targets)):
            yield from self._taken_words(index, names)
        signs: dict[str, str] = {}
        for word in names:
            yield from self._signed_lines(word, names, signs)
        yield from self._normal_lines(names, signs)
        for field in self.contents.fields[1:]:
            yield from self._field_lines(field, names)

    def _signed_lines(self, word: Word, names: dict[Word, str], signs: dict[str, str]) -> Iterator[str]:
        """Yield GLSL lines that compute a number with a stored sign. Replace the text of the number, or of a depth,
        in `names`, and add the text of the sign to `signs`."""
        name, number = f"signed_{_local(word.component)}", names[word]
        if word.component == "depth":
            decoded = f"DEPTH_DECODE({number}, near, {self._far(word)})"
            names[word] = decoded
            if self._layout.has_signed_depth:
                names[word] = f"abs({name})"
                # The sign bit, and not a comparison: a depth of zero has a sign too.
                signs[self._sign] = f"sign_bit({name}) ? -1.0 : 1.0"
                yield f"float {name} = {decoded};"
        elif word.sign:
            names[word], signs[word.sign] = f"abs({name})", f"sign_not_zero({name})"
            yield f"float {name} = {number};"

    def _taken_words(self, index: int, names: dict[Word, str]) -> Iterator[str]:
        """Yield GLSL lines that extract integers from a target; add the text of each word's number to `names`."""
        storage = self._layout.targets[index].storage
        words = [word for word in self.contents.words if word.target == index]
        held = {}
        for channel in range(storage.channels):
            parts = list(parts_of(words, channel, storage))
            text = f"t.target_{index}" + (f".{AXES[channel]}" if storage.channels > 1 or not storage.is_integer else "")
            if parts and not storage.is_integer:
                yield f"uint bits_{index}_{AXES[channel]} = uint({text} * {float(storage.scale(channel))} + 0.5);"
                text = f"bits_{index}_{AXES[channel]}"
            for part in parts:
                held.setdefault(part.word, []).append((part, text))
        for word in words:
            number = Number(self._layout, word)
            if word.bits:
                yield f"uint {self._integer_name(word)} = {taken_text(held[word], word.bits)};"
                names[word] = number.bits_value(self._integer_name(word))
            else:
                names[word] = number.channel_value(f"t.target_{index}.{AXES[word.first]}", self._is_float(word))

    def _normal_lines(self, names: dict[Word, str], signs: dict[str, str]) -> Iterator[str]:
        by_component = {word.component: names[word] for word in names if word.component.startswith("normal.")} | signs
        axes = "xyz"[: self._layout.encoding.components + self._layout.encoding.sign_bits]
        for axis in axes:
            yield f"float code_{axis} = {by_component[f'normal.{axis}']};"
        code = ", ".join(f"code_{axis}" for axis in axes)
        yield f"vec3 normal = DECODE(CODE({code}), view);"

    def _field_lines(self, field: Field, names: dict[Word, str]) -> Iterator[str]:
        if not field.kept and len(field.words) == 1:
            yield f"{field.kind} {field.name} = {names[field.words[0]]};"
            return
        if len(field.words) == 1:
            yield f"float {field.name} = {self._decoded(field, names[field.words[0]])};"
            return
        parts = []
        for word in self._words_of(field):
            parts.append(_local(word.component))
            yield f"float {parts[-1]} = {self._decoded(field, names[word])};"
        yield f"{field.kind} {field.name} = {self._joined(field, parts)};"

    def _decoded(self, field: Field, text: str) -> str:
        """Return GLSL text that undoes the curve of a number; the text unchanged for a code or without a curve."""
        if field.kept is None or code_is_whole(field.kept):
            return text
        return f"{field.kept.encoding.name}_decode_curve({text}, {glsl_value(field.kept.range)})"

    def _joined(self, field: Field, parts: list[str]) -> str:
        listed = ", ".join(parts)
        if not field.kept or not code_is_whole(field.kept):
            return _listed(field.kind, parts)
        encoding = field.kept.encoding
        if isinstance(encoding, LightEncoding):
            return f"{encoding.prefix}_decode(vec4({listed})).xyz"
        return f"{encoding.prefix}_decode_motion(vec2({listed}), {glsl_value(field.kept.range)})"

    # Names.

    def _words_of(self, field: Field) -> list[Word]:
        """Return the words of a field's components; a light code has one more word than the field has numbers."""
        by_component = {word.component: word for word in self.contents.words}
        return [by_component[component] for component in _components_of(field)]

    def _other_name(self, word: Word) -> str:
        return next(field.name for field in self.contents.fields if field.words == (word,))

    def _is_float(self, word: Word) -> bool:
        return any(field.words == (word,) and field.kind == "float" for field in self.contents.fields)

    def _integer_name(self, word: Word) -> str:
        names = (field.name for field in self.contents.fields if field.words == (word,))
        name = next(names, _local(word.component))
        return f"{name}_bits"


def _components_of(field: Field) -> tuple[str, ...]:
    """Return the components that store a field: its own and, for a light code, a fourth, NAME.a."""
    is_light = field.kept is not None and isinstance(field.kept.encoding, LightEncoding)
    return (*field.components, f"{field.name}.a") if is_light else field.components


def _local(component: str) -> str:
    return component.replace(".", "_")


def _listed(kind: str, parts: list[str]) -> str:
    return parts[0] if len(parts) == 1 else f"{kind}({', '.join(parts)})"
