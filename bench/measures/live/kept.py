"""A run's codecs for the laboratory on its page: a file for each codec, checked when it is read because people may
edit it."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError, with_config
from typing_extensions import TypedDict

from ....encodings.codecs.codec import Codec
from ....encodings.codecs.files import file_bytes, parsed_json
from ....gbuffer.gl.device import NoDeviceError
from ....gbuffer.gl.shader import ShaderError
from ...ground.output.writing import files_of, whole_file
from . import checks
from .programs import MOST_TABLES, NotLiveError, Record, program

# Of a file: GLSL, and look-up tables as base64.
MOST_BYTES = 2**18
STRICT = ConfigDict(strict=True, extra="forbid")
Text = Annotated[str, Field(max_length=MOST_BYTES)]
Name = Annotated[str, Field(max_length=200)]
Number = Annotated[int, Field(ge=0, lt=2**32)]
Base64 = Annotated[str, Field(max_length=2**14, pattern=r"^[A-Za-z0-9+/]*=*$")]
Degrees = Annotated[float, Field(ge=0, le=180)]


@with_config(STRICT)
class Channel(TypedDict):
    """The position of one of a code's numbers in the texel."""

    kind: Literal["unorm", "snorm", "float"]
    bits: Annotated[int, Field(ge=1, le=32)]
    first: Annotated[int, Field(ge=0, lt=128)]
    integer: Number


@with_config(STRICT)
class LookUpRecord(TypedDict):
    """A look-up table, float32 in base64."""

    width: Annotated[int, Field(ge=1, le=4096)]
    height: Annotated[int, Field(ge=1, le=4096)]
    channels: Literal[1, 2, 4]
    data: Annotated[str, Field(max_length=2 * MOST_TABLES, pattern=r"^[A-Za-z0-9+/]*=*$")]


@with_config(STRICT)
class Checks(TypedDict):
    """Checksums of a codec's expected codes, as `checks.checks` returns them."""

    normals: Number
    groups: Base64
    numbers: Base64
    sample: Base64
    mean_deg: Degrees
    max_deg: Degrees


@with_config(STRICT)
class Kept(TypedDict):
    """A codec as `programs.program` makes it."""

    encoding: Name
    storage: Name
    rounding: Name
    title: Name
    target: Name
    domain: Literal["sphere", "hemisphere", "view"]
    source: Text
    text: Text
    bits: Number
    format: Number
    size: Literal[2, 3, 4]
    words: Literal[1, 2, 4]
    sign_bits: Literal[0, 1]
    bytes: Annotated[int, Field(ge=0, le=4)]
    takes_view: bool
    channels: Annotated[list[Channel], Field(min_length=1, max_length=4)]
    tables: dict[Name, LookUpRecord]
    checks: Checks | None


KEPT: TypeAdapter[Any] = TypeAdapter(Kept)


def file_name(codec: Codec) -> str:
    """Return the name of a codec's JSON file: the codec's name with `-` for slashes, spaces and colons."""
    return codec.name.replace("/", "-").replace(" ", "-").replace(":", "-") + ".json"


def write_live(codecs: Iterable[Codec], folder: Path) -> None:
    """Write a JSON file for each codec to a folder; if browsers cannot run the codec, the file gives the reason.
    Raises UsageError if a file cannot be written."""
    for codec in dict.fromkeys(codecs):
        try:
            record = {**program(codec), "checks": _checks_or_none(codec)}
        except NotLiveError as error:
            record = {"encoding": codec.encoding.name, "storage": codec.storage.name, "left_out": str(error)}
        with whole_file(folder / file_name(codec)) as partial:
            partial.write_text(json.dumps(record), encoding="utf-8", newline="\n")


def _checks_or_none(codec: Codec) -> Record | None:
    """Return the checksums of a codec's expected codes; None if the emulation cannot compute them."""
    try:
        return checks.checks(codec)
    except (NoDeviceError, ShaderError):
        return None


def _current_record(record: Record) -> Record:
    """Return a record, with its checks set to None if they do not belong to the normals that the page makes."""
    kept_checks = record["checks"]
    is_whole = kept_checks and checks.is_whole(kept_checks, record["domain"], len(record["channels"]))
    return record if is_whole else {**record, "checks": None}


def read_live(folder: Path) -> tuple[list[Record], dict[str, str]]:
    """Return the records of the codecs in a run's folder, and the reasons for leaving out others, by the codec's name
    or, for a damaged file, by the file's name."""
    records, left_out = [], {}
    for name, path in sorted(files_of(folder).items()):
        if path.suffix != ".json":
            continue
        try:
            record = parsed_json(file_bytes(path, MOST_BYTES))
            if isinstance(record, dict) and isinstance(record.get("left_out"), str):
                left_out[f"{record.get('encoding')} {record.get('storage')}"] = record["left_out"]
            else:
                records.append(_current_record(KEPT.validate_python(record)))
        except (OSError, ValueError, ValidationError):
            left_out[name] = "its file is damaged"
    return records, left_out
