"""A codec as a file of NumPy: the catalogue's own Python, and the packing of its storage."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from inspect import getclosurevars, signature
from typing import Any

import numpy as np

from ....encodings import vec
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import AXES, Encoding
from ....encodings.storages import rounding
from ....encodings.storages.storage import MANTISSA, Storage
from ...ground.output.errors import UsageError
from .python_source import Gathered

HEAD = '''def _where(condition, a, b):
    """np.where in float32, also of two plain numbers."""
    chosen = np.where(condition, a, b)
    return chosen.astype(np.float32) if chosen.dtype == np.float64 else chosen'''
LOOP = '''def _fori_loop(first, end, body, carry):
    """What a body makes of a carry, step after step."""
    for step in range(first, end):
        carry = body(np.int32(step), carry)
    return carry'''
WORD = 32


VECTORS = '''_NOWHERE = _Vec3(*[np.float32(0)] * 3)


def _vector(array):
    """Planes of an array of shape (..., 3)."""
    return _Vec3(*(np.asarray(array, np.float32)[..., i] for i in range(3)))'''


def words_of(storage: Storage) -> int:
    """How many 32-bit integers a texel of a storage has: 1, 2 or 4."""
    return -(-sum(storage.target.bits) // WORD)


def numpy_source(codec: Codec, prefix: str, head: str = "") -> str:
    """The file of a codec: P_encode, P_pack, P_unpack, P_decode, P_to_target and P_from_target, P being the prefix.

    Args:
        prefix: an identifier in lower case.
        head: lines that the file begins with, as comments.

    Raises:
        UsageError: a chain of codecs, half arithmetic, or a storage that cannot hold the code; one line.
    """
    _check(codec)
    gathered = Gathered()
    body = "\n\n\n".join([*_encoding(codec, prefix, gathered), *_storage(codec, prefix, gathered)])
    helpers = [HEAD, *([LOOP] if "_fori_loop" in gathered.text() else [])]
    tables = [_loaded(name, prefix) for name in sorted(codec.encoding.tables())]
    imports = sorted(gathered.imports, key=lambda line: (line.startswith("from"), line))
    imports += ["from pathlib import Path"] if tables else []
    comment = "".join(f"# {line}".rstrip() + "\n" for line in head.splitlines())
    title = (
        f'"""{codec.encoding.title} in {codec.storage.title}, for NumPy."""\n\nfrom __future__ import annotations\n\n'
    )
    first = comment + title + "".join(f"{line}\n" for line in imports) + ("\n" if imports else "")
    parts = ["import numpy as np\n\n" + "\n".join(tables), *helpers, gathered.text(), body]
    return first + "\n\n\n".join(part.strip("\n") for part in parts if part) + "\n"


def _check(codec: Codec) -> None:
    if codec.encoding.before:
        raise UsageError(f"{codec.name}: a chain of codecs is not written as source code; name one codec")
    if codec.encoding.is_half:
        raise UsageError(f"{codec.name}: half arithmetic is not written in NumPy; leave out arithmetic=half")
    if codec.misfit:
        raise UsageError(f"{codec.name}: {codec.misfit}")


def _loaded(name: str, prefix: str) -> str:
    return f'{name.upper()} = np.load(Path(__file__).with_name("{prefix}_{name}.npy"))'


def _plain(function: Any) -> tuple[Any, dict[str, Any]]:
    """The function of an encoding's file behind variants, and the values that they give it."""
    values: dict[str, Any] = {}
    while isinstance(function, partial) or "turned" in function.__name__:
        if isinstance(function, partial):
            values = {**function.keywords, **values}
            function = function.func
        else:
            found = getclosurevars(function).nonlocals
            function = found["encode" if "encode" in function.__name__ else "decode"]
    return function, values


def _encoding(codec: Codec, prefix: str, gathered: Gathered) -> Iterator[str]:
    """The public encoder and decoder."""
    encoding = codec.encoding
    encode, given = _plain(encoding.encode)
    decode, taken = _plain(encoding.decode)
    if encoding.look_up and "table" in signature(encode).parameters:
        given["table"] = encoding.look_up.sampler.upper()
    calls = []
    for function, values, side in ((encode, given, "encode"), (decode, taken, "decode")):
        _with_tables(function, encoding, gathered)
        name = gathered.add(function, tuple(values), f"_{side}")
        calls.append((name, "".join(f", {key}={value}" for key, value in values.items())))
    for helper in (vec.from_array, vec.to_array):
        gathered.add(helper)
    view = ", view" if encoding.domain == "view" else ""
    rays = "_vector(view)" if view else "_NOWHERE"
    yield VECTORS
    yield _inner("encode", "n", calls[0], encoding)
    yield _inner("decode", "e", calls[1], encoding)
    if codec.encoding.is_precise:
        yield _precise(codec)
    chosen = "_nearest" if codec.encoding.is_precise else "_encode_turned"
    size = encoding.components + encoding.sign_bits
    code = f"_Vec{size}(*(e[..., i] for i in range({size})))"
    yield (
        f'def {prefix}_encode(n{view}):\n    """Codes of unit normals: float32 (..., {size}) of (..., 3)."""\n'
        f'    with np.errstate(all="ignore"):\n        return _to_array({chosen}(_from_array(n), {rays}))'
    )
    yield (
        f'def {prefix}_decode(e{view}):\n    """Normals of codes: float32 (..., 3) of (..., {size})."""\n'
        f'    with np.errstate(all="ignore"):\n        return _to_array(_decode_turned({code}, {rays}))'
    )


def _with_tables(function: Any, encoding: Encoding, gathered: Gathered) -> None:
    """What makes a table is replaced by the table that lies next to the file."""
    tables = encoding.tables()
    for name, maker in function.__globals__.items():
        if not tables or not _makes_tables(maker):
            continue
        made = maker()
        entries = made if isinstance(made, dict) else {"": made}
        shown = {key: _shown(value, tables) for key, value in entries.items()}
        if all(shown.values()):
            text = shown.get("", "{" + ", ".join(f'"{key}": {value}' for key, value in shown.items()) + "}")
            said = '"""The table that lies next to this file."""'
            gathered.written[name] = f"def _{name}():\n    {said}\n    return {text}"


def _makes_tables(maker: Any) -> bool:
    """Whether it is a function that gives an array, or arrays by name, of nothing."""
    if not callable(maker) or isinstance(maker, type):
        return False
    said = getattr(maker, "__annotations__", {}).get("return", "")
    needed = getattr(getattr(maker, "__wrapped__", maker), "__code__", None)
    required = needed.co_argcount - len(getattr(maker, "__wrapped__", maker).__defaults__ or ()) if needed else 1
    return "ndarray" in str(said) and not required


def _shown(array: Any, tables: Any) -> str:
    """An array as a table, or as its first row."""
    for name, table in tables.items():
        for text, part in ((name.upper(), table), (f"{name.upper()}[0]", table[0])):
            if np.array_equal(part, array):
                return text
    return ""


def _inner(side: str, given: str, called: tuple[str, str], encoding: Encoding) -> str:
    """The encoder or decoder in the axes that the codec has."""
    order, back = AXES[encoding.axis]
    (name, values), sign = called, " * -1" if encoding.sign < 0 else ""

    def turned(what: str, axes: str) -> str:
        return f"_Vec3({', '.join(f'{what}.{axis}' for axis in axes)}){sign}" if encoding.is_turned else what

    if side == "encode":
        text = f"{name}({turned(given, order)}, {turned('view', order)}{values})"
        said = "The code of planes of normals."
    else:
        text = f"{name}(e, {turned('view', order)}{values})"
        said = "Planes of normals of a code."
    lines = [f"n = {text}", f"return {turned('n', back)}"] if side == "decode" else [f"return {text}"]
    return f'def _{side}_turned({given}, view):\n    """{said}"""\n    ' + "\n    ".join(lines)


def _precise(codec: Codec) -> str:
    storage, count = codec.storage, codec.encoding.components
    scales = tuple(float(storage.scale(i)) for i in range(count))
    shift = "c * 0.5 + 0.5" if storage.is_biased else "c"
    low = "0.0" if storage.is_biased else "-1.0"
    back = " * 2.0 - 1.0" if storage.is_biased else ""
    return f'''def _around(c, scale):
    """The two numbers that a channel can hold around c, the lower one first."""
    x = _minimum(_maximum({shift}, {low}), 1.0)
    below = np.floor(x * scale)
    return tuple(step * (1.0 / scale){back} for step in (below, _minimum(below + 1.0, scale)))


def _nearest(n, view):
    """Of the codes around, every number rounded down or up, the one that is decoded nearest to n."""
    code = _encode_turned(n, view)
    around = [_around(c, scale) for c, scale in zip(code, {scales}, strict=True)]
    best, least = None, None
    for numbers in itertools.product(*around):
        candidate = type(code)(*numbers)
        miss = n - _decode_turned(candidate, view)
        distance = _dot(miss, miss)
        is_nearer = True if least is None else distance < least
        best = candidate if best is None else _select(is_nearer, candidate, best)
        least = distance if least is None else _where(is_nearer, distance, least)
    return best'''


def _storage(codec: Codec, prefix: str, gathered: Gathered) -> Iterator[str]:
    """Packing, unpacking, and what a render target is given and gives."""
    storage, encoding = codec.storage, codec.encoding
    helpers = (vec.minimum, vec.maximum) if storage.kind != "float" else ()
    for helper in (*helpers, *((vec.select, vec.dot) if encoding.is_precise else ())):
        gathered.add(helper)
    if storage.kind == "float" and storage.bits[0] < WORD:
        gathered.add(rounding.store_half if storage.bits[0] == 16 else rounding.store_small_float)
    if encoding.is_precise:
        gathered.imports.add("import itertools")
    count, words = encoding.components, words_of(storage)
    sign, last = (", sign", ", np.asarray(sign, np.float32)") if encoding.sign_bits else ("", "")
    yield _texel(codec)
    places = list(_places(storage, count))
    terms: list[list[str]] = [[] for _ in range(words)]
    for channel, (word, lines) in enumerate(places):
        terms[word].append(lines(f"_bits_{channel}(code[..., {channel}])"))
    packed = [" | ".join(term) or "np.zeros(code.shape[:-1], np.uint32)" for term in terms]
    result = packed[0] if words == 1 else f"np.stack([{', '.join(packed)}], axis=-1)"
    shape = "(...)" if words == 1 else f"(..., {words})"
    yield f'def {prefix}_pack(code):\n    """The texel of a code: uint32 of shape {shape}."""\n    return {result}'
    numbers = ", ".join(f"_number_{i}({_read(storage, i, words)})" for i in range(count))
    yield (
        f'def {prefix}_unpack(words{sign}):\n    """The code of a texel: float32."""\n'
        f"    return np.stack(np.broadcast_arrays({numbers}{last}), axis=-1)"
    )
    yield from _target(codec, prefix, sign)


def _places(storage: Storage, count: int) -> Iterator[tuple[int, Any]]:
    """For each component the word that it lies in, and what moves its bits there."""
    for channel in range(count):
        if storage.is_packed:
            yield 0, partial(_laid, storage.bits[channel], sum(storage.bits[:channel]))
        else:
            word, shift = divmod(sum(storage.bits[:channel]), WORD)
            yield word, lambda bits, shift=shift: f"{bits} << np.uint32({shift})" if shift else bits


def _laid(bits: int, first: int, text: str) -> str:
    return f"_swapped({text} << np.uint32({WORD - bits - first}))"


def _read(storage: Storage, channel: int, words: int) -> str:
    """The bits of a channel, from words."""
    bits, first = storage.bits[channel], sum(storage.bits[:channel])
    mask = f"np.uint32({2**bits - 1})"
    if storage.is_packed:
        return f"_swapped(words) >> np.uint32({WORD - bits - first}) & {mask}"
    word, shift = divmod(first, WORD)
    text = "words" if words == 1 else f"words[..., {word}]"
    return f"{text} >> np.uint32({shift}) & {mask}" if shift or bits < WORD else text


def _texel(codec: Codec) -> str:
    """For each component: its number to bits, and bits to its number."""
    storage, parts = codec.storage, []
    if storage.is_packed:
        parts.append('''def _swapped(words):
    """32 bits in the other order of bytes: numbers lie across the channels with the highest bits first."""
    return np.ascontiguousarray(words, np.uint32).byteswap()''')
    for i in range(codec.encoding.components):
        way = codec.rounding_of(i)
        to_bits, to_number = _float_lines(storage, i, way) if storage.kind == "float" else _fixed_lines(storage, i, way)
        x = "c * np.float32(0.5) + np.float32(0.5)" if storage.is_biased else "c"
        back = " * np.float32(2.0) - np.float32(1.0)" if storage.is_biased else ""
        parts.append(f'def _bits_{i}(c):\n    """Channel {i} as a whole number."""\n    x = {x}\n    {to_bits}')
        parts.append(f'def _number_{i}(bits):\n    """The number of channel {i}."""\n    return ({to_number}){back}')
    return "\n\n\n".join(parts)


def _fixed_lines(storage: Storage, channel: int, way: str) -> tuple[str, str]:
    scale, bits = storage.scale(channel), storage.bits[channel]
    step = f"np.float32(1.0 / {scale})"
    low = "-1.0" if storage.kind == "snorm" else "0.0"
    clamped = f"_minimum(_maximum(x, {low}), 1.0)"
    widened = {"nearest": f"{scale}.0", "truncate": f"{scale}.0", "truncate_half": f"{scale}.5"}[way]
    rounds = "np.round" if way == "nearest" else "np.trunc"
    whole = f"{rounds}({clamped} * {widened})"
    whole = whole if way == "nearest" else f"_minimum(_maximum({whole}, -{scale}.0), {scale}.0)"
    if storage.kind == "unorm":
        return f"return {whole}.astype(np.uint32)", f"bits.astype(np.float32) * {step}"
    if storage.is_packed:
        integer = f"(bits.astype(np.int32) - {scale})"
        return (
            f"return ({whole}.astype(np.int32) + {scale}).astype(np.uint32)",
            f"{integer}.astype(np.float32) * {step}",
        )
    extended = f"((bits << np.uint32({WORD - bits})).view(np.int32) >> {WORD - bits})"
    mask = f"np.uint32({2**bits - 1})"
    return f"return {whole}.astype(np.int32).astype(np.uint32) & {mask}", f"{extended}.astype(np.float32) * {step}"


def _float_lines(storage: Storage, channel: int, way: str) -> tuple[str, str]:
    bits = storage.bits[channel]
    if bits == WORD:
        return (
            "return np.ascontiguousarray(x, np.float32).view(np.uint32)",
            "np.ascontiguousarray(bits).view(np.float32)",
        )
    less = MANTISSA[16] - MANTISSA[bits]
    stored = (
        f'_store_half(x, "{way}")' if bits == 16 else f'_store_small_float(np.ascontiguousarray(x), {bits}, "{way}")'
    )
    half = f"{stored}.astype(np.float16).view(np.uint16).astype(np.uint32)"
    shifted = f"(bits << np.uint32({less}))" if less else "bits"
    to_bits = 'with np.errstate(all="ignore"):\n        return ' + (f"{half} >> np.uint32({less})" if less else half)
    return to_bits, f"{shifted}.astype(np.uint16).view(np.float16).astype(np.float32)"


def _target(codec: Codec, prefix: str, sign: str) -> Iterator[str]:
    storage, count = codec.storage, codec.encoding.components
    # A device's own conversion takes the nearest; other roundings are made before.
    made = (
        "code"
        if codec.rounding == "nearest"
        else f"{prefix}_unpack({prefix}_pack(code){', code[..., -1]' if sign else ''})"
    )
    biased, unbiased = ("made * np.float32(0.5) + np.float32(0.5)", "texel * np.float32(2.0) - np.float32(1.0)")
    said = '"""What a shader writes to the render target: float32 of shape (..., 4)."""'
    read = '"""The code of what a shader reads of the render target: float32."""'
    if storage.is_packed:
        yield (
            f"def {prefix}_to_target(code):\n    {said}\n    word = {prefix}_pack(code)\n"
            "    channels = [word >> np.uint32(8 * i) & np.uint32(255) for i in range(4)]\n"
            "    return np.stack(channels, axis=-1).astype(np.float32) / np.float32(255.0)"
        )
        yield (
            f"def {prefix}_from_target(texel{sign}):\n    {read}\n"
            "    channels = (np.asarray(texel, np.float32) * np.float32(255.0) + np.float32(0.5)).astype(np.uint32)\n"
            "    word = sum((channels[..., i] << np.uint32(8 * i) for i in range(1, 4)), start=channels[..., 0])\n"
            f"    return {prefix}_unpack(word{sign})"
        )
        return
    yield (
        f"def {prefix}_to_target(code):\n    {said}\n    made = {made}[..., :{count}]\n"
        "    target = np.zeros((*code.shape[:-1], 4), np.float32)\n"
        f"    target[..., :{count}] = {biased if storage.is_biased else 'made'}\n    return target"
    )
    numbers = (
        f"texel = np.asarray(texel, np.float32)[..., :{count}]\n    code = {unbiased if storage.is_biased else 'texel'}"
    )
    result = "np.concatenate([code, np.asarray(sign, np.float32)[..., None]], axis=-1)" if sign else "code"
    yield f"def {prefix}_from_target(texel{sign}):\n    {read}\n    {numbers}\n    return {result}"
