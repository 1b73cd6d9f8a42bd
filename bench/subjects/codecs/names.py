"""Codecs by their names on the command line, checked before anything is measured."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import jax
import jax.numpy as jnp

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.codecs.variants import ARITHMETICS, DECLARED, FLOAT, HALF, in_half
from ....encodings.storages.storage import ROUNDINGS
from ....encodings.vec import Vec3
from ...ground.choose import choose, names_a_file
from ...ground.options.words import Given, Names, Word
from ...ground.output.errors import MissingError, UsageError, by_reason, tell
from ...ground.user_files import CHAIN, file_of
from ...shaders.code.twin import NoTwinError, has_twin
from ..names.storages import roundings_named, storages_named
from .encoding_names import encodings_named

NEAREST = "nearest"


def codecs_named(
    encodings: Names,
    storages: Names,
    roundings: Names,
    arithmetics: Names = (FLOAT,),
    known_roundings: Sequence[str] = ROUNDINGS,
) -> list[Codec]:
    """Return a codec for every combination of the names, including users' encodings from files.

    Args:
        known_roundings: the valid names of rounding modes.

    Raises:
        UsageError: a name is unknown.
    """
    named = _with_chains(encodings)
    has_no_half = arithmetics == (DECLARED,) and not _computes_halves(named)
    chosen = with_arithmetics(named, (FLOAT,) if has_no_half else arithmetics)
    codecs = (
        Codec(encoding, storage, rounding)
        for storage in storages_named(storages)
        for rounding in roundings_named(roundings, known_roundings)
        for encoding in chosen
    )
    # One with a storage of its own is one codec, however many storages are named.
    return list(dict.fromkeys(codecs))


def _with_chains(words: Names) -> list[Encoding]:
    """Return encodings by name; CODEC+ENCODING stands for ENCODING applied to the normals that CODEC decodes. Raises
    UsageError."""
    own = [word for word in words if isinstance(word, Given)]
    chains = [word for word in words if isinstance(word, str) and _is_chain(word)]
    single = tuple(word for word in words if word not in chains)
    encodings = encodings_named(single) if single or not chains else []
    return [*encodings, *(_chained_encoding(word, own) for word in chains)]


def _is_chain(word: str) -> bool:
    return CHAIN in word and not names_a_file(str(file_of(word)))


def _chained_encoding(word: str, own: Sequence[Given]) -> Encoding:
    before, _, then = word.rpartition(CHAIN)
    name, is_codec, storage = before.rpartition("/")
    if not (is_codec and name and then):
        raise UsageError(f"{word}: a chain is ENCODING/STORAGE+ENCODING, such as octahedral/rgb8_12_12+xyz")
    first, second = (next((given for given in own if given.name == part), part) for part in (name, then))
    codecs, encodings = codecs_named((first,), (storage,), (NEAREST,)), encodings_named((second,))
    if len(codecs) != 1 or len(encodings) != 1:
        raise UsageError(f"{word}: a chain has one codec and one encoding")
    if encodings[0].domain == "view" or codecs[0].encoding.sign_bits:
        raise UsageError(f"{word}: encodings that need a view ray or a depth cannot be chained")
    return encodings[0].behind(codecs[0])


def with_arithmetics(encodings: Sequence[Encoding], names: Iterable[Word]) -> list[Encoding]:
    """Return the encodings in each of the named arithmetics; an encoding that is half by its own name appears once.

    DECLARED means both arithmetics for files that declare 16-bit numbers, and float for all other encodings. Raises
    UsageError.
    """
    chosen = choose("arithmetic", names, {word: word for word in (*ARITHMETICS, DECLARED)})
    named = [encoding for encoding in encodings if encoding.is_half or {FLOAT, DECLARED} & set(chosen)]
    others = [encoding for encoding in encodings if not encoding.is_half]
    return [
        *named,
        *(in_half(encoding) for encoding in others if HALF in chosen or (DECLARED in chosen and encoding.is_also_half)),
    ]


def _computes_halves(encodings: Iterable[Encoding]) -> bool:
    """Whether this machine can compute in 16 bits the encodings that declare 16-bit numbers; if not, report it."""
    if any(encoding.is_also_half and not has_twin(encoding) for encoding in encodings):
        from .half.compute import half_device

        try:
            half_device()
        except MissingError as error:
            tell(f"encodings that declare 16-bit numbers are computed only in 32 bits: {error}")
            return False
    return True


def as_declared(codecs: Sequence[Codec]) -> list[Codec]:
    """Return the codecs in the arithmetic that their files declare, if this machine can compute in it; otherwise
    unchanged."""
    if not _computes_halves([codec.encoding for codec in codecs]):
        return list(codecs)
    return [
        replace(codec, encoding=in_half(codec.encoding)) if codec.encoding.is_also_half else codec for codec in codecs
    ]


def fitting(codecs: Iterable[Codec]) -> tuple[list[Codec], list[str]]:
    """Return the codecs whose storage has room for their components, and a line for each reason why others are left
    out.

    Raises:
        UsageError: no codec is left.
    """
    codecs = list(codecs)
    fit = [codec for codec in codecs if codec.fits]
    left_out = by_reason((codec.name, codec.misfit) for codec in codecs if not codec.fits)
    if not fit:
        raise UsageError(left_out[0] if left_out else "nothing to measure")
    return fit, left_out


def check_twin(encoding: Encoding) -> None:
    """Trace the Python twin of a user's encoding on one normal. Do nothing if the encoding is in the catalogue, whose
    twins are tested, or has no twin.

    Raises:
        UsageError: the twin raises an exception, or its code does not have the declared size. The message is one line
            and names the twin's file.
    """
    if ENCODINGS.get(encoding.name) is encoding:
        return
    n = Vec3(*[jax.ShapeDtypeStruct((1,), jnp.float32)] * 3)
    where = encoding.twin
    try:
        code = jax.eval_shape(encoding.encode, n, n)
        size = encoding.components + encoding.sign_bits
        if len(code) != size:
            raise TypeError(f"encode returns {len(code)} numbers, but components and sign_bits add up to {size}")
        jax.eval_shape(encoding.decode, code, n)
    except NoTwinError:
        return
    except Exception as error:  # whatever a user's own code raises
        raise UsageError(f"{where}: {type(error).__name__}: {str(error).splitlines()[0]}") from error
