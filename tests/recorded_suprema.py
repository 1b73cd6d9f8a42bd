"""Compute anew the suprema that come with the package.

    python -m tests.recorded_suprema

writes bench/measures/worst_case/suprema.json: every codec of the catalogue, rounded to nearest, over the domain of its
encoding. It takes some ten minutes; what was recorded from the same sources is kept.
"""

import json
from collections.abc import Iterator

from normalbench.bench.measures.worst_case import recorded
from normalbench.bench.measures.worst_case.search import Worst, worst_case
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


def codecs() -> Iterator[tuple[Codec, bool]]:
    """Codecs, and whether their domain is a half of the sphere."""
    for encoding in ENCODINGS.values():
        for storage in STORAGES.values():
            if (codec := Codec(encoding, storage)).fits and not storage.curved:
                yield codec, encoding.domain != "sphere"


def facts_of(codec: Codec, worst: Worst) -> dict[str, object]:
    """A supremum as the file has it."""
    facts = {"angle_deg": worst.angle_deg, "normal": worst.normal, "found_by": worst.found_by}
    return {"key": recorded.source_key(codec), **facts, "moved_deg": worst.moved_deg}


def write(rows: dict[str, dict[str, object]]) -> None:
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(row)}" for name, row in rows.items())
    recorded.FILE.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8", newline="\n")


def main() -> None:
    before = json.loads(recorded.FILE.read_text()) if recorded.FILE.exists() else {}
    rows: dict[str, dict[str, object]] = {}
    for codec, is_half in codecs():
        name = recorded.name_of(codec, is_half)
        known = before.get(name)
        is_kept = known and known["key"] == recorded.source_key(codec)
        rows[name] = known if is_kept else facts_of(codec, worst_case(codec, is_half))
        # A computation that is stopped goes on.
        write({**before, **rows})
    write(rows)


if __name__ == "__main__":
    main()
