"""The layout of a G-buffer: its targets, their formats and the assignment of attributes to their bits.

Native depth and stencil, D32F S8, belong to every layout; a layout without a `depth` word reads the native depth,
resolved to linear. `words.py` explains the words.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from ...encodings.catalogue import DEPTH_ENCODINGS, ENCODINGS, LIGHT_BUFFERS
from ...encodings.codecs.codec import Codec
from ...encodings.codecs.depth_codec import DepthCodec, DepthEncoding
from ...encodings.codecs.encoding import Encoding
from ...encodings.codecs.files import called, file_toml
from ...encodings.codecs.variants import MARK, settings_in, variant
from ...encodings.storages.storage import BITS_32, DITHERED, ROUNDINGS_AND_DITHERED, TARGET_FORMATS, Storage
from .kept import COLOURS, F0_COLOUR, LIGHT, MOTION, Kept, channels_of, quantity_of
from .words import (
    FREE,
    LEAST_BITS,
    PACKINGS,
    SIGNED,
    LayoutError,
    Target,
    Word,
    place_of,
    placed,
    targets_of,
    without_normal,
)

SPACES = VIEW, WORLD = ("view", "world")
# What layouts keep of a metal/rough surface's reflection.
METALNESS_REFLECTANCE = "base colour, metallic, F0"
METALNESS = "base colour, metallic"
DIFFUSE_F0 = "diffuse colour, F0"


def engines_space(encoding: Encoding) -> str:
    """Return the space in which engines store normals of an encoding: world if it covers the sphere, else view."""
    return WORLD if encoding.domain == "sphere" else VIEW


@dataclass(frozen=True)
class Layout:
    """The render targets of a G-buffer.

    Attributes:
        name, title, source: its name, its description and its source.
        targets: the targets in the order of their attachment.
        encoding: the encoding of the normal. In world space, an encoding of a hemisphere other than z >= 0 keeps its
            author's axes: its y is the world's y.
        space: "view" or "world", the space of the normal.
        rounding: how the normal's own format rounds, one of ROUNDINGS; or DITHERED, which adds noise of one step, the
            same in every frame, to the numbers of its code before rounding.
        packing: how words with bit counts round, a key of PACKINGS.
        depth: the encoding of the depth; None for the first in the catalogue that suits the normal.
        engine, year: the engine or SDK, and the year in which its source was written or read; empty and 0 for a
            layout that does not belong to an engine.
        is_whole: whether the targets store everything that the engine keeps of an opaque material, not only its
            normal.
        light: the engine's light buffer, a key of LIGHT_BUFFERS; empty if unknown. Emission is added there if no
            target stores it.
        decals: how the engine draws decals on it, in one sentence; empty if unknown.

    Raises:
        LayoutError: a name is unknown, or the parts do not fit together.
    """

    name: str
    title: str
    targets: tuple[Target, ...]
    encoding: Encoding
    source: str
    space: str = "view"
    rounding: str = "nearest"
    packing: str = "nearest"
    depth: DepthEncoding | None = None
    engine: str = ""
    year: int = 0
    is_whole: bool = False
    light: str = ""
    decals: str = ""

    def __post_init__(self):
        self._check_names()
        if self.space == "world" and self.encoding.own:
            object.__setattr__(self, "encoding", self.encoding.own)
        components = [word.component for word in self.words]
        for component in components:
            if components.count(component) > 1:
                raise LayoutError(f"layout {self.name}: {component} is stored twice")
        self._check_normal_words(components)
        if self.rounding == DITHERED and (why := self._undithered):
            raise LayoutError(f"layout {self.name}: its normal cannot be dithered: {why}")
        self._check_colours()
        if self.depth_encoding.signed != self.has_signed_depth:
            known = ", ".join(depth.name for depth in self._suitable_depths)
            message = f"{self.depth_encoding.name} cannot be used with {self.encoding.name}; use {known}"
            raise LayoutError(f"layout {self.name}: {message}")

    @property
    def _undithered(self) -> str | None:
        """Reason why noise cannot be added to the normal's code; None if it can."""
        if any(word.bits for word in self.words if word.component.startswith("normal.")):
            return "dithering needs one channel per component"
        return self.codec.undithered

    def _check_normal_words(self, components: Collection[str]) -> None:
        """Raise LayoutError unless the normal's words are the words that its encoding needs."""
        encoding, name, carried = self.encoding, self.encoding.name, self.carried
        normal = {f"normal.{axis}" for axis in "xyz"[: encoding.components]}
        kept = {c for c in components if c.startswith("normal.")} | ({carried} if carried else set())
        if kept != normal or carried in components:
            raise LayoutError(f"layout {self.name}: {name} needs exactly {', '.join(sorted(normal))}")
        if carried and encoding.levels_of("xyz".index(carried[-1])) != 2:
            raise LayoutError(f"layout {self.name}: {carried} of {name} is not a sign, so no quantity can store it")
        if encoding.sign_bits and "depth" not in components:
            raise LayoutError(f"layout {self.name}: {name} needs the depth's sign, but the layout has no depth")

    def _check_colours(self) -> None:
        """Raise LayoutError if the channels of a colour, or of motion, are not stored in the same way."""
        for colour in (*COLOURS, MOTION):
            words = [word for word in self.words if quantity_of(word.component) == colour]
            if len({word.kept for word in words}) > 1:
                raise LayoutError(f"layout {self.name}: all channels of {colour} must use the same curve")
            if colour == MOTION:
                if len(words) == 1 and words[0].kept:
                    raise LayoutError(f"layout {self.name}: an encoding of motion has two components")
                continue
            is_whole = bool(words and words[0].kept and words[0].kept.is_whole)
            if is_whole != any(word.component == f"{colour}.a" for word in words) or (is_whole and len(words) < 4):
                raise LayoutError(
                    f"layout {self.name}: an encoding of light has four components; write for example rgb9e5({LIGHT})"
                )

    @property
    def kept(self) -> dict[str, Kept]:
        """Curves and encodings of the layout's words, by component; words that are stored unchanged are left out."""
        return {word.component: word.kept for word in self.words if word.kept}

    @property
    def carrier(self) -> Word | None:
        """The word whose sign stores a number of the normal's code; None if no word does."""
        return next((word for word in self.words if word.sign), None)

    @property
    def carried(self) -> str:
        """The number that the sign of `carrier` stores, such as `normal.z`; empty without a carrier."""
        return self.carrier.sign if self.carrier else ""

    @property
    def has_signed_depth(self) -> bool:
        """Whether the depth is signed, to store a sign bit of the encoding or a number of the normal's code."""
        return self.encoding.sign_bits > 0 or (self.carrier is not None and self.carrier.component == "depth")

    @property
    def _suitable_depths(self) -> list[DepthEncoding]:
        """Depth encodings that suit the normal: with a sign if the depth must store one, otherwise without."""
        return [depth for depth in DEPTH_ENCODINGS.values() if depth.signed == self.has_signed_depth]

    @property
    def depth_encoding(self) -> DepthEncoding:
        """The layout's encoding of depth: `depth`, or the first in the catalogue that suits the normal."""
        return self.depth or self._suitable_depths[0]

    def _check_names(self) -> None:
        for field, names in (("space", SPACES), ("rounding", ROUNDINGS_AND_DITHERED), ("packing", PACKINGS)):
            _check_known(self.name, field, getattr(self, field), names)
        if self.light:
            _check_known(self.name, "light", self.light, LIGHT_BUFFERS)
        for target in self.targets:
            _check_known(self.name, "format", target.format, TARGET_FORMATS)

    @cached_property
    def words(self) -> tuple[Word, ...]:
        """One `Word`, with its position, for each component that is stored, in the order of the targets; free bits
        and `other` are left out. Raises LayoutError if a word does not fit."""
        words = [word for index, target in enumerate(self.targets) for word in placed(self.name, index, target)]
        if len([word for word in words if word.sign]) > 1:
            raise LayoutError(f"layout {self.name}: a layout can have only one quantity with a sign")
        for word in words:
            self._check_word(word)
        return tuple(words)

    def _check_word(self, word: Word) -> None:
        """Raise LayoutError if a word cannot store its component."""
        target, component = self.targets[word.target], word.component
        place, storage = place_of(self.name, word.target, target), target.storage
        bits = word.bits_in(storage)
        is_signed = bool(word.sign) or (component == "depth" and self.encoding.sign_bits > 0)
        least = LEAST_BITS.get(component, 2 if is_signed else 1)
        if bits < least:
            raise LayoutError(f"{place}: {component} needs {least} bits, not {bits}")
        if storage.kind == "float" and bits < 16 and is_signed and component == "depth":
            raise LayoutError(f"{place}: {storage.title} cannot store the sign that {component} needs")
        if component.startswith("normal."):
            self._check_normal(place, component, storage, bits)

    def _check_normal(self, place: str, component: str, storage: Storage, bits: int) -> None:
        """Raise LayoutError if a number of the normal's code is not stored as its encoding requires."""
        encoding = self.encoding
        if encoding.is_packed and storage != BITS_32:
            raise LayoutError(f"{place}: {encoding.name} packs 32 bits itself and needs the format {BITS_32.name}")
        if encoding.is_precise and (storage.kind == "float" or self.rounding != "nearest" or self.packing != "nearest"):
            raise LayoutError(f"{place}: {encoding.name} supports only precise rounding, in fixed point")
        levels = encoding.levels_of("xyz".index(component[-1]))
        room = storage.levels(0) if storage.kind == "float" else 2**bits - (storage.kind == "snorm")
        if levels > room:
            raise LayoutError(f"{place}: {component} has {levels} values, more than {bits} bits can distinguish")

    @property
    def summary(self) -> str:
        """Everything that defines the layout, in one line."""
        targets = "; ".join(f"{target.format}: {target.holds}" for target in self.targets)
        depth = f", {self.depth.name} depth" if self.depth else ""
        return f"{targets}; {self.encoding.name}, {self.space} space, {self.rounding}, packed {self.packing}{depth}"

    @property
    def components(self) -> frozenset[str]:
        """Names of the components that the layout stores; `power` is included if `roughness` is stored."""
        components = frozenset(word.component for word in self.words)
        return components | {"power"} if "roughness" in components else components

    @property
    def metal_rough_components(self) -> frozenset[str]:
        """`components`, with `f0.r`, `f0.g` and `f0.b` if `metallic` is stored: the base colour is then the
        reflectance too."""
        return self.components | ({*channels_of(F0_COLOUR)} if "metallic" in self.components else set())

    @property
    def codec(self) -> Codec:
        """The normal's encoding, its format and the rounding."""
        home = next(word.target for word in self.words if word.component == "normal.x")
        return Codec(self.encoding, self.targets[home].storage, self.rounding)

    @property
    def normal_storage(self) -> str:
        """Name of the normal's format, followed by the bit counts of packed numbers: "rgba8 12:12"."""
        packed = [str(word.bits) for word in self.words if "normal" in word.component and word.bits]
        return " ".join(filter(None, (self.codec.storage.name, ":".join(packed))))

    @property
    def normal_bits(self) -> int:
        """Number of bits that store the normal, including one for each sign that the depth or another word stores."""
        taken = (w.bits or self.targets[w.target].storage.bits[w.first] for w in self.words if "normal" in w.component)
        return sum(taken) + self.encoding.sign_bits + bool(self.carrier)

    @property
    def normal_scales(self) -> tuple[float, ...]:
        """Scale of each of the first three numbers of the normal's code: the integer that represents 1, as a float;
        1.0 for a number that is not stored."""
        normal_words = {w.component: w for w in self.words if "normal" in w.component}
        words = [normal_words.get(f"normal.{axis}") for axis in "xyz"]
        return tuple(float(self._scale(word)) if word else 1.0 for word in words)

    def _scale(self, word: Word) -> int:
        return 2**word.bits - 1 if word.bits else self.targets[word.target].storage.scale(word.first)

    @property
    def bytes_per_pixel(self) -> int:
        """Bytes per pixel of the targets, without native depth and stencil, at one sample."""
        return sum(sum(target.storage.bits) for target in self.targets) // 8

    @property
    def bytes_with_light(self) -> int | None:
        """Bytes per pixel of the targets plus the engine's light buffer, at one sample; None if it is unknown."""
        return self.bytes_per_pixel + LIGHT_BUFFERS[self.light].bytes_per_pixel if self.light else None

    @property
    def reflects_by(self) -> str:
        """The attributes that define a surface's reflectance: the contract between materials and light. Layouts with
        different contracts cannot be compared byte by byte. Empty if the layout is not whole, or stores neither
        `metallic` nor `f0.r`."""
        if not self.is_whole:
            return ""
        if "metallic" in self.components:
            return METALNESS_REFLECTANCE if "f0" in self.components else METALNESS
        return DIFFUSE_F0 if "f0.r" in self.components else ""

    def with_codec(self, codec: Codec) -> Layout:
        """Return the layout with its normal in a separate target, encoded and stored as `codec` does.

        Raises:
            LayoutError: the codec stores a sign in a depth that the layout does not store, truncates signed words, or
                uses a storage that is only for measurements.
        """
        storage, components = codec.storage, "xyz"[: codec.encoding.components]
        if storage.only_measured:
            raise LayoutError(f"layout {self.name}: {storage.title}: a layout cannot store {storage.only_measured}")
        if storage.is_packed and codec.is_dithered:
            raise LayoutError(f"layout {self.name}: {storage.title}: fields across channels cannot be dithered")
        is_signed = storage.is_packed and storage.kind == "snorm"
        if is_signed and codec.rounding != "nearest":
            raise LayoutError(f"layout {self.name}: {storage.title}: signed fields must be rounded to nearest")
        kept = [replace(t, holds=" ".join(without_normal(t.holds))) for t in self.targets]
        kept = [target for target in kept if any(not word.startswith(FREE) for word in target.holds.split())]
        sizes = [f":{bits}" if storage.is_packed else "" for bits in storage.bits]
        home = Target(
            storage.target.name, " ".join(f"normal.{a}{size}" for a, size in zip(components, sizes, strict=False))
        )
        rounding = {"packing" if storage.is_packed else "rounding": SIGNED if is_signed else codec.rounding}
        return replace(self, targets=(*kept, home), encoding=codec.encoding, **rounding)

    def with_depth(self, codec: DepthCodec) -> Layout:
        """Return the layout with its depth in a separate target, encoded and stored as `codec` does.

        A shader writes the number that a depth buffer would store: an integer across 8-bit channels, or a float in
        one channel.

        Raises:
            LayoutError: the depth encoding does not suit the normal's encoding, or does not fit its storage.
        """
        if codec.misfit:
            raise LayoutError(f"layout {self.name}: {codec.name}: {codec.misfit}")
        kept = [replace(t, holds=" ".join(_words_without_depth(t.holds))) for t in self.targets]
        kept = [target for target in kept if any(not word.startswith(FREE) for word in target.holds.split())]
        channel = {16: "r16f", 32: "r32f"}[codec.bits] if codec.storage.format.kind == "float" else ""
        home = Target(channel, "depth") if channel else Target("rgba8", f"depth:{codec.bits}")
        return replace(self, targets=(*kept, home), depth=codec.encoding)


def engine_layout(
    engine: str, year: int, name: str, title: str, encoding: Encoding, targets: str, source: str, **how: Any
) -> Layout:
    """Return an engine's layout, in world space by default; `targets` is text for `targets_of`."""
    how = {"space": WORLD, "engine": engine, "year": year, **how}
    return Layout(name, title, targets_of(targets), encoding, source, **how)


def _check_known(layout_name: str, field: str, name: str, known: Collection[str]) -> None:
    """Raise LayoutError if a name is unknown."""
    if name not in known:
        raise LayoutError(f"layout {layout_name}: unknown {field} {name!r}; known: {', '.join(known)}")


def _words_without_depth(holds: str) -> list[str]:
    return [FREE + word.removeprefix("depth") if word.startswith("depth") else word for word in holds.split()]


def catalogue_encoding(word: str) -> Encoding:
    """Return the catalogue encoding that a word names, with its settings if any, as in `octahedral:axis=y`. Raises
    LayoutError."""
    name = word.partition(MARK)[0]
    if name not in ENCODINGS:
        raise LayoutError(f"unknown encoding {name!r}; known: {', '.join(ENCODINGS)}")
    try:
        return variant(ENCODINGS[name], settings_in(word)[1]) if MARK in word else ENCODINGS[name]
    except ValueError as error:
        raise LayoutError(f"encoding {word}: {error}") from error


def read_layout(path: Path, encoding_named: Callable[[str], Encoding] = catalogue_encoding) -> Layout:
    """Return the layout in a TOML file. The file has `encoding`, and `[[targets]]` with `format` and `holds`;
    optional are `title`, `source`, `space`, `rounding`, `packing`, `depth` and `light`.

    Args:
        path: the TOML file.
        encoding_named: function that returns the encoding of the name in the file.

    Raises:
        LayoutError: the file cannot be read or is not a layout; the message is one line. Also raises what
            `encoding_named` raises.
    """
    try:
        data = file_toml(path)
    except (OSError, ValueError) as error:
        raise LayoutError(f"{path}: {error}") from error
    try:
        return _layout_from_data(path, data, encoding_named)
    except LayoutError as error:
        raise LayoutError(str(error) if str(path) in str(error) else f"{path}: {error}") from error


def _layout_from_data(path: Path, data: dict[str, Any], encoding_named: Callable[[str], Encoding]) -> Layout:
    texts = {
        "title": called(path.stem),
        "source": called(str(path)),
        "space": "view",
        "rounding": "nearest",
        "packing": "nearest",
        "depth": "",
        "light": "",
    }
    unknown = set(data) - {*texts, "encoding", "targets"}
    if unknown:
        known = ", ".join((*texts, "encoding", "targets"))
        raise LayoutError(f"{path}: unknown key {sorted(unknown)[0]!r}; known: {known}")
    texts |= {key: data.get(key, texts.get(key)) for key in (*texts, "encoding")}
    targets = data.get("targets")
    if not all(isinstance(text, str) for text in texts.values()):
        raise LayoutError(f"{path}: {', '.join(texts)} must be strings, and encoding must be given")
    if not isinstance(targets, list) or not targets or not all(_is_target(target) for target in targets):
        raise LayoutError(f"{path}: targets must be a list of tables, each with the keys format and holds")
    named: dict[str, Any] = {"encoding": encoding_named(texts.pop("encoding"))}
    depth = texts.pop("depth")
    named |= {"depth": _known_value(path, "depth", depth, DEPTH_ENCODINGS)} if depth else {}
    return Layout(called(path.stem), targets=tuple(Target(t["format"], t["holds"]) for t in targets), **texts, **named)


def _known_value(path: Path, field: str, name: str, known: Mapping[str, Any]) -> Any:
    _check_known(path.stem, field, name, known)
    return known[name]


def _is_target(data: object) -> bool:
    return (
        isinstance(data, dict) and set(data) == {"format", "holds"} and all(isinstance(t, str) for t in data.values())
    )
