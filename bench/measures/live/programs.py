"""A codec as a browser runs it: its functions in GLSL ES 3.00, and the positions of its numbers in a texel."""

from __future__ import annotations

import base64
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ....encodings.storages.storage import STORAGES, Storage
from ....encodings.vec import CONSTANTS
from ....gbuffer.gl.shader import ShaderError, Source
from ...ground.output import cache as kept
from ...ground.output.errors import UsageError
from ...ground.output.sources import sources
from ...shaders.code.channels import Channels
from ...shaders.code.files import Code, code_of
from ...shaders.code.kinds.normal import is_catalogues

Record = dict[str, Any]
LANGUAGE, PREFIX = "essl", "codec"
# What look-up tables of a codec may take in a page, in bytes before they are packed.
MOST_TABLES = 2**16
# Of each number of numbers, an encoding whose storage functions serve all others: a code is as many numbers in [-1, 1].
STAND_INS = {2: "octahedral", 3: "xyz"}
USUAL = ("rgba8", "rgb10a2", "rg8", "rg16", "rg16f", "rgb8_12_12", "r11g11b10f")
HELPERS = "vec.glsl"
TABLES_TOO_LARGE = "its lookup tables are too large for a page"


class NotLiveError(ValueError):
    """Raised for a codec that browsers cannot run; the message is the reason."""


@cache
def program(codec: Codec) -> Record:
    """Return a codec in the form that the page's scripts read, flat except for `channels` and `tables`. Results are
    cached for the catalogue's encodings.

    Raises:
        NotLiveError: its GLSL cannot be translated, its lookup tables are too large, or noise is added to its
            numbers.
    """
    key = kept.key_of("live program", sources(), codec.name) if is_catalogues(codec.encoding) else ""
    return kept.kept(key, lambda: _program(codec))


def _program(codec: Codec) -> Record:
    if codec.is_dithered:
        raise NotLiveError(f"{codec.name}: a page cannot add noise")
    if what := codec.storage.only_measured:
        raise NotLiveError(f"{codec.name}: a page cannot read {what}")
    try:
        code = code_of(codec, LANGUAGE, PREFIX)
    except (UsageError, ShaderError) as error:
        raise NotLiveError(str(error)) from error
    size = sum(table.nbytes for table in code.interface.tables.values())
    if size > MOST_TABLES:
        raise NotLiveError(TABLES_TOO_LARGE)
    encoding = codec.encoding
    own = encoding.source or encoding.glsl
    return {
        "encoding": encoding.name,
        "rounding": codec.rounding,
        "domain": encoding.domain,
        "source": code.body,
        "text": "" if is_catalogues(encoding) else _file_text(own),
        "sign_bits": code.interface.sign_bits,
        "takes_view": code.interface.takes_view,
        "tables": {name: _table_record(table) for name, table in code.interface.tables.items()},
        **_code_record(codec, code),
    }


def _file_text(own: Path) -> str:
    """Return the text of a user's file. Raises NotLiveError if the file cannot be read."""
    try:
        return own.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise NotLiveError(f"{own} cannot be read") from error


def _code_record(codec: Codec, code: Code) -> Record:
    """Return the fields of a codec's record about its storage, its texels and the position of each of its numbers."""
    storage, channels = codec.storage, Channels(codec)
    return {
        "storage": storage.name,
        "title": storage.title,
        "bits": codec.bits,
        "format": storage.target.internal_format,
        "target": storage.target.title,
        "size": code.interface.size,
        "words": code.interface.words,
        "bytes": channels.parts,
        "channels": [
            {"kind": c.kind, "bits": c.bits, "first": c.first, "integer": c.integer} for c in channels.channels
        ],
    }


def _table_record(table: np.ndarray) -> Record:
    height, width, channels = table.shape
    data = base64.b64encode(np.ascontiguousarray(table, "<f4").tobytes()).decode("ascii")
    return {"width": width, "height": height, "channels": channels, "data": data}


def storage_functions(names: list[str]) -> list[Record]:
    """Return records like those of `program` for an encoder that a user types into a page: each storage's functions
    for codes of two and of three numbers, as far as the storage can hold them.

    Args:
        names: storages of the run; unknown names are left out. The usual storages are always included.
    """
    chosen = [STORAGES[name] for name in dict.fromkeys((*USUAL, *names)) if name in STORAGES]
    return [program(codec) for storage in chosen for codec in _stand_ins(storage)]


def helpers() -> str:
    """Return the GLSL ES source of the functions that users' encoders may call."""
    return Source(HELPERS, CONSTANTS).text


def _stand_ins(storage: Storage) -> list[Codec]:
    codecs = [Codec(ENCODINGS[name], storage, "nearest") for name in STAND_INS.values()]
    return [codec for codec in codecs if not codec.misfit]
