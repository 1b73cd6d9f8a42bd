"""Measurement and display of the maps table."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ....encodings.codecs.encoding import Encoding
from ...ground.choose import choose
from ...ground.machine.devices import require_device, require_jax
from ...ground.options.counts import DEFAULT_COUNT
from ...ground.options.targets import what_is_left
from ...ground.options.words import Given, Names
from ...ground.output.errors import MissingError, UsageError, leave_out
from ...ground.output.writing import check_folder
from ...measures.metrics import published
from ...subjects.codecs.encoding_names import encodings_named
from ...subjects.codecs.names import check_twin
from ...subjects.normals.normal_names import normal_sets_named
from ...subjects.normals.normal_sets import NormalSet
from ..charts import having
from ..table import Measured, Row, Sheet, Step, Work, each
from . import measure, pictures
from .charts import charts
from .formats import FORMATS, SWIZZLES, BlockFormat, swizzles_of
from .measure import MapCase
from .order import group_of, in_order
from .sets import MAPS
from .table import MapsOptions, MapsOutputs


def cases(options: MapsOptions) -> list[MapCase]:
    """Return one case for each row; combinations that do not fit are named on standard error.

    Raises:
        UsageError: unknown names, a file that cannot be read, no image, or no combination that fits.
        MissingError: a requested encoder is not installed, or there is no OpenGL device to decode with.
    """
    blocks, asked = _blocks(options.block), choose("swizzle", options.swizzle, SWIZZLES) if options.swizzle else []
    decoders = choose("decoder", options.decoder, {name: name for name in measure.DECODERS})
    encodings = encodings_named(options.encoding)
    require_jax()
    if decoders == ["device"]:
        require_device()
    complaints, no_room = list[str](), list[str]()
    fitting = [
        (encoding, block, swizzle)
        for encoding in encodings
        if _is_possible(encoding, complaints)
        for block in blocks
        for swizzle in _swizzles(encoding, block, asked, no_room)
    ]
    # Where all formats are asked for, those with room for a code are meant.
    complaints += [] if fitting and "all" in options.block else no_room
    sets = _images(options, any(encoding.domain == "view" for encoding in encodings))
    left = what_is_left(fitting, complaints)
    return [MapCase(*parts, normals, decoder) for normals in sets for parts in left for decoder in decoders]


def _blocks(names: Names) -> list[BlockFormat]:
    """Return the requested formats. With "all", formats whose encoder is not installed are left out and named on
    standard error. Raises MissingError if such a format is requested by name, or no other compressed format is
    left."""
    chosen = choose("block format", names, FORMATS)
    missing = {block.name: why for block in chosen if (why := block.encoder.missing)}
    left = [block for block in chosen if block.name not in missing]
    if missing and not ("all" in names and any(block.is_compressed for block in left)):
        raise MissingError("; ".join(f"{name}: {why}" for name, why in missing.items()))
    for name, why in missing.items():
        leave_out(f"{name}: {why}")
    return left


def _is_possible(encoding: Encoding, complaints: list[str]) -> bool:
    """Whether an encoding survives compression: it needs two components or more, no sign bit, and no component that
    must be exact. If it does not survive, the reason is added to `complaints`."""
    check_twin(encoding)
    why = ""
    if encoding.sign_bits:
        why = "the sign bit has no channel in a normal map"
    elif encoding.components == 1 or any(map(encoding.levels_of, range(encoding.components))):
        why = "compression changes numbers slightly, and this encoding needs them exact"
    if why:
        complaints.append(f"{encoding.name}: {why}")
    return not why


def _swizzles(encoding: Encoding, block: BlockFormat, asked: list[Any], complaints: list[str]) -> list[Any]:
    swizzles = swizzles_of(block, encoding.components, asked)
    if not swizzles and block.channels < encoding.components:
        complaints.append(
            f"{encoding.name}: {encoding.components} components, but {block.title} has {block.channels} channels"
        )
    elif not swizzles:
        names = ", ".join(swizzle.name for swizzle in asked)
        complaints.append(f"{encoding.name} in {block.title}: {encoding.components} components do not fit in {names}")
    return swizzles


def _images(options: MapsOptions, needs_rays: bool) -> list[NormalSet]:
    """Return the sets of normals that --normals names. Raises UsageError if a set is not an image."""
    words = tuple(
        Given(word, MAPS[word]()) if isinstance(word, str) and word in MAPS else word for word in options.normals
    )
    sets = normal_sets_named(words, DEFAULT_COUNT, 0, options.reading, needs_rays)
    others = [normals.name for normals in sets if not normals.shape]
    if others:
        known = ", ".join((*MAPS, published.NORMALS))
        raise UsageError(f"--normals {', '.join(others)}: not an image; use {known}, or an image file")
    return sets


def _steps(options: MapsOptions, outputs: MapsOutputs) -> list[Step]:
    chosen = cases(options)
    if outputs.images:
        check_folder(outputs.images)
    return [Step(_key(case), case, case.name) for case in chosen]


def _key(case: MapCase) -> Row:
    key: Row = {"encoding": case.encoding.name, "block": case.block.name, "swizzle": case.swizzle.name}
    return key | {"normals": case.normal_set.name, "decoder": case.decoder, "encoder": case.block.encoder.name}


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence for each set of normals with the best encoding in each format, beginning with those of PCs and
    consoles."""
    known = having(rows, "angle_rms_deg")
    for normals in dict.fromkeys(row["normals"] for row in known):
        part = [row for row in known if row["normals"] == normals]
        best: dict[str, Row] = {}
        for row in sorted(part, key=lambda row: (not row["block"].startswith("bc"), row["angle_mean_deg"])):
            best.setdefault(row["block"], row)
        first, *others = best.values()
        rest = "".join(f"; {_in_format(row)} has {row['angle_mean_deg']:.2g}°" for row in others)
        kind = "BC format" if len(best) > 1 and first["block"].startswith("bc") else "format"
        mean = f"mean error {first['angle_mean_deg']:.2g}°"
        yield f"On {normals}, {_in_format(first)} is the most accurate {kind} ({mean}{rest})."


def _in_format(row: Row) -> str:
    is_compressed = FORMATS[row["block"]].is_compressed
    return f"{row['encoding']} in {row['block']}" if is_compressed else f"uncompressed {row['encoding']}"


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    names = ("encoding", "block", "swizzle", "bits_per_texel", "angle_mean_deg", "angle_rms_deg", "angle_p99_deg")
    names += ("angle_max_deg", "psnr_db")
    known = [row for row in rows if row["angle_rms_deg"] is not None]
    for normals, decoder in dict.fromkeys(map(group_of, rows)):
        part = [row for row in known if group_of(row) == (normals, decoder)]
        if part:
            shown = [{name: row[name] for name in names} for row in part]
            yield Sheet(f"{normals}, block-compressed, decoded by {decoder}", shown, keys={"normals": normals})


def _write(done: Measured, _: Any) -> None:
    if done.outputs.images:
        pictures.write([step.case for step in done.steps], done.outputs.images)


def _missing() -> str:
    """Return the reason why a run leaves the table out if no encoder is installed; empty otherwise."""
    compressed = [block for block in FORMATS.values() if block.is_compressed]
    if all(block.encoder.missing for block in compressed):
        return "compressed normal maps require encoders; run: pip install normalbench[maps]"
    return ""


WORK = Work(
    steps=_steps,
    measure=each(measure.measure),
    finish=in_order,
    verdict=_verdict,
    summary=_summary,
    write=_write,
    charts=charts,
    missing=_missing,
    is_timed=lambda _: True,
)
