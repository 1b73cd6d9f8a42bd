"""The code that `run` keeps for its page: the functions of the catalogue's codecs in all languages. The functions of
the best codecs are also executed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

from ...encodings.catalogue import is_in_catalogue
from ...encodings.codecs.codec import Codec
from ...gbuffer.gl.shader import ShaderError
from ...reports.page.codec_key import CodecKey
from ..ground.compilers.tools import states
from ..ground.output import cache
from ..ground.output.errors import MissingError, UsageError
from ..ground.output.sources import sources
from ..keep.runs import Done
from ..shaders.code.emit import LANGUAGES
from ..shaders.code.files import code_of
from ..show.cards import codec_of
from ..show.kept_code import Written, write_code
from ..tables.registry import TABLES
from ..tables.shared_columns import ENCODING
from ..tables.table import UNEXPECTED, Row
from .code_command import proven, unproven_head

# How many codecs are written; and how many of each answer, the best first, are run, which takes seconds for each.
MOST, MOST_PROVEN = 400, 1


def keep_code(folder: Path, done: Done) -> None:
    """Write functions for at most MOST of a finished run's catalogue codecs to its folder. Write nothing if none of
    these codecs has code."""
    finished = {name: done.finished_rows(name) for name in done.tables if ENCODING in TABLES[name].columns}
    codecs = _codecs(row for rows in finished.values() for row in rows)
    best = _codecs(row for name, rows in finished.items() for row in _best(name, rows))
    written = {label: _written(codec, label in best) for label, codec in islice({**best, **codecs}.items(), MOST)}
    if codes := {label: code for label, code in written.items() if code.texts}:
        write_code(folder, {name: language.title for name, language in LANGUAGES.items()}, codes)


def _codecs(rows: Iterable[Row]) -> dict[str, Codec]:
    """Return the codecs that rows name, by label. Rows without a catalogue codec that fits its storage are
    skipped."""
    codecs: dict[str, Codec] = {}
    for row in rows:
        key = CodecKey.said_by(row)
        if key and key.label not in codecs and (codec := codec_of(key)) and codec.fits:
            codecs[key.label] = codec
    return codecs


def _best(name: str, rows: list[Row]) -> Iterator[Row]:
    """Yield the first MOST_PROVEN rows of each sheet in a table's answer; nothing if the table's section does not
    lead."""
    if TABLES[name].section.leads:
        for sheet in TABLES[name].work.summary(rows):
            yield from ({**sheet.keys, **row} for row in sheet.rows[:MOST_PROVEN])


def _written(codec: Codec, is_proven: bool) -> Written:
    """Return a codec's functions in all languages; for a codec in the catalogue, earlier results are reused."""
    facts = (sources(), codec.name, str(is_proven), *LANGUAGES, *states())
    key = cache.key_of("code", *facts) if is_in_catalogue(codec.encoding) else ""
    return Written(**cache.kept(key, lambda: _written_now(codec, is_proven)._asdict()))


def _written_now(codec: Codec, is_proven: bool) -> Written:
    try:
        if is_proven:
            pairs = [(proof.code, proof.head()) for proof in proven(codec, list(LANGUAGES)) if not proof.why_not]
        else:
            pairs = [(code, unproven_head(code)) for code in (code_of(codec, name) for name in LANGUAGES)]
    except (UsageError, MissingError, ShaderError, *UNEXPECTED):
        return Written({})
    texts = {code.language: code.text(head) for code, head in pairs}
    return Written(texts, is_proven, any(code.interface.tables for code, _ in pairs))
