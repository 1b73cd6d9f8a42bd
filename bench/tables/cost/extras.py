"""Costs that the page shows besides the rows: cost against error, disassemblies and differences in ranking."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import accumulate
from pathlib import Path
from typing import Any

from ....encodings.catalogue import ENCODINGS
from ....encodings.codecs.codec import Codec
from ....encodings.codecs.encoding import Encoding
from ....encodings.codecs.variants import MARK
from ....encodings.storages.rules import storage_of
from ....encodings.storages.storage import Storage
from ....reports.charts.looks import as_text
from ....reports.charts.pareto import Panel, Point
from ....reports.page.codec_key import CodecKey
from ....reports.page.found import Front, Listing, plain_text
from ....reports.page.verdict import BACKENDS, LEADING, is_number
from ...ground.options.gpu_families import FAMILIES, usual_stage
from ...ground.output.writing import files_of
from ...ground.user_files import CHAIN
from ..quality.table import TABLE as QUALITY
from ..render.table import TABLE as RENDER
from ..table import Row
from .codec_costs import Costs, LeftOutError, Where
from .measure import OPERATIONS
from .table import TABLE

# Of disassemblies: which kernels, and how many bytes of them a page holds.
STAGE, LISTED = "fragment", 2**20
# The folder of the encodings' GLSL, among those of the GPU families.
SOURCES = "source"


def extras(folder: Path, tables: Mapping[str, Sequence[Row]], remarks: list[str]) -> Mapping[str, Any]:
    """Return the charts of cost against error as `fronts`, and the disassemblies as `listings`.

    Args:
        folder: the folder of the run.
        tables: the run's rows by table.
        remarks: receives remarks on codecs that the charts leave out.
    """
    kernels, family = folder / TABLE.files["disassembly"], usual_family(tables)
    return {
        "fronts": list(_fronts(tables, family, remarks)),
        "listings": _listings(kernels, family),
    }


def _fronts(tables: Mapping[str, Sequence[Row]], usual: str, remarks: list[str]) -> Iterator[Front]:
    """Yield a front for the first set of normals and a front for the first scene: PSNR against the instructions of
    each GPU family. A front without points is left out; remarks name the codecs that the fronts leave out, and
    why."""
    known = _counted(tables)
    families = dict.fromkeys(row["family"] for row in known)
    costs = {family: [row for row in known if row["family"] == family] for family in families}
    lost: dict[str, dict[str, None]] = {}
    for table, by, what in ((QUALITY.name, "normals", "normals of"), (RENDER.name, "scene", "the image of")):
        rows = [row for row in tables.get(table, ()) if row.get("encoding")]
        where = next((str(row.get(by)) for row in rows if is_number(row.get(LEADING))), "")
        errors = _errors([row for row in rows if str(row.get(by)) == where], lost)
        panels = list(_panels(costs, errors, usual, lost))
        if panels:
            yield Front(f"PSNR of {what} {as_text(where)}", panels)
    if costs:
        remarks += [f"Not in the charts of cost, because {why}: {', '.join(names)}." for why, names in lost.items()]


def _errors(rows: Sequence[Row], lost: dict[str, dict[str, None]]) -> dict[Codec, float]:
    """Return each codec's PSNR in decibels; codecs that cannot be drawn are added to `lost`, grouped by reason."""
    errors: dict[Codec, float] = {}
    for key, row in _row_of_each(rows).items():
        codec = _codec(row)
        if not is_number(row.get(LEADING)):
            why = f"its error is not known ({row.get('skipped') or 'it was not measured'})"
        elif not math.isfinite(row[LEADING]):
            why = "its error is 0"
        elif not codec:
            why = "its storage is not known"
        else:
            errors[codec] = row[LEADING]
            continue
        lost.setdefault(why, {})[key.label] = None
    return errors


def _row_of_each(rows: Sequence[Row]) -> dict[CodecKey, Row]:
    """Return one row for each codec: rows with a PSNR come first, then JAX before GLSL before other backends."""
    order = list(dict.fromkeys([*BACKENDS, *(row.get("backend", "jax") for row in rows)]))
    ranks: dict[CodecKey, tuple[bool, int]] = {}
    by_codec: dict[CodecKey, Row] = {}
    for row in rows:
        key, rank = CodecKey.of(row), (not is_number(row.get(LEADING)), order.index(row.get("backend", "jax")))
        if rank <= ranks.get(key, rank):
            ranks[key], by_codec[key] = rank, row
    return by_codec


def _counted(tables: Mapping[str, Sequence[Row]]) -> list[Row]:
    """Return the rows with instruction counts at their family's usual stage: fragment shaders if supported."""
    rows = [r for r in tables.get(TABLE.name, ()) if r.get("family") and is_number(r.get("instructions"))]
    return [row for row in rows if row.get("stage") == usual_stage(str(row["family"]))]


def usual_family(tables: Mapping[str, Sequence[Row]]) -> str:
    """Return the GPU family that the page shows first: of the first vendor in the rows, the last family; empty if no
    fragment shader was counted."""
    families = list(dict.fromkeys(str(row["family"]) for row in _counted(tables) if row["stage"] == STAGE))
    vendor_of = {name: FAMILIES[name].vendor if name in FAMILIES else "" for name in families}
    return [name for name in families if vendor_of[name] == vendor_of[families[0]]][-1] if families else ""


def _panels(
    costs: Mapping[str, Sequence[Row]], errors: Mapping[Codec, float], usual: str, lost: dict[str, dict[str, None]]
) -> Iterator[Panel]:
    """Yield two panels for each GPU family, instructions to encode and to decode, except panels without points.
    Codecs of unknown cost are added to `lost`, grouped by reason."""
    for family, rows in costs.items():
        machine = f"{FAMILIES[family].title} ({family})" if family in FAMILIES else as_text(family)
        for operation in OPERATIONS:
            points = list(_points(rows, operation, errors, lost))
            if points:
                yield Panel(operation, points, machine, is_usual=family == usual)


def _points(
    costs: Sequence[Row], operation: str, errors: Mapping[Codec, float], lost: dict[str, dict[str, None]]
) -> Iterator[Point]:
    """Yield a point for each codec whose cost is known; other codecs are added to `lost`, grouped by reason."""
    known, where = Costs(costs), Where("isa", costs[-1].get("family"), costs[-1].get("stage"))
    for codec, error in errors.items():
        label = CodecKey(codec.encoding.name, codec.storage.name, codec.rounding).label
        try:
            total = known.of(codec, where, operation, "instructions")
        except LeftOutError as reason:
            lost.setdefault(str(reason), {})[label] = None
            continue
        name = as_text(codec.encoding.name)
        yield Point(name, total.cost, error, codec.bits, is_starred=total.branches, codec=label)


def _codec(row: Row) -> Codec | None:
    """Return the codec of a row, for its cost and its bits; None if the storage or the encoding is not known."""
    try:
        storage = storage_of(str(row.get("storage")))
    except ValueError:
        return None
    encoding = _encoding(row, storage) if storage else None
    return Codec(encoding, storage, str(row.get("rounding"))) if encoding and storage else None


def _encoding(row: Row, storage: Storage) -> Encoding | None:
    """Return the encoding of a row; None for a user's encoding whose bits do not fill channels of the storage.

    The report does not read the file of a user's encoding. The number of components is derived from the bits: apart
    from the name, the cost depends on nothing else."""
    name = str(row.get("encoding"))
    # octahedral:axis=y has as many numbers as octahedral, and a chain as many as its last encoding.
    if base := ENCODINGS.get(name.rpartition(CHAIN)[2].partition(MARK)[0]):
        return base if base.name == name else replace(base, name=name)
    sums, bits = list(accumulate(storage.bits)), row.get("bits", row.get("normal_bits"))
    if bits not in sums:
        return None
    return replace(ENCODINGS["xyz"], name=name, components=sums.index(bits) + 1)


def _kernels(folder: Path, family: str) -> Mapping[str, Path]:
    """Return the paths of the files in a GPU family's subfolder, by file name; empty if there is no such subfolder."""
    known = {path.name: path for path in folder.iterdir()} if folder.is_dir() else {}
    return files_of(known[family]) if family in known else {}


def _listings(folder: Path, family: str) -> dict[str, Listing]:
    """Return the disassemblies of a GPU family's kernels at its usual stage, by title, each with its encoding's GLSL.
    Kernels beyond LISTED characters in total are left out."""
    sources = _kernels(folder, SOURCES)
    listed, size = {}, 0
    for name, path in sorted(_kernels(folder, family).items()):
        if not name.startswith(STAGE):
            continue
        # "fragment-octahedral-encode" is of "octahedral.glsl".
        source = sources.get(f"{path.stem.removeprefix(f'{STAGE}-').rpartition('-')[0]}.glsl")
        listing = Listing(_plain_file_text(path), _plain_file_text(source) if source else "")
        size += len(listing.text) + len(listing.source)
        if size > LISTED:
            break
        listed[f"{family}, {plain_text(path.stem)}"] = listing
    return listed


def _plain_file_text(path: Path) -> str:
    text = path.read_text(encoding="utf-8", errors="replace")
    return "\n".join(map(str, map(plain_text, text.expandtabs().splitlines())))
