"""The page's facts about codecs besides their rows: formulas, sources, engines and stored numbers."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator, Sequence
from typing import Any

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.codec import Codec, fewer_bits
from ...encodings.codecs.encoding import Encoding
from ...encodings.storages.rules import rule_of_first, storage_of
from ...gbuffer.layouts.presets import LAYOUTS
from ...reports.page.codec_key import CodecKey
from ...reports.page.sections import TableSection
from ...reports.sheets import View
from ..ground.options.option import fields_of
from ..tables.registry import TABLES
from ..tables.shared_columns import ENCODING

# What a command may be given of a codec, by the column of a row.
OPTIONS = ("encoding", "storage", "rounding")
# What an encoding is made for, by its domain.
DOMAINS = {"sphere": "all directions", "hemisphere": "normals with z >= 0", "view": "normals that face the viewer"}
COMMENT = re.compile(r"\s*// (.*)")
# The body of a GLSL function, up to the brace that begins a line.
BODY = r"\b{name}\([^)]*\)\s*\{{\n(.*?)^\}}"


def about_codecs(sections: Sequence[TableSection]) -> dict[str, Any]:
    """Return the contents of a page's cards as a dictionary: `encodings` by name, `codecs` by label, and `takes`, the
    options of each table that name a codec."""
    shown = [section for section in sections if _is_of_normals(section)]
    rows = [row for section in shown for row in section.rows]
    keys = dict.fromkeys(key for row in rows if (key := CodecKey.said_by(row)))
    encodings = [
        ENCODINGS[name] for name in dict.fromkeys(str(row.get("encoding")) for row in rows) if name in ENCODINGS
    ]
    codecs = {key.label: record for key in keys if (record := _codec_record(key))}
    takes = {section.key: [o for o in OPTIONS if _takes(section.key, o)] for section in shown}
    return {
        "encodings": {encoding.name: _encoding_record(encoding) for encoding in encodings},
        "codecs": codecs,
        "takes": takes,
    }


def _is_of_normals(section: TableSection) -> bool:
    """Whether a table's encodings are encodings of normals."""
    columns = TABLES[section.key].columns
    is_among_codecs = section.about.view is View.CODECS and ENCODING.name in {column.name for column in columns}
    return ENCODING in columns or is_among_codecs


def _takes(table: str, option: str) -> bool:
    """Whether a table has an option of this name that `run` passes on to it."""
    known = fields_of(TABLES[table].options)
    return option in known and known[option].option.in_run


def _codec_record(key: CodecKey) -> dict[str, Any]:
    """Return a codec's `storage` in words, its `bits`, its `codes` (the bits that its codes amount to, if fewer), its
    `numbers` and its `domain`; empty for an unknown codec."""
    if not (codec := codec_of(key)):
        return {}
    numbers = f"{rule_of_first(codec.storage, codec.encoding.components)} {codec.rounding}"
    about: dict[str, Any] = {"storage": codec.storage.title, "bits": codec.bits, "numbers": numbers}
    codes = fewer_bits(codec.bits, codec.code_bits)
    about |= {"codes": codes} if codes else {}
    return about | {"domain": codec.encoding.domain}


def codec_of(key: CodecKey) -> Codec | None:
    """Return the codec for a key; None if its encoding is not in the catalogue, or its storage is unknown."""
    encoding = ENCODINGS.get(key.encoding)
    try:
        storage = storage_of(key.storage)
    except ValueError:
        return None
    return Codec(encoding, storage, key.rounding) if encoding and storage else None


def _encoding_record(encoding: Encoding) -> dict[str, Any]:
    module = sys.modules.get(getattr(encoding.encode, "__module__", ""))
    record = {
        "title": encoding.title,
        "says": _first_sentence(module),
        "domain": DOMAINS.get(encoding.domain, encoding.domain),
        "components": encoding.components,
        "sign": encoding.sign_bits,
        "source": encoding.citation,
        "precise": encoding.is_precise,
        "tables": bool(encoding.tables()) if encoding.tables is not dict else False,
        "used": list(dict.fromkeys(_engines(encoding))),
    }
    return record | {what: _formula(encoding, what) for what in ("encode", "decode")}


def _first_sentence(documented: Any) -> str:
    """Return the first paragraph of a module's or a function's docstring, on one line; empty without a docstring."""
    text = inspect.getdoc(documented) or ""
    return " ".join(text.partition("\n\n")[0].split())


def _formula(encoding: Encoding, what: str) -> list[str]:
    """Return the lines of an encoding's formula for `what`, "encode" or "decode": the first paragraph of the
    function's docstring, then the comments in its GLSL."""
    source = encoding.glsl.read_text(encoding="utf-8")
    match = re.search(BODY.format(name=f"{encoding.prefix}_{what}"), source, re.MULTILINE | re.DOTALL)
    comments = (COMMENT.fullmatch(line) for line in (match[1] if match else "").splitlines())
    return [_first_sentence(getattr(encoding, what)), *(comment[1] for comment in comments if comment)]


def _engines(encoding: Encoding) -> Iterator[tuple[str, int, str]]:
    """Yield (engine, year, storage) for each engine layout that stores normals in an encoding, with any axes."""
    for layout in sorted(LAYOUTS.values(), key=lambda preset: (preset.engine.lower(), preset.year)):
        if layout.engine and layout.encoding.name.partition(":")[0] == encoding.name:
            yield layout.engine, layout.year, layout.normal_storage
