"""The attributes that a proposal for a user's layout must hold, and the targets that it may use."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ....encodings.storages.storage import Storage
from ....gbuffer.layouts.kept import LIGHT
from ....gbuffer.layouts.layout import Layout
from ....gbuffer.layouts.words import FREE, Target, Word, all_placed, place_of, spelt_out
from .attributes import COMPONENTS, EMISSION, FLOAT, SEEN, SRGB, UNORM, Attribute, Code, in_halves
from .bins import BINS, Bin
from .solve import LARGE_BITS, READ_BYTES, Rules

# What --hold calls the model of shading.
MODEL = "shading_model"
# A target of signed numbers may as well be one of as many bits without a sign.
SIGNED = "_snorm"


@dataclass(frozen=True)
class Own:
    """A layout's own attributes, its targets, and the rules for a proposal in its place."""

    attributes: Sequence[Attribute]
    bins: Sequence[Bin]
    rules: Rules


def own(layout: Layout, asked: Rules) -> Own:
    """Return the attributes, targets and rules for a proposal in place of a layout, with as many targets of
    each format as the layout has.

    Args:
        asked: rules of the question. Rules that the layout itself breaks are left out, except a WebGPU limit.
    """
    formats = Counter(_format(target) for target in layout.targets)
    attributes = list(_attributes(layout))
    homes = {name: {word.target for word in layout.words if word.component in COMPONENTS[name]} for name in COMPONENTS}
    together = [names for names in asked.together if names <= homes.keys() and _is_one([homes[n] for n in names])]
    rules = replace(
        asked,
        bytes=layout.bytes_per_pixel,
        targets=len(layout.targets),
        blended=asked.blended & {attribute.name for attribute in attributes},
        together=tuple(together),
        read=asked.read if _reads_little(layout, asked.read) else frozenset(),
        apart=frozenset(),
        formats=formats,
    )
    return Own(attributes, [target_bin for name, count in formats.items() for target_bin in _bins(name, count)], rules)


def _reads_little(layout: Layout, read: frozenset[str]) -> bool:
    """Whether a layout itself lets a pass read these attributes alone: their targets hold no other large attribute
    and total at most READ_BYTES per attribute."""
    mine = {component for name in read for component in COMPONENTS.get(name, ())}
    homes = {word.target for word in layout.words if word.component in mine}
    beside = [word for word in layout.words if word.target in homes and word.component not in mine]
    sizes = [word.bits_in(layout.targets[word.target].storage) for word in beside]
    is_large = any("." in word.component for word in beside) or max(sizes, default=0) >= LARGE_BITS
    return not is_large and sum(layout.targets[index].storage.texel_bytes for index in homes) <= READ_BYTES * len(read)


def _is_one(homes: Sequence[set[int]]) -> bool:
    return len(set().union(*homes)) == 1


def _format(target: Target) -> str:
    return target.format.removesuffix(SIGNED)


def _bins(name: str, count: int) -> Iterator[Bin]:
    """Yield the known bins of a format with `count` copies each; if none is known, a bin with its own channels."""
    known = [replace(target_bin, copies=count) for target_bin in BINS.values() if target_bin.format == name]
    if known:
        yield from known
        return
    storage = Target(name, FREE).storage
    channels = Counter((_kind(storage, channel), bits) for channel, bits in enumerate(storage.bits))
    yield Bin(name, name, storage.texel_bytes, channels, copies=count)


def _kind(storage: Storage, channel: int) -> str:
    if storage.kind == "float":
        return FLOAT
    return SRGB if channel < storage.curved else UNORM


def _attributes(layout: Layout) -> Iterator[Attribute]:
    """Yield the attributes of a layout: attributes that an image shows, with all of their encodings; then the others,
    with the bits and the kind of channel that the layout uses."""
    has_halves = any(t.storage.kind == "float" and max(t.storage.bits) == 16 for t in layout.targets)
    for name, attribute in SEEN.items():
        if layout.components & {*COMPONENTS[name]}:
            more = in_halves(name) if has_halves else ()
            yield replace(attribute, codes=(*attribute.codes, *more))
    placed = [(text, word) for i, target in enumerate(layout.targets) for text, word in _texts(layout, i, target)]
    seen = {component for names in COMPONENTS.values() for component in names}
    others = [(text, word) for text, word in placed if word.component not in seen]
    if any(word.component.startswith(LIGHT) for _, word in others):
        yield EMISSION
    motion = [pair for pair in others if pair[1].component.startswith("motion.")]
    if motion:
        yield _as_it_is("motion", layout, motion)
    rest = [pair for pair in others if not pair[1].component.startswith(("motion.", LIGHT))]
    for number, pair in enumerate(rest):
        component = pair[1].label or pair[1].component
        yield _as_it_is(MODEL if component == "shading_model" else f"{component} {number}", layout, [pair])


def _texts(layout: Layout, index: int, target: Target) -> Iterator[tuple[str, Word]]:
    texts = [t for t in spelt_out(place_of(layout.name, index, target), target) if not t.startswith(FREE)]
    yield from zip(texts, all_placed(layout.name, index, target), strict=True)


def _as_it_is(name: str, layout: Layout, pairs: Sequence[tuple[str, Word]]) -> Attribute:
    """Return an attribute with one encoding, which keeps the bits and the kind of channel of the layout's words."""
    kinds, bits = [], []
    for _, word in pairs:
        storage = layout.targets[word.target].storage
        kinds.append(UNORM if word.bits else _kind(storage, word.first))
        bits.append(word.bits_in(storage))
    # A number that is no colour has no curve of its own: what lies in a channel of sRGB is as good in any other.
    kind = FLOAT if FLOAT in kinds else UNORM
    words = tuple(_without_bits(text) for text, _ in pairs)
    exact = kind == UNORM and not name.startswith("motion")
    code = Code(name, f"{sum(bits)} bits", words, tuple(bits), kind, in_fields=kind == UNORM, is_exact=exact)
    return Attribute(name, (code,), sum(bits), False)


def _without_bits(text: str) -> str:
    curve, bracket, rest = text.rpartition(")")
    return curve + bracket + rest.partition(":")[0] if bracket else text.partition(":")[0]
