"""Codecs of every kind as they are named on the command line: encodings and files of yours, and storages."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from .....encodings.catalogue import BY_KIND
from .....encodings.codecs.curve_codec import CurveCodec
from .....encodings.codecs.depth_codec import DepthCodec
from .....encodings.codecs.frame_codec import FrameCodec
from .....encodings.codecs.kind import CURVE, DEPTH, FRAME, LIGHT, MOTION, NORMAL, AnyEncoding, Kind
from .....encodings.codecs.light_codec import LightCodec
from .....encodings.codecs.motion_codec import MotionCodec
from .....encodings.storages.depth_storage import DEPTH_STORAGES, depth_storage_of
from .....encodings.storages.storage import CURVE_STORAGES, FRAME_STORAGES, LIGHT_STORAGES, MOTION_STORAGES
from ....ground.choose import choose, unknown_name
from ....ground.options.light_names import name_and_range, range_in, ranged_light_buffer
from ....ground.options.storage_names import storages_named, storages_said
from ....ground.options.words import Words, given_in
from ....ground.output.errors import UsageError
from ....ground.spelling import meant, spelled
from ....shaders.languages.words import file_of, names_an_encoder, split_names
from .named import kind_by_names, own_codes_named
from .named import kind_of as kind_of_file

# Of a kind, the storages by their names, and codecs of an encoding in some of them.
Made = Callable[[Any, str, str], Iterator[Any]]


def _motion(encoding: Any, storages: str, rounding: str) -> Iterator[MotionCodec]:
    return (MotionCodec(encoding, one, rounding) for one in storages_named(storages, MOTION_STORAGES, "motion storage"))


def _curve(encoding: Any, storages: str, rounding: str) -> Iterator[CurveCodec]:
    found = storages_named(storages, CURVE_STORAGES, "curve storage")
    return (CurveCodec(encoding, one, encoding.usual_range, rounding) for one in found)


def _light(encoding: Any, storages: str, _: str) -> Iterator[LightCodec]:
    return (LightCodec(encoding, one) for one in storages_named(storages, LIGHT_STORAGES, "light storage"))


def _depth(encoding: Any, storages: str, _: str) -> Iterator[DepthCodec]:
    said = {word: one and depth_storage_of(one) for word, one in storages_said(storages, DEPTH_STORAGES).items()}
    known = {**DEPTH_STORAGES, **{word: one for word, one in said.items() if one}}
    return (DepthCodec(encoding, one) for one in choose("depth storage", ",".join(said), known))


def _frame(encoding: Any, storages: str, rounding: str) -> Iterator[FrameCodec]:
    return (FrameCodec(encoding, one, rounding) for one in storages_named(storages, FRAME_STORAGES, "frame storage"))


MADE: Mapping[Kind, Made] = MappingProxyType(
    {MOTION: _motion, CURVE: _curve, LIGHT: _light, DEPTH: _depth, FRAME: _frame}
)
NAMED: Mapping[str, Kind] = MappingProxyType({kind.word: kind for kind in (NORMAL, *MADE)})


def kinds_named(names: str, of: str) -> dict[Kind, str]:
    """Comma-separated names by the kind that they are of: the one that is said, or what each name says; of normals in
    doubt.

    Raises:
        UsageError: an unknown kind, or names that several kinds have.
    """
    if of:
        (kind,) = choose("kind", of, NAMED)
        return {kind: names}
    words, given = split_names(names), given_in(names)
    shared = {kind for kind in NAMED.values() if all(_has(kind, word) for word in words)}
    if len(shared) == 1:
        return dict.fromkeys(shared, names)
    found: dict[Kind, list[str]] = {}
    for word in words:
        found.setdefault(NORMAL if word in given else _kind_of_word(word), []).append(word)
    return {kind: Words(some, given) for kind, some in found.items()}


def _has(kind: Kind, word: str) -> bool:
    """Whether a kind of the catalogue has an encoding of a name, over whatever range."""
    return spelled(f"{kind.name} encoding", name_and_range(word)[0], BY_KIND[kind]) is not None


def _kind_of_word(word: str) -> Kind:
    """The kind of one name. Raises UsageError where several kinds have it."""
    if names_an_encoder(word):
        return _kind_of_file(Path(file_of(word)))
    found = [kind for kind in NAMED.values() if _has(kind, word)]
    if len(found) > 1 and NORMAL not in found:
        several = ", ".join(kind.word for kind in found)
        raise UsageError(f"{word}: codes of {several} have this name; say which with --of, as in --of {found[0].word}")
    others = list(dict.fromkeys(name for kind in MADE for name in BY_KIND[kind]))
    if not found and meant(word, others) and not meant(word, BY_KIND[NORMAL]):
        raise unknown_name("encoding", [word], others)
    return found[0] if found else NORMAL


def _kind_of_file(path: Path) -> Kind:
    """What a user's file is of: what its functions' names say, or else of normals where it can be."""
    from ..user_encodings import encodings_named

    if (spoken := kind_by_names(path)) and spoken in MADE:
        return spoken
    try:
        encodings_named(str(path))
    except UsageError as error:
        own = kind_of_file(path, str(error))
        return own.kind if own and own.kind in MADE else NORMAL
    return NORMAL


def codecs_of_kind(kind: Kind, names: str, storages: str, roundings: Sequence[str]) -> list[Any]:
    """Codecs of another kind than normals; in each encoding's first usual storage where none is named.

    Args:
        names: of encodings and of users' files; of light and curves over a range as well: rgbm:8.

    Raises:
        UsageError: an unknown name, or a range that is none.
    """
    words, catalogue = split_names(names), BY_KIND[kind]
    ranged = [word for word in words if ":" in word and not names_an_encoder(word)]
    plain = ",".join(word for word in words if word not in ranged)
    encodings: list[AnyEncoding] = own_codes_named(kind, plain, catalogue) if plain or not ranged else []
    chosen = [(encoding, None) for encoding in encodings] + [_with_range(kind, word) for word in ranged]
    made = (
        codec if largest is None else replace(codec, range=largest)
        for encoding, largest in chosen
        for rounding in roundings
        for codec in MADE[kind](encoding, storages or encoding.storages[0], rounding)  # pyright: ignore[reportAttributeAccessIssue]
    )
    return list(dict.fromkeys(made))


def _with_range(kind: Kind, word: str) -> tuple[Any, float | None]:
    """The encoding of a name with a range, and the range where the encoding does not have it itself."""
    name, text = name_and_range(word)
    if kind is LIGHT:
        return ranged_light_buffer(word).encoding, None
    if kind is not CURVE:
        raise UsageError(f"{word}: its functions take the range, or need none; name {name}")
    (encoding,) = choose("curve encoding", name, BY_KIND[CURVE])
    return encoding, range_in(word, text)
