"""Storages named by their bits: unorm:9:7, snorm:12:12, centred:8:8, float:5:10.

Each is the catalogue's format with exactly these bits, or numbers laid across the channels of RGBA8 or RGBA16.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from .storage import BITS_32, CENTRED, FORMATS, FORMS, RGBA8, STORAGES, FloatForm, Storage, centred_storage

# Most bits of a number laid across channels, and of all numbers together.
MOST_BITS, MOST_TOGETHER, MOST_IN_WORD = 20, 64, 32
# Words for numbers by their bits, and what the names of storages end with that hold them across channels.
ENDINGS: Mapping[str, str] = MappingProxyType({"unorm": "", "snorm": "_snorm", "snorm_full": "_snorm_full"})
# Other words for the same numbers. SNORM of OpenGL before 4.2 is (2 i + 1) / (2^n - 1), which are UNORM's.
SAME: Mapping[str, str] = MappingProxyType({"uint": "unorm", "sint": "snorm", "snorm_gl2": "unorm"})
MOST_EXPONENT, MOST_MANTISSA = 8, 23
RGBA = "rgba"


def across(kind: str, bits: tuple[int, ...]) -> Storage:
    """Return the storage for numbers with these bits, laid across the fewest 8-bit (or 16-bit) channels: rg8_9_7.

    Args:
        kind: one of ENDINGS.

    Raises:
        ValueError: there are not one to four components, each of 1 (signed: 2) to MOST_BITS bits, with at most
            MOST_TOGETHER bits in total; the message is one line.
    """
    spread = ":".join(map(str, bits))
    if not all(1 <= b <= MOST_BITS for b in bits) or sum(bits) > MOST_TOGETHER or len(bits) not in (1, 2, 3, 4):
        most = f"of 1 to {MOST_BITS} bits (a float32 has 24), {MOST_TOGETHER} bits in total"
        raise ValueError(f"{kind}:{spread}: expected one to four components {most}")
    if kind != "unorm" and 1 in bits:
        raise ValueError(f"{kind}:{spread}: a signed component needs at least 2 bits")
    target = _target_of(sum(bits))
    signed = {"unorm": "", "snorm": "signed ", "snorm_full": "fully signed "}[kind]
    name, title = f"{target}_{spread.replace(':', '_')}{ENDINGS[kind]}", f"{spread} {signed}in {target.upper()}"
    storage = Storage(name, title, kind.partition("_")[0], bits, RGBA8, part=int(target.lstrip("rgba")), is_said=True)
    return replace(storage, is_full=kind == "snorm_full")


def _target_of(bits: int) -> str:
    """Return the name of the smallest target that holds this many bits, such as rgb8."""
    part = 8 if bits <= 32 else 16
    return f"{RGBA[: -(-bits // part)]}{part}"


def word(kind: str, bits: tuple[int, ...]) -> Storage:
    """Return the storage for numbers with these bits in an integer of 8, 16 or 32 bits, lowest first: r32_uint_12_12.

    Raises:
        ValueError: as in `across`; the message is one line.
    """
    laid = across(kind, bits)
    spread, size = ":".join(map(str, bits)), next(size for size in (8, 16, 32) if size >= sum(bits))
    name = f"r{size}_uint_{spread.replace(':', '_')}{ENDINGS[kind]}"
    signed = "signed " if kind == "snorm" else ""
    return replace(laid, name=name, title=f"{spread} {signed}in R{size}_UINT", is_word=True)


# Storages by rule: unorm:9:7, float:5:10.
KINDS = (*ENDINGS, *SAME, "centred", "float", "ufloat")
BY_RULE = re.compile(rf"(?P<kind>{'|'.join(KINDS)}):(?P<bits>\d{{1,3}}(?::\d{{1,3}})*)")


def by_rule(kind: str, bits: tuple[int, ...]) -> Storage:
    """Return the storage for numbers with these bits: the catalogue's format with exactly these bits, or numbers laid
    across channels.

    Args:
        kind: "unorm", "snorm", "snorm_full", or an alias of these; "uint" and "sint" numbers are in one integer if
            they have at most 32 bits in total. "centred" is for SNORM integers in the channels of a UNORM format.
            For "float" and "ufloat", with and without a sign, `bits` are those of the exponent and the mantissa,
            the same for all numbers (see `of_count`).

    Raises:
        ValueError: as in `across`; for centred numbers that are not in a GPU format; and for floats that cannot
            exist.
    """
    if kind in ("float", "ufloat"):
        return _of_floats(kind, bits)
    if kind == "centred":
        like = by_rule("unorm", bits)
        if like.name not in STORAGES or like.is_packed:
            raise ValueError(f"centred numbers need a GPU format, such as centred:8:8, not {':'.join(map(str, bits))}")
        return centred_storage(like)
    same = SAME.get(kind, kind)
    if kind in ("uint", "sint") and sum(bits) <= MOST_IN_WORD:
        return word(same, bits)
    alike = (s for s in FORMATS.values() if (s.kind, s.bits, s.curved) == (same, bits, 0) and s != BITS_32)
    laid = (s for s in STORAGES.values() if s.is_packed and (s.kind, s.bits) == (same, bits))
    storage = next(laid if kind in ("uint", "sint") else itertools.chain(alike, laid), None)
    return storage or across(same, bits)


def _of_floats(kind: str, bits: tuple[int, ...]) -> Storage:
    """Return a storage for floats, signed unless `kind` is "ufloat": as many as fit in 64 bits, at most four.

    Raises:
        ValueError: `bits` are not the bits of an exponent and a mantissa, or are out of range; the message is one
            line.
    """
    text = ":".join((kind, *map(str, bits)))
    if len(bits) != 2 or not (2 <= bits[0] <= MOST_EXPONENT and 1 <= bits[1] <= MOST_MANTISSA):
        known = f"{kind}:EXPONENT:MANTISSA, of 2 to {MOST_EXPONENT} and of 1 to {MOST_MANTISSA} bits"
        raise ValueError(f"write floats as {known}, such as float:5:10, not {text}")
    return replace(_floats(FloatForm(*bits, is_signed=kind == "float"), len(RGBA)), is_uncounted=True)


def of_count(storage: Storage, count: int) -> Storage:
    """Return a storage with `count` floats if only the bits per float were given; otherwise the storage unchanged."""
    return _floats(storage.float_form(0), count) if storage.is_uncounted else storage


def _floats(form: FloatForm, count: int) -> Storage:
    """Return a storage for `count` floats of a form, or for fewer if 64 bits hold no more; a GPU's own format if one
    exists, with four floats instead of three."""
    own = {FORMS[16]: "16f", FORMS[32]: "32f"}
    if form in own:
        # No GPU has three.
        return FORMATS[f"{RGBA[: count if count < 3 else len(RGBA)]}{own[form]}"]
    count = min(count, len(RGBA), MOST_TOGETHER // form.bits)
    kind, bits = "float" if form.is_signed else "ufloat", (form.exponent, form.mantissa)
    title = f"{count} floats of {'sign, ' if form.is_signed else ''}{bits[0]}:{bits[1]} bits"
    part = 8 if form.bits * count <= 32 else 16
    name = f"{kind}_{bits[0]}_{bits[1]}"
    return Storage(name, title, "float", (form.bits,) * count, RGBA8, part=part, is_said=True, form=form)


def rule_of(storage: Storage) -> str:
    """Return the rule that names a storage's bits, such as snorm:16:16; for floats, the exponent and mantissa bits of
    its channels, such as `ufloat:5:6 and 5:5`."""
    if storage.kind != "float":
        kind = "centred" if storage.is_centred else "snorm_full" if storage.is_full else storage.kind
        kind = {"unorm": "uint", "snorm": "sint"}[kind] if storage.is_word else kind
        return ":".join((kind, *map(str, storage.bits)))
    forms = [storage.float_form(channel) for channel in range(storage.channels)]
    form_texts = dict.fromkeys(f"{form.exponent}:{form.mantissa}" for form in forms)
    return f"{'float' if forms[0].is_signed else 'ufloat'}:{' and '.join(form_texts)}"


def rule_of_first(storage: Storage, count: int) -> str:
    """Return, as text, the bits of a storage's first `count` numbers, and whether they are laid across channels.
    Storages with the same text give these numbers the same codes: for example, RG8 and RGBA8 for two numbers."""
    first = rule_of(replace(storage, bits=storage.bits[:count]))
    return f"{first} across channels of {storage.part} bits" if storage.is_packed else first


def storage_of(name: str) -> Storage | None:
    """Return the storage with a name: an entry of the catalogue, numbers by rule as in `unorm:9:7`, or numbers laid
    across channels as in `rg8_9_7`; None if the name has none of these forms.

    Raises:
        ValueError: the name has such a form, but such a storage cannot exist; the message is one line.
    """
    if by := BY_RULE.fullmatch(name):
        return by_rule(by["kind"], tuple(map(int, by["bits"].split(":"))))
    if name in STORAGES:
        return STORAGES[name]
    if name.endswith(CENTRED) and (like := STORAGES.get(name.removesuffix(CENTRED))):
        return by_rule("centred", like.bits) if like.kind == "unorm" else None
    if floats := re.fullmatch(r"(u?float)_(\d{1,2})_(\d{1,2})", name):
        return _of_floats(floats[1], (int(floats[2]), int(floats[3])))
    match = re.fullmatch(r"(r|rg|rgb|rgba)(8|16|32)(_uint)?((?:_\d{1,3})+)(_snorm|_snorm_full)?", name)
    if not match:
        return FORMATS.get(name)
    kind = next(kind for kind, ending in ENDINGS.items() if ending == (match[5] or ""))
    storage = (word if match[3] else across)(kind, tuple(map(int, match[4][1:].split("_"))))
    if storage.name != name:
        raise ValueError(f"{name}: these bits are named {storage.name}")
    return storage
