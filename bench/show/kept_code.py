"""The code of a run's codecs, kept by `run` for the page: texts by codec and language; shared parts are
stored once."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, NamedTuple

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError, with_config
from typing_extensions import TypedDict

from ...encodings.codecs.files import file_bytes, parsed_json
from ..ground.output.writing import whole_file

FILE = "code.json"
MOST_BYTES = 2**23
# What a text falls into: the lines of its head, which languages share, and paragraphs, which codecs share.
PIECES = re.compile(r"(?<=\n\n)")
LINES = re.compile(r"(?<=\n)")
Name = Annotated[str, Field(max_length=200)]
Place = Annotated[int, Field(ge=0)]


@with_config(ConfigDict(strict=True, extra="forbid"))
class CodecCode(TypedDict):
    """A codec's code: the indices of its pieces by language, whether it was run, and whether it has lookup tables."""

    texts: dict[Name, list[Place]]
    proven: bool
    tables: bool


@with_config(ConfigDict(strict=True, extra="forbid"))
class KeptCode(TypedDict):
    """The whole file: language titles by name, pieces, and codecs by label."""

    languages: dict[Name, Name]
    pieces: list[str]
    codecs: dict[Name, CodecCode]


KEPT: TypeAdapter[Any] = TypeAdapter(KeptCode)


class Shared:
    """Texts as indices into a shared list of pieces."""

    def __init__(self) -> None:
        self._places: dict[str, int] = {}

    def places(self, text: str) -> list[int]:
        """Return the indices of a text's pieces in `pieces`, to which new pieces are added."""
        head, *rest = PIECES.split(text)
        pieces = [*LINES.split(head), *rest]
        return [self._places.setdefault(piece, len(self._places)) for piece in pieces if piece]

    @property
    def pieces(self) -> list[str]:
        """All pieces so far, by index."""
        return list(self._places)


class Written(NamedTuple):
    """A codec's texts by language, whether they were run, and whether they come with lookup tables."""

    texts: Mapping[str, str] = MappingProxyType({})
    proven: bool = False
    tables: bool = False


def write_code(folder: Path, languages: Mapping[str, str], codecs: Mapping[str, Written]) -> None:
    """Write the codecs' code to its file in a run's folder.

    Args:
        languages: the languages' titles, by name.
        codecs: the codecs' texts, by label.
    """
    shared = Shared()
    records = {
        label: {**written._asdict(), "texts": {name: shared.places(text) for name, text in written.texts.items()}}
        for label, written in codecs.items()
    }
    with whole_file(folder / FILE) as partial:
        kept = {"languages": dict(languages), "pieces": shared.pieces, "codecs": records}
        partial.write_text(json.dumps(kept, separators=(",", ":")), encoding="utf-8", newline="\n")


def read_code(folder: Path) -> dict[str, Any]:
    """Return the kept code of a run: `languages`, `pieces` and `codecs`, with texts as indices into `pieces`; empty
    if the run has no kept code, or its file is damaged."""
    try:
        kept = KEPT.validate_python(parsed_json(file_bytes(folder / FILE, MOST_BYTES)))
    except (OSError, ValueError, ValidationError):
        return {}
    texts = (places for codec in kept["codecs"].values() for places in codec["texts"].values())
    return kept if all(place < len(kept["pieces"]) for places in texts for place in places) else {}
