"""Recompute the figures of the catalogue's codecs that ship with the package.

    python -m tests.recorded

writes suprema.json next to the module that searches for suprema, over the domain of each encoding, and uses.json of
the mix table: how filtering, blending, resolving and upsampling affect each codec. The command takes a quarter of an
hour; figures that were recorded from the same sources are kept.
"""

import json
from collections.abc import Callable, Iterator
from dataclasses import asdict

from normalbench.bench.measures.recorded import Recorded
from normalbench.bench.measures.worst_case.recorded import SUPREMA, name_of
from normalbench.bench.measures.worst_case.search import worst_case
from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS
from normalbench.bench.tables.mix.judge import RECORDED as USED
from normalbench.bench.tables.mix.judge import judged_now
from normalbench.bench.tables.mix.table import USES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


def codecs() -> Iterator[Codec]:
    """Yield the codecs that round to nearest."""
    for encoding in ENCODINGS.values():
        for storage in STORAGES.values():
            if (codec := Codec(encoding, storage)).fits and not storage.curved:
                yield codec


def is_half(codec: Codec) -> bool:
    """Whether the domain is half of the sphere."""
    return codec.encoding.domain != "sphere"


def supremum_of(codec: Codec) -> dict[str, object]:
    worst = worst_case(codec, is_half(codec))
    return {
        "angle_deg": worst.angle_deg,
        "normal": worst.normal,
        "found_by": worst.found_by,
        "moved_deg": worst.moved_deg,
    }


def uses_of(codec: Codec) -> dict[str, object]:
    judged = judged_now(codec, list(USES), NORMAL_SETS["sphere"](64, 0), codec.encoding.domain)
    return {"uses": {use: asdict(judgement) for use, judgement in judged.items()}}


def record(where: Recorded, name: Callable[[Codec], str], figures: Callable[[Codec], dict[str, object]]) -> None:
    before = json.loads(where.file.read_text()) if where.file.exists() else {}
    rows: dict[str, dict[str, object]] = {}
    for codec in codecs():
        known, key = before.get(name(codec)), where.key(codec)
        rows[name(codec)] = known if known and known["key"] == key else {"key": key, **figures(codec)}
        # A computation that is stopped goes on.
        write(where, {**before, **rows})
    write(where, rows)


def write(where: Recorded, rows: dict[str, dict[str, object]]) -> None:
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(row)}" for name, row in rows.items())
    where.file.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8", newline="\n")


def main() -> None:
    record(SUPREMA, lambda codec: name_of(codec, is_half(codec)), supremum_of)
    record(USED, lambda codec: codec.name, uses_of)


if __name__ == "__main__":
    main()
