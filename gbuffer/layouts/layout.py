"""What a layout of a G-buffer is: its targets, their formats, and what lies in which of their bits.

A target is a format and a line of words that fill its bits in order, the most significant first. A word alone
(`albedo.r`) takes one whole channel and is converted as the format converts. A word with a number of bits (`depth:16`)
is an unsigned integer laid across channels of 8 bits. `-` leaves a channel free.

Native depth and stencil, D32F S8, belong to every layout; a layout without a `depth` word reads the native depth,
resolved to linear.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from ...encodings.catalogue import DEPTH_ENCODINGS, ENCODINGS
from ...encodings.codecs.codec import Codec
from ...encodings.codecs.depth_codec import DepthCodec
from ...encodings.codecs.depth_encoding import DepthEncoding
from ...encodings.codecs.encoding import Encoding
from ...encodings.codecs.files import called, file_toml
from ...encodings.storages.storage import FORMATS, ROUNDINGS, Storage

# The order is the G-buffer shaders' (gbuffer.glsl).
COMPONENTS = (
    *("normal.x", "normal.y", "normal.z", "depth", "albedo.r", "albedo.g", "albedo.b"),
    *("specular.r", "specular.g", "specular.b", "power", "kind", "instance", "motion.x", "motion.y"),
)
FREE = "-"
SPACES = ("view", "world")
# How a number x in [0, 1] becomes one of 2^n codes: floor(x (2^n - 1 + widen) + bias).
PACKINGS = {"nearest": (0.0, 0.5), "truncate": (0.0, 0.0), "truncate_half": (0.5, 0.0)}
MAX_PACKED_BITS = 24
# A Deferred ID tells four kinds apart, an instance is 1 to 255.
LEAST_BITS = {"kind": 2, "instance": 8}
DEPTH_STENCIL_BYTES = 5


class LayoutError(Exception):
    """A layout that cannot be: one line that says what clashes."""


@dataclass(frozen=True)
class Word:
    """One component in a target. `first` counts channels if `bits` is 0, and bits otherwise."""

    component: str
    target: int
    first: int
    bits: int


@dataclass(frozen=True)
class Target:
    """A render target: the name of its format, and the words that fill it."""

    format: str
    holds: str

    @property
    def storage(self) -> Storage:
        return FORMATS[self.format]


@dataclass(frozen=True)
class Layout:
    """The render targets of a G-buffer.

    Attributes:
        name, title, source: what it is called, what it is, where it comes from.
        targets: in the order of their attachment.
        encoding: of the normal.
        space: "view" or "world", what the normal's axes are.
        rounding: "nearest" or "truncate", how the normal's own format rounds.
        packing: how words with bits round, a key of PACKINGS.
        depth: the encoding of the depth; None for the first of the catalogue that suits the normal.

    Raises:
        LayoutError: what it names does not exist, does not fit, or clashes.
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

    def __post_init__(self):
        self._check_names()
        found = [word.component for word in self.words]
        for component in found:
            if found.count(component) > 1:
                raise LayoutError(f"layout {self.name}: {component} lies in two places")
        encoding, name = self.encoding, self.encoding.name
        normal = {f"normal.{axis}" for axis in "xyz"[: encoding.components]}
        if {c for c in found if c.startswith("normal.")} != normal:
            raise LayoutError(f"layout {self.name}: {name} needs {', '.join(sorted(normal))}, and no more")
        if encoding.sign_bits and "depth" not in found:
            raise LayoutError(f"layout {self.name}: {name} keeps a sign in the depth's, but the layout keeps no depth")
        if self.depth_encoding.signed != (encoding.sign_bits > 0):
            known = ", ".join(depth.name for depth in self._suitable_depths)
            raise LayoutError(
                f"layout {self.name}: {self.depth_encoding.name} does not suit {name}, whose depth is {known}"
            )

    @property
    def _suitable_depths(self) -> list[DepthEncoding]:
        """Depth encodings that keep a sign if the normal needs one, and only then."""
        return [depth for depth in DEPTH_ENCODINGS.values() if depth.signed == (self.encoding.sign_bits > 0)]

    @property
    def depth_encoding(self) -> DepthEncoding:
        """The encoding of its depth."""
        return self.depth or self._suitable_depths[0]

    def _check_names(self) -> None:
        for field, names in (("space", SPACES), ("rounding", ROUNDINGS), ("packing", PACKINGS)):
            _check_known(self.name, field, getattr(self, field), names)
        for target in self.targets:
            _check_known(self.name, "format", target.format, FORMATS)

    @cached_property
    def words(self) -> tuple[Word, ...]:
        """Where each component lies. Raises LayoutError where one does not fit."""
        return tuple(word for index, target in enumerate(self.targets) for word in self._placed(index, target))

    def _placed(self, index: int, target: Target) -> list[Word]:
        place = f"layout {self.name}, target {index} ({target.format})"
        storage, bit, words = target.storage, 0, []
        for text in target.holds.split():
            match = re.fullmatch(r"([a-z.]+|-)(?::(\d{1,2}))?", text)
            if not match or match[1] not in (*COMPONENTS, FREE):
                raise LayoutError(f"{place}: unknown component {text!r}; known: {', '.join(COMPONENTS)}, {FREE}")
            bits = int(match[2] or 0)
            if match[2] and not bits:
                raise LayoutError(f"{place}: {text}: a word has at least 1 bit; without a number it has a channel")
            if bits and (storage.kind != "unorm" or set(storage.bits) != {8} or bits > MAX_PACKED_BITS):
                raise LayoutError(
                    f"{place}: {text}: up to {MAX_PACKED_BITS} bits may be packed, into channels of 8-bit UNORM"
                )
            channel = len([end for end in _ends(storage) if end <= bit])
            if not bits and bit not in (0, *_ends(storage)):
                raise LayoutError(f"{place}: {text} starts within a channel; give it a number of bits")
            taken = bits or (storage.bits[channel] if channel < storage.channels else 1)
            if bit + taken > sum(storage.bits):
                raise LayoutError(f"{place}: {target.holds!r} takes more than its {sum(storage.bits)} bits")
            if match[1] != FREE:
                self._check_word(place, match[1], storage, taken)
                words.append(Word(match[1], index, bit if bits else channel, bits))
            bit += taken
        return words

    def _check_word(self, place: str, component: str, storage: Storage, bits: int) -> None:
        """Raises LayoutError where a word cannot say what it must."""
        signed_depth = component == "depth" and self.encoding.sign_bits > 0
        least = LEAST_BITS.get(component, 2 if signed_depth else 1)
        if bits < least:
            raise LayoutError(f"{place}: {component} needs {least} bits, not {bits}")
        if storage.kind == "float" and bits < 16 and signed_depth:
            raise LayoutError(f"{place}: {storage.title} has no sign, which {component} needs")
        if component.startswith("normal."):
            self._check_normal(place, component, storage, bits)

    def _check_normal(self, place: str, component: str, storage: Storage, bits: int) -> None:
        """Raises LayoutError where a number of the normal's code is not kept as the encoding needs it."""
        encoding = self.encoding
        if encoding.is_precise and (storage.kind == "float" or self.rounding != "nearest" or self.packing != "nearest"):
            raise LayoutError(f"{place}: {encoding.name} is rounded precisely, in fixed point and not otherwise")
        levels = encoding.levels_of("xyz".index(component[-1]))
        room = storage.levels(0) if storage.kind == "float" else 2**bits - (storage.kind == "snorm")
        if levels > room:
            raise LayoutError(f"{place}: {component} has {levels} values, more than {bits} bits tell apart")

    @property
    def summary(self) -> str:
        """All that makes it what it is, in one line."""
        targets = "; ".join(f"{target.format}: {target.holds}" for target in self.targets)
        depth = f", {self.depth.name} depth" if self.depth else ""
        return f"{targets}; {self.encoding.name}, {self.space} space, {self.rounding}, packed {self.packing}{depth}"

    @property
    def components(self) -> frozenset[str]:
        """What it keeps."""
        return frozenset(word.component for word in self.words)

    @property
    def codec(self) -> Codec:
        """The normal's encoding, the format it lies in, and how that rounds."""
        home = next(word.target for word in self.words if word.component == "normal.x")
        return Codec(self.encoding, self.targets[home].storage, self.rounding)

    @property
    def normal_storage(self) -> str:
        """The format that the normal lies in, and its bits where they are packed into channels of another size."""
        packed = [str(word.bits) for word in self.words if "normal" in word.component and word.bits]
        return " ".join(filter(None, (self.codec.storage.name, ":".join(packed))))

    @property
    def normal_bits(self) -> int:
        """The bits its normal takes, with one for each sign bit."""
        taken = (w.bits or self.targets[w.target].storage.bits[w.first] for w in self.words if "normal" in w.component)
        return sum(taken) + self.encoding.sign_bits

    @property
    def normal_scales(self) -> tuple[float, ...]:
        """The integers that stand for 1 in the first three numbers of the normal's code; 1 where there is none."""
        found = {w.component: w for w in self.words if "normal" in w.component}
        words = [found.get(f"normal.{axis}") for axis in "xyz"]
        return tuple(float(self._scale(word)) if word else 1.0 for word in words)

    def _scale(self, word: Word) -> int:
        return 2**word.bits - 1 if word.bits else self.targets[word.target].storage.scale(word.first)

    @property
    def bytes_per_pixel(self) -> int:
        """Of its targets and of depth and stencil, at one sample."""
        return sum(sum(target.storage.bits) for target in self.targets) // 8 + DEPTH_STENCIL_BYTES

    def with_codec(self, codec: Codec) -> Layout:
        """The layout with its normal in a target of its own, encoded and stored as `codec` does.

        Raises:
            LayoutError: the codec keeps a sign in a depth that the layout does not keep, or lies in signed words.
        """
        storage, components = codec.storage, "xyz"[: codec.encoding.components]
        if storage.is_packed and storage.kind != "unorm":
            raise LayoutError(
                f"layout {self.name}: {storage.title}: words of a layout are unsigned; use another storage"
            )
        kept = [replace(t, holds=" ".join(_without_normal(t.holds))) for t in self.targets]
        kept = [target for target in kept if any(not word.startswith(FREE) for word in target.holds.split())]
        sizes = [f":{bits}" if storage.is_packed else "" for bits in storage.bits]
        home = Target(
            storage.target.name, " ".join(f"normal.{a}{size}" for a, size in zip(components, sizes, strict=False))
        )
        rounding = {"packing" if storage.is_packed else "rounding": codec.rounding}
        return replace(self, targets=(*kept, home), encoding=codec.encoding, **rounding)

    def with_depth(self, codec: DepthCodec) -> Layout:
        """The layout with its depth in a target of its own, encoded and stored as `codec` does.

        A depth buffer's number is stored by a shader: integers across channels of 8 bits, floats in a channel of 32.

        Raises:
            LayoutError: the code does not suit the encoding of the normal, or does not fit its storage.
        """
        if codec.misfit:
            raise LayoutError(f"layout {self.name}: {codec.name}: {codec.misfit}")
        kept = [replace(t, holds=" ".join(FREE if w == "depth" else w for w in t.holds.split())) for t in self.targets]
        kept = [target for target in kept if any(not word.startswith(FREE) for word in target.holds.split())]
        channel = {16: "r16f", 32: "r32f"}[codec.bits] if codec.storage.format.kind == "float" else ""
        home = Target(channel, "depth") if channel else Target("rgba8", f"depth:{codec.bits}")
        return replace(self, targets=(*kept, home), depth=codec.encoding)


def _check_known(layout: str, field: str, name: str, known: Collection[str]) -> None:
    """Raises LayoutError for a name that is not among the known ones."""
    if name not in known:
        raise LayoutError(f"layout {layout}: unknown {field} {name!r}; known: {', '.join(known)}")


def _ends(storage: Storage) -> list[int]:
    """The bit at which each channel ends."""
    return [sum(storage.bits[: channel + 1]) for channel in range(storage.channels)]


def _without_normal(holds: str) -> list[str]:
    """The words of a target, those of the normal left free so that the others keep their channels."""
    words = []
    for text in holds.split():
        if not text.startswith("normal."):
            words.append(text)
        else:
            words.append(FREE + text[len("normal.x") :])
    return words


def read_layout(path: Path) -> Layout:
    """A layout from a TOML file: `title`, `encoding`, `[[targets]]` of `format` and `holds`; `space`, `rounding`,
    `packing` and `depth` where they are not the usual.

    Raises:
        LayoutError: it cannot be read, or is not a layout; one line.
    """
    try:
        data = file_toml(path)
    except (OSError, ValueError) as error:
        raise LayoutError(f"{path}: {error}") from error
    try:
        return _from_data(path, data)
    except LayoutError as error:
        raise LayoutError(str(error) if str(path) in str(error) else f"{path}: {error}") from error


def _from_data(path: Path, data: dict[str, Any]) -> Layout:
    texts = {
        "title": called(path.stem),
        "source": called(str(path)),
        "space": "view",
        "rounding": "nearest",
        "packing": "nearest",
        "depth": "",
    }
    unknown = set(data) - {*texts, "encoding", "targets"}
    if unknown:
        known = ", ".join((*texts, "encoding", "targets"))
        raise LayoutError(f"{path}: unknown key {sorted(unknown)[0]!r}; known: {known}")
    texts |= {key: data.get(key, texts.get(key)) for key in (*texts, "encoding")}
    targets = data.get("targets")
    if not all(isinstance(text, str) for text in texts.values()):
        raise LayoutError(f"{path}: {', '.join(texts)} are texts, and encoding must be given")
    if not isinstance(targets, list) or not targets or not all(_is_target(target) for target in targets):
        raise LayoutError(f"{path}: targets is a list of tables, each with a format and what it holds, as texts")
    named = {"encoding": _named(path, "encoding", texts.pop("encoding"), ENCODINGS)}
    depth = texts.pop("depth")
    named |= {"depth": _named(path, "depth", depth, DEPTH_ENCODINGS)} if depth else {}
    return Layout(called(path.stem), targets=tuple(Target(t["format"], t["holds"]) for t in targets), **texts, **named)


def _named(path: Path, field: str, name: str, known: Mapping[str, Any]) -> Any:
    _check_known(path.stem, field, name, known)
    return known[name]


def _is_target(data: object) -> bool:
    return (
        isinstance(data, dict) and set(data) == {"format", "holds"} and all(isinstance(t, str) for t in data.values())
    )
