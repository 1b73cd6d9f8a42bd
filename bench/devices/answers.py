"""Which code to take on a device: `pick`'s decision over the device's own errors, and its times where it has any."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from ...encodings.catalogue import ENCODINGS
from ...encodings.codecs.codec import Codec
from ...encodings.storages.storage import STORAGES
from ..tables.devices.agreement import time_of
from ..tables.pick.answer import BEST, CHEAPER, RUNNER_UP, answered, cost
from ..tables.pick.sentences import degrees, left_out, more
from ..tables.pick.table import PickOptions
from ..tables.table import Row, Sheet

# A question of `pick`: codes for every direction, the smallest mean angle first.
NEEDS, AIM = "sphere", "angle"
UNKNOWN = "not in the catalogue: the normals that it is made for are not known"
# What tells questions apart.
QUESTION = ("storage", "target", "rounding")
# Of a storage that this version does not know, behind all others.
MANY = 1 << 16


def is_timed(rows: Sequence[Row]) -> bool:
    """Whether a device has times, of any codec."""
    return any(time_of(row) is not None for row in rows)


class Instructions:
    """Instructions of the encodings of devices without times, counted when they are first asked for.

    Args:
        rows: of all devices, each device's by itself.
    """

    def __init__(self, rows: Iterable[Sequence[Row]]):
        named = (row["encoding"] for part in rows if not is_timed(part) for row in part)
        self._encodings = [ENCODINGS[name] for name in dict.fromkeys(named) if name in ENCODINGS]

    @cached_property
    def _costs(self) -> Any:
        # It imports JAX and calls compilers, which takes seconds.
        from ..tables.pick.measure import Costs

        return Costs(self._encodings, self.family)

    @property
    def family(self) -> str:
        """The GPU family that they are counted for."""
        return PickOptions().family

    def of(self, name: str) -> Row:
        """The instructions of an encoding; none where this machine has no compilers."""
        return self._costs.of(ENCODINGS[name]) if name in ENCODINGS else {}


def answers(rows: Sequence[Row], instructions: Instructions) -> Iterator[Sheet]:
    """For each storage of a device the code to take, in sentences, and the codes that no other one beats.

    Args:
        rows: the device's, of the table `devices`.
    """
    # One unit for all: instructions do not compare with milliseconds.
    has_times = is_timed(rows)
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in QUESTION), []).append(row)
    for question in sorted(groups, key=lambda one: (_bytes(one[0]), one)):
        asked = [_asked(row, None if has_times else instructions.of(row["encoding"])) for row in groups[question]]
        yield _sheet(question, answered(asked), instructions.family)


def _bytes(storage: str) -> int:
    return sum(STORAGES[storage].bits) // 8 if storage in STORAGES else MANY


def _asked(row: Row, counted: Row | None) -> Row:
    """A device's row as `pick` takes them.

    Args:
        counted: instructions; None where times decide.
    """
    encoding = ENCODINGS.get(row["encoding"])
    made: Row = {"encoding": row["encoding"], "storage": row["storage"], "normals": "", "scene": ""}
    made |= {"needs": NEEDS, "aim": AIM, "domain": encoding.domain if encoding else NEEDS, "against": False}
    made |= {"skipped": None if encoding else UNKNOWN, "invalid": 0, "lost_percent": 0.0, "most_instructions": None}
    made |= {"angle_mean_deg": row["mean_deg"], "angle_max_deg": row["max_deg"], "angle_sup_deg": None}
    made |= {"bits": _bits(row), "encode_ms": row["encode_ms"], "decode_ms": row["decode_ms"], "instructions": None}
    return made | ({"ms": time_of(row)} if counted is None else counted)


def _bits(row: Row) -> int | None:
    encoding, storage = ENCODINGS.get(row["encoding"]), STORAGES.get(row["storage"])
    return Codec(encoding, storage).bits if encoding and storage else None


def _sheet(question: Sequence[str], group: Sequence[Row], family: str) -> Sheet:
    storage, target, rounding = question
    places = {place: row for row in group for place in (row.get("place") or "").split(", ") if place}
    kept = [row for row in group if row.get("front") or set((row.get("place") or "").split(", ")) & {BEST, CHEAPER}]
    title = (
        f"{storage} in {target}, rounded to {rounding}"
        if rounding == "nearest"
        else f"{storage} in {target}, {rounding}"
    )
    said = tuple(_sentences(storage, places, group, family))
    keys = {"storage": storage, "take": places[BEST]["encoding"] if BEST in places else None}
    return Sheet(f"{title}: the codes that no other one beats", [_short(row) for row in kept], said=said, keys=keys)


def _short(row: Row) -> Row:
    costs = ("encode_ms", "decode_ms") if "ms" in row else ("instructions",)
    return {name: row.get(name) for name in ("encoding", "place", "bits", "angle_mean_deg", "angle_max_deg", *costs)}


def _sentences(storage: str, places: Mapping[str, Row], group: Sequence[Row], family: str) -> Iterator[str]:
    count = _bytes(storage)
    where = f"{storage}, {count} bytes" if count < MANY else storage
    if BEST not in places:
        yield f"{where}: no code qualifies."
    else:
        best = places[BEST]
        yield f"{where}: take {best['encoding']}."
        errors = f"Its mean error on this device is {degrees(best['angle_mean_deg'])}"
        yield f"{errors}, its largest {degrees(best['angle_max_deg'])}. {_price(best, family)}"
        if RUNNER_UP in places:
            yield f"Runner-up: {_next(places[RUNNER_UP], best)}."
        if CHEAPER in places and places[CHEAPER] is not places.get(RUNNER_UP):
            yield f"Cheaper: {_next(places[CHEAPER], best)}."
    yield from left_out(group)


def _price(row: Row, family: str) -> str:
    if cost(row) is None:
        return "What it costs is not known."
    if "ms" not in row:
        return f"This device has no times; the code costs {row['instructions']:g} instructions on {family}."
    return f"It takes {row['encode_ms']:.3g} ms per megapixel to encode and {row['decode_ms']:.3g} ms to decode."


def _next(row: Row, best: Row) -> str:
    said = f"{row['encoding']}, mean error {degrees(row['angle_mean_deg'])}"
    if best["angle_mean_deg"]:
        said += f" ({more(row['angle_mean_deg'] / best['angle_mean_deg'])})"
    price = cost(row)
    unit = "ms per megapixel in all" if "ms" in row else "instructions"
    return said if price is None else f"{said}, {price:.3g} {unit}"
