"""The recommended encoding for a device: `pick`'s decision, based on errors measured on the device."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

from .....encodings.catalogue import ENCODINGS
from .....encodings.codecs.codec import Codec
from .....encodings.storages.storage import STORAGES
from ...pick.answer import BEST, answered, places_of
from ...pick.sentences import degrees, left_out, rungs
from ...pick.table import READERS, TEXEL_DEG, WORTH_DB, PickOptions
from ...table import Row, Sheet
from ..agreement import time_of

# A question of `pick`: codes for every direction, the smallest mean angle first.
NEEDS, AIM = "sphere", "angle"
UNKNOWN = "not in the catalogue: its domain is not known"
# What tells questions apart.
QUESTION = ("storage", "target", "rounding")
# Of a storage that is not in the catalogue, behind all others.
MANY = 1 << 16


class Known:
    """The issue slots and length errors of the devices' codecs, which `pick` needs. They are computed on first use,
    which imports JAX and calls compilers.

    Args:
        rows: rows of all devices, one sequence for each device.
    """

    def __init__(self, rows: Iterable[Sequence[Row]]):
        codecs = (_codec(row) for part in rows for row in part)
        self._codecs = list(dict.fromkeys(codec for codec in codecs if codec and codec.fits))

    @cached_property
    def _price_rows(self) -> Mapping[str, Row]:
        from ...pick.measure import length_shares
        from ...pick.prices import Costs

        costs, lengths = Costs(self._codecs, [self.family]), length_shares(self._codecs)
        return {codec.name: costs.of(codec) | {"length_share": lengths[codec.name]} for codec in self._codecs}

    @property
    def family(self) -> str:
        """The GPU family whose issue slots are counted: the default of pick."""
        return str(PickOptions().family[0])

    def of(self, row: Row) -> Row:
        """Return a codec's issue slots and length error as columns; empty for a codec not in the catalogue."""
        codec = _codec(row)
        return self._price_rows.get(codec.name, {}) if codec else {}


def _codec(row: Row) -> Codec | None:
    """Return a row's codec; None unless its encoding and storage are in the catalogue.

    The codec rounds to nearest, because rounding affects neither cost nor length."""
    encoding, storage = ENCODINGS.get(row["encoding"]), STORAGES.get(row["storage"])
    return Codec(encoding, storage) if encoding and storage else None


def answers(rows: Sequence[Row], known: Known) -> Iterator[Sheet]:
    """Yield for each storage the recommended encoding on a device, in sentences, and the Pareto-optimal encodings.

    Args:
        rows: the device's rows of the table `devices`.
    """
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in QUESTION), []).append(row)
    for question in sorted(groups, key=lambda group: (_bytes_per_texel(group[0]), group)):
        yield _sheet(question, answered([_pick_row(row, known) for row in groups[question]]))


def _bytes_per_texel(storage: str) -> int:
    return sum(STORAGES[storage].bits) // 8 if storage in STORAGES else MANY


def _pick_row(row: Row, known: Known) -> Row:
    """Return a device's row with the columns by which `pick` ranks encodings."""
    encoding, codec = ENCODINGS.get(row["encoding"]), _codec(row)
    columns: Row = {"encoding": row["encoding"], "storage": row["storage"], "asked": row["storage"]}
    columns |= {"normals": "", "scene": "", "against": False, "beside": False, "invalid": 0, "lost_percent": 0.0}
    columns |= {"needs": NEEDS, "aim": AIM, "readers": READERS, "worth": WORTH_DB, "most_instructions": None}
    columns |= {"accept_holes": False, "accept_lengths": False, "domain": encoding.domain if encoding else NEEDS}
    columns |= {"skipped": None if encoding else UNKNOWN, "table": bool(encoding and encoding.has_tables)}
    columns |= {"angle_mean_deg": row["mean_deg"], "angle_max_deg": row["max_deg"], "angle_sup_deg": None}
    columns |= {"bits": codec.bits if codec else None, "free_bits": None, "length_share": None}
    columns |= {name: row[name] for name in ("encode_ms", "decode_ms")} | {"ms": time_of(row)}
    columns |= {"enough": TEXEL_DEG, "code_bits": None, "packed": False, "encode_slots": None, "decode_slots": None}
    return columns | {"slots": None, "slots_once": None} | known.of(row)


def _sheet(question: Sequence[str], group: Sequence[Row]) -> Sheet:
    storage, target, rounding = question
    best = next((row for row in group if BEST in places_of(row)), None)
    kept = [row for row in group if row.get("front") or row is best]
    rounding_text = f"rounded to {rounding}" if rounding == "nearest" else rounding
    title = f"{storage} in {target}, {rounding_text}: Pareto-optimal encodings"
    keys = {"storage": storage, "take": best["encoding"] if best else None}
    return Sheet(title, [_short_row(row) for row in kept], said=tuple(_sentences(storage, best, group)), keys=keys)


def _short_row(row: Row) -> Row:
    times = ("encode_ms", "decode_ms") if row["ms"] is not None else ()
    return {
        name: row.get(name)
        for name in ("encoding", "place", "bits", "angle_mean_deg", "angle_max_deg", "slots", *times)
    }


def _sentences(storage: str, best: Row | None, group: Sequence[Row]) -> Iterator[str]:
    count = _bytes_per_texel(storage)
    where = f"{storage}, {count} bytes" if count < MANY else storage
    if best is None:
        yield f"{where}: no encoding qualifies."
    else:
        yield f"{where}: take {best['encoding']}."
        errors = f"On this device its mean error is {degrees(best['angle_mean_deg'])}"
        yield f"{errors}, its largest error {degrees(best['angle_max_deg'])}. {_price_sentence(best)}"
        yield from rungs(group, best)
    yield from left_out(group)


def _price_sentence(row: Row) -> str:
    slots = f"{row['slots']:g} issue slots with {row['readers']} decoding passes" if row["slots"] is not None else ""
    if row["ms"] is None:
        return f"No times were measured on it; the encoding takes {slots}." if slots else "The cost is not known."
    times = f"It takes {row['encode_ms']:.3g} ms per megapixel to encode and {row['decode_ms']:.3g} ms to decode"
    return f"{times}, and {slots}." if slots else f"{times}."
