"""Codecs of every kind, by the names of encodings, users' files and storages on the command line."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from types import MappingProxyType
from typing import Any

from .....encodings.catalogue import BY_KIND, DEPTH_ENCODINGS
from .....encodings.codecs.curve_codec import CurveCodec, CurveEncoding
from .....encodings.codecs.depth_codec import DepthCodec, DepthEncoding
from .....encodings.codecs.frame_codec import FrameCodec
from .....encodings.codecs.light_codec import LightCodec
from .....encodings.codecs.motion_codec import MotionCodec
from .....encodings.kinds import CURVE, DEPTH, FRAME, LIGHT, MOTION, NORMAL, AnyEncoding, Kind
from .....encodings.storages.depth_storage import DEPTH_STORAGES, DepthStorage, depth_storage_of
from .....encodings.storages.storage import (
    CURVE_STORAGES,
    FRAME_STORAGES,
    LIGHT_STORAGES,
    MOTION_STORAGES,
    STORAGES,
    Storage,
)
from ....ground.choose import choose, unknown_name
from ....ground.options.words import Given, Names
from ....ground.output.errors import UsageError
from ....ground.spelling import OTHER_WORDS, meant, spelled
from ....ground.user_files import UserFile, file_of, names_an_encoder
from ...names.light_buffers import name_and_range, range_in, ranged_light_buffer
from ...names.storages import storages_named, storages_said
from .named import kind_by_names, own_codes_named
from .named import kind_of as kind_of_file


def depth_storages_named(names: Names) -> list[DepthStorage]:
    """Return depth storages by name, or by bits such as unorm:20. Raises UsageError."""
    storages = storages_said(map(str, names), {*DEPTH_STORAGES, *OTHER_WORDS["depth storage"]})
    by_bits = ((word, storage and depth_storage_of(storage)) for word, storage in storages.items())
    known = {**DEPTH_STORAGES, **{word: storage for word, storage in by_bits if storage}}
    return list(dict.fromkeys(choose("depth storage", storages, known)))


def curve_codec(encoding: CurveEncoding, storage: Storage, rounding: str) -> CurveCodec:
    """Return a codec for a curve encoding over its usual range."""
    return CurveCodec(encoding, storage, encoding.usual_range, rounding)


# By kind, the storages of its codes by their names, and what a codec is made of: encoding, storage and rounding.
MADE: Mapping[Kind, tuple[Callable[[Names], list[Any]], Callable[[Any, Any, str], Any]]] = MappingProxyType(
    {
        MOTION: (partial(storages_named, known=MOTION_STORAGES, what="motion storage"), MotionCodec),
        CURVE: (
            partial(storages_named, known=CURVE_STORAGES, what="curve storage"),
            curve_codec,
        ),
        LIGHT: (
            partial(storages_named, known=LIGHT_STORAGES, what="light storage"),
            lambda encoding, storage, _: LightCodec(encoding, storage),
        ),
        DEPTH: (depth_storages_named, DepthCodec),
        FRAME: (partial(storages_named, known=FRAME_STORAGES, what="frame storage"), FrameCodec),
    }
)
NAMED: Mapping[str, Kind] = MappingProxyType({kind.word: kind for kind in (NORMAL, *MADE)})


def kinds_named(names: Names, of: str) -> dict[Kind, Names]:
    """Return names grouped by kind: all in the kind `of` if it is given, otherwise each name in its own kind; normals
    if in doubt.

    Raises:
        UsageError: the kind is unknown, or a name belongs to several kinds.
    """
    if of:
        (kind,) = choose("kind", (of,), NAMED)
        return {kind: names}
    shared = {kind for kind in NAMED.values() if all(_has(kind, str(word)) for word in names)}
    if len(shared) == 1:
        return dict.fromkeys(shared, names)
    by_kind: dict[Kind, Names] = {}
    for word in names:
        kind = NORMAL if isinstance(word, Given) else _kind_of_word(word)
        by_kind[kind] = (*by_kind.get(kind, ()), word)
    return by_kind


def _has(kind: Kind, word: str) -> bool:
    """Whether the catalogue has an encoding of this kind and name; a range in the name is ignored."""
    return spelled(f"{kind.name} encoding", name_and_range(word)[0], BY_KIND[kind]) is not None


def _kind_of_word(word: str) -> Kind:
    """Return the kind of one name or file; normals for an unknown name. Raises UsageError if several kinds other than
    normals have the name, or if it is a misspelling of another kind's name."""
    if names_an_encoder(word):
        return _kind_of_file(UserFile(str(file_of(word))))
    kinds = [kind for kind in NAMED.values() if _has(kind, word)]
    if len(kinds) > 1 and NORMAL not in kinds:
        several = ", ".join(kind.word for kind in kinds)
        raise UsageError(f"{word}: encodings of {several} have this name; choose one with --of {kinds[0].word}")
    others = list(dict.fromkeys(name for kind in MADE for name in BY_KIND[kind]))
    if not kinds and meant(word, others) and not meant(word, BY_KIND[NORMAL]):
        raise unknown_name("encoding", [word], others)
    return kinds[0] if kinds else NORMAL


def _kind_of_file(file: UserFile) -> Kind:
    """Return the kind of a user's file: from its function names, otherwise normals if they fit, otherwise a kind that
    fits."""
    from ..encoding_names import encodings_named

    if (spoken := kind_by_names(file)) and spoken in MADE:
        return spoken
    try:
        encodings_named((file.word,))
    except UsageError as error:
        own = kind_of_file(file, str(error))
        return own.kind if own and own.kind in MADE else NORMAL
    return NORMAL


def codecs_of_kind(
    kind: Kind, names: Names, storages: Names | None, roundings: Sequence[str], usual: slice = slice(None)
) -> list[Any]:
    """Return codecs of a kind other than normals: each encoding in each storage, with each rounding mode.

    Args:
        names: names of encodings or users' files; for light and curves optionally with a range, such as rgbm:8.
        usual: which of an encoding's usual storages to use if no storage is named.

    Raises:
        UsageError: a name is unknown, or a range is invalid.
    """
    ranged = [word for word in names if isinstance(word, str) and ":" in word and not names_an_encoder(word)]
    plain = tuple(word for word in names if word not in ranged)
    encodings: list[AnyEncoding] = own_codes_named(kind, plain, BY_KIND[kind]) if plain or not ranged else []
    chosen = [(encoding, None) for encoding in encodings] + [_with_range(kind, word) for word in ranged]
    storages_of, codec_of = MADE[kind]
    over_bytes = [encoding for encoding, _ in chosen if isinstance(encoding, DepthEncoding) and encoding.bytes]
    if over_bytes and storages:
        raise UsageError(f"{over_bytes[0].name}: it packs its own bytes; leave out --storage")
    codecs = (
        codec if largest is None else replace(codec, range=largest)
        for encoding, largest in chosen
        if encoding not in over_bytes
        for storage in storages_of(storages or encoding.storages[usual])  # pyright: ignore[reportAttributeAccessIssue]
        for rounding in roundings
        for codec in [codec_of(encoding, storage, rounding)]
    )
    in_bytes = (codec for encoding in over_bytes for rounding in roundings for codec in _in_bytes(encoding, rounding))
    return list(dict.fromkeys([*codecs, *in_bytes]))


def _in_bytes(code: DepthEncoding, rounding: str) -> Iterator[DepthCodec]:
    """Return codecs for a user's encoding over bytes, one per depth that it may receive: linear, window and reversed
    window."""
    form = STORAGES["rg8" if code.bytes == 2 else "rgba8"]
    storage = DepthStorage(code.name, f"{code.bytes} bytes of {code.title}", form, "bytes", 8 * code.bytes, code)
    return (DepthCodec(DEPTH_ENCODINGS[name], storage, rounding) for name in ("linear", "window", "reversed_window"))


def _with_range(kind: Kind, word: str) -> tuple[Any, float | None]:
    """Return the encoding for a name with a range, such as `rgbm:8`, and the range. For light the range is None,
    because the encoding already includes it. Raises UsageError for kinds without ranges."""
    name, text = name_and_range(word)
    if kind is LIGHT:
        return ranged_light_buffer(word).encoding, None
    if kind is not CURVE:
        raise UsageError(f"{word}: only light and curves take a range after the name; write {name}")
    (encoding,) = choose("curve encoding", (name,), BY_KIND[CURVE])
    return encoding, range_in(word, text)
