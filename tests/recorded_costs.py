"""Recount the encoding costs that machines without compilers use.

    python -m tests.recorded_costs

writes bench/tables/cost/recorded.json: every encoding and packing of the catalogue, on the GPU families that `pick`
uses.
"""

import json

from normalbench.bench.ground.options.gpu_families import usual_stage
from normalbench.bench.tables.cost import measure, recorded
from normalbench.bench.tables.pick.measure import SURVEYED
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.defines.packings import packing_of


def cases():
    """Return every operation of each encoding, and of each packing that fits an encoding."""
    packed = [storage for storage in STORAGES.values() if storage.is_packed]
    codecs = [codec for encoding in ENCODINGS.values() for store in packed if (codec := Codec(encoding, store)).fits]
    packings = {packing.name: packing for packing in map(packing_of, codecs)}
    return measure.cases(ENCODINGS.values(), packings.values(), measure.OPERATIONS)


def counted(chosen, family):
    """Return the counts of this machine's compilers for the chosen operations, in the form of the file."""
    stage = usual_stage(family)
    rows = measure.counted(chosen, family, stage)
    assert rows and not any("recorded_by" in row for row in rows.values()), f"no compiler for {family}"
    counts = {
        case.name: [row[column] for column in recorded.COLUMNS]
        for case in chosen
        if (row := rows.get((case.encoding.name if case.encoding else case.storage, case.operation)))
    }
    first = next(iter(rows.values()))
    return {"stage": stage, "by": f"{first['driver']}, {first['compiler']}", "counts": counts}


def main():
    chosen = cases()
    sources = {case.name: recorded.source_key(case, "fragment") for case in chosen}
    families = {family: counted(chosen, family) for family in SURVEYED}
    lines = ",\n".join(f"{json.dumps(family)}: {json.dumps(about)}" for family, about in families.items())
    text = f'{{"sources": {json.dumps(sources)},\n"families": {{\n{lines}\n}}}}\n'
    recorded.FILE.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
