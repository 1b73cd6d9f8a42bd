"""Files that the page's live section saves on a reader's device. Strangers submit them, so everything is checked.

A file is one JSON object in UTF-8. `FORMAT` is the version of the file format.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    StringConstraints,
    ValidationError,
    model_validator,
)

from ....encodings.codecs.files import file_bytes, parsed_json
from ....reports.page.found import plain_text
from ...ground.output.errors import UsageError
from .names import browser_name

FORMAT = 1
# Bytes of a file, codecs and facts in it, letters of a name and of a longer text, normals and milliseconds.
MOST_BYTES, MOST_CODECS, MOST_FACTS = 4 << 20, 4096, 512
NAME, TEXT = 128, 1024
MOST_NORMALS, MOST_MS, HALF_TURN_DEG = 2**31, 1e6, 180.0
# Of a fact that is a number.
LARGEST = 1e300
BOM = b"\xef\xbb\xbf"
# How far a reader's clock may be ahead.
AHEAD = timedelta(days=2)
# What is shown of a value that is wrong.
SHOWN = 40
# What rows say of their device's file.
ABOUT = ("renderer", "vendor", "browser", "made", "program", "sources")


def _plain_line(text: str) -> str:
    return " ".join(str(plain_text(text)).split())


def _utc_time(text: str) -> str:
    """Return a time as UTC text, to the second, so that sorting the texts sorts the times. Raises ValueError if the
    text is not an ISO 8601 time, or the time is in the future."""
    try:
        moment = datetime.fromisoformat(text)
        moment = moment.replace(tzinfo=moment.tzinfo or UTC).astimezone(UTC)
    except (ValueError, OverflowError):
        raise ValueError("is not a time such as 2026-11-23T15:00:00Z") from None
    # It would count as newer than every honest file.
    if moment > datetime.now(UTC) + AHEAD:
        raise ValueError("is in the future")
    return moment.strftime("%Y-%m-%dT%H:%M:%SZ")


def _checked_fact(value: Any) -> Any:
    if isinstance(value, str) and len(value) > TEXT:
        raise ValueError(f"is longer than {TEXT} characters")
    if isinstance(value, str):
        return _plain_line(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError("is neither text nor a number")
    # A whole number may have more digits than a float holds.
    if not abs(value) <= LARGEST:
        raise ValueError("is too large")
    return value


def _checked_facts(facts: dict[str, Any]) -> dict[str, Any]:
    plain = {_plain_line(name): value for name, value in facts.items()}
    if len(plain) < len(facts) or "" in plain:
        raise ValueError("has two names that look the same, or a name without visible characters")
    return plain


Text = Annotated[str, StringConstraints(max_length=TEXT), AfterValidator(_plain_line)]
Plain = Annotated[str, StringConstraints(max_length=NAME), AfterValidator(_plain_line)]
Name = Annotated[str, StringConstraints(max_length=NAME), AfterValidator(_plain_line), StringConstraints(min_length=1)]
Time = Annotated[str, StringConstraints(max_length=NAME), AfterValidator(_utc_time)]
Count = Annotated[int, Field(ge=0, le=MOST_NORMALS)]
Degrees = Annotated[FiniteFloat, Field(ge=0, le=HALF_TURN_DEG)]
# Of a pass that takes less than the clock tells, what is left may be below 0.
Milliseconds = Annotated[FiniteFloat, Field(ge=-MOST_MS, le=MOST_MS)] | None
FactName = Annotated[str, StringConstraints(max_length=NAME)]
FactValue = Annotated[Any, AfterValidator(_checked_fact)]
# A later version may say more.
STRICT = ConfigDict(strict=True, extra="ignore", frozen=True)


class CodecRow(BaseModel):
    """The results of one codec on a device; see the table's columns."""

    model_config = STRICT

    encoding: Name
    storage: Name
    rounding: Name
    target: Name
    normals: Annotated[int, Field(ge=1, le=MOST_NORMALS)]
    equal: Count
    one_step: Count
    further: Count
    mean_deg: Degrees
    max_deg: Degrees
    run_mean_deg: Degrees
    encode_ms: Milliseconds
    decode_ms: Milliseconds
    timer: Text | None

    @model_validator(mode="after")
    def adds_up(self) -> CodecRow:
        """Return the row unchanged. Raises ValueError if the counts do not add up to the number of normals."""
        total = self.equal + self.one_step + self.further
        if total != self.normals:
            raise ValueError(f"equal, one_step and further add up to {total}; normals is {self.normals}")
        return self

    @property
    def key(self) -> tuple[str, str, str, str]:
        """The fields that identify a row: no two rows of a file have the same."""
        return self.encoding, self.storage, self.rounding, self.target


class DeviceFile(BaseModel):
    """The contents of a device file.

    Attributes:
        renderer, vendor, browser: the GPU and the browser as the browser reports them; plain text.
        made: time at which the file was saved, in UTC.
        program, sources: version of the page, and fingerprint of the run that it shows.
        codecs, facts: the measurements.
    """

    model_config = STRICT

    normalbench_device: int
    renderer: Text
    vendor: Text
    browser: Text
    made: Time
    program: Plain
    sources: Plain
    codecs: Annotated[list[CodecRow], Field(min_length=1, max_length=MOST_CODECS)]
    facts: Annotated[dict[FactName, FactValue], Field(max_length=MOST_FACTS), AfterValidator(_checked_facts)]

    @model_validator(mode="after")
    def has_each_codec_once(self) -> DeviceFile:
        """Return the file unchanged. Raises ValueError if two rows have the same codec and target."""
        key, count = Counter(row.key for row in self.codecs).most_common(1)[0]
        if count > 1:
            raise ValueError(f"codecs lists {' '.join(key)} twice")
        return self

    @cached_property
    def digest(self) -> str:
        """A fingerprint of the file's contents: 16 hexadecimal digits."""
        return hashlib.sha256(self.model_dump_json().encode()).hexdigest()[:16]

    @property
    def identity(self) -> tuple[str, str]:
        """The GPU as the browser reports it, and the browser's name with its major version."""
        return self.renderer, browser_name(self.browser)


@dataclass(frozen=True)
class Read:
    """The contents of a device file, and its path."""

    path: Path
    file: DeviceFile


def read_device_file(path: Path) -> Read:
    """Return the checked contents of a device file, with its path.

    Raises:
        UsageError: the file cannot be read or is not a device file; the message names the file and the place in
            it.
    """
    try:
        return Read(path, _checked_file(_parsed(file_bytes(path, MOST_BYTES))))
    except (OSError, ValueError) as error:
        raise UsageError(f"{path}: {error}") from None


def file_of_rows(codecs: Sequence[Mapping[str, Any]], facts: Mapping[str, Any]) -> DeviceFile:
    """Return the device file from which the rows of a device came; its browser has only the short name.

    Raises:
        ValueError: the rows do not form a valid device file.
    """
    about = {name: codecs[0].get(name) or "" for name in ABOUT} if codecs else {}
    rows = [{**row, "equal": row["normals"] - row["one_step"] - row["further"]} for row in codecs]
    return _checked_file({"normalbench_device": FORMAT, **about, "codecs": rows, "facts": dict(facts)})


def _parsed(data: bytes) -> Any:
    """Return the value of JSON data. Raises ValueError if the data is not JSON, repeats a name or contains NaN."""
    if data.startswith(BOM):
        raise ValueError("it starts with a byte-order mark; save it as UTF-8 without one")
    if not data.strip():
        raise ValueError("it is empty")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ValueError(f"byte {error.start + 1}: not UTF-8 text") from None
    return parsed_json(text, _object_without_repeats)


def _object_without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    entries = dict(pairs)
    if len(entries) < len(pairs):
        twice = Counter(name for name, _ in pairs).most_common(1)[0][0]
        raise ValueError(f"{_short_text(twice)} is given twice in one object")
    return entries


def _checked_file(content: Any) -> DeviceFile:
    """Return parsed JSON as a checked device file. Raises ValueError if the contents or the version is wrong."""
    if not isinstance(content, dict) or "normalbench_device" not in content:
        raise ValueError('not a device file; use one that "Save this device" saved in the live section of a page')
    version = content["normalbench_device"]
    if type(version) is not int or version != FORMAT:
        raise ValueError(
            f"normalbench_device: {_short_text(version)} is not supported; this program reads version {FORMAT}"
        )
    try:
        return DeviceFile.model_validate(content)
    except ValidationError as error:
        raise ValueError(_first_fault(error)) from None


# What pydantic puts behind a name that is wrong itself.
KEY = "[key]"
# By pydantic's names of what is wrong.
WRONG = {
    "string_type": "is not text",
    "string_unicode": "is not text",
    "list_type": "is not a list",
    "dict_type": "is not an object",
    "model_type": "is not an object",
    "int_type": "is not a whole number",
    "float_type": "is not a number",
    "finite_number": "is too large",
    "greater_than_equal": "is less than {ge}",
    "less_than_equal": "is more than {le}",
    "string_too_long": "is longer than {max_length} characters",
    "string_too_short": "has no visible characters",
}


def _first_fault(error: ValidationError) -> str:
    """Return a message on the first error of a validation: its place in the file, the value and what is wrong."""
    first = error.errors(include_url=False)[0]
    names = [f"row {part + 1}" if isinstance(part, int) else _short_text(part) for part in first["loc"] if part != KEY]
    where, context = ", ".join(names), first.get("ctx", {})
    if first["type"] == "missing":
        return f"{where} is missing"
    if first["type"] == "too_long":
        return f"{where}: more than {context['max_length']} entries"
    if first["type"] == "too_short":
        return f"{where}: no entries"
    if "error" in context and isinstance(first["input"], dict):
        return ": ".join(filter(None, (where, str(context["error"]))))
    reason = context.get("error") or WRONG.get(first["type"], first["msg"]).format(**context)
    return f"{where}: {_short_text(first['input'])} {reason}"


def _short_text(value: Any) -> str:
    """Return a value as text, shortened to SHOWN characters; "a number" if it has more digits than Python prints."""
    try:
        text = value if isinstance(value, str) else repr(value)
    except ValueError:
        return "a number"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}…"
