"""The header of a codec's source file: what the file is, its figures and how it was verified."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib.metadata import version
from typing import Any

from ...encodings.codecs.codec import Codec
from ..ground.options.counts import DEFAULT_COUNT
from ..shaders.code.emit import LANGUAGES
from ..shaders.code.files import Code
from ..shaders.code.kinds.table import kind_of
from ..shaders.code.tables import table_lines
from ..shaders.code.twin import has_twin
from ..subjects.normals.normal_sets import NORMAL_SETS
from ..tables.cost import measure as cost
from ..tables.quality import measure as quality

# Figures that differ by less are the same.
SAME = 1e-3
STAGE, FAMILY, FAMILY_TITLE = "fragment", "navi21", "AMD RDNA 2 (navi21, RADV)"


def head(code: Code, codec: Any, command: str, verified: str, figure_lines: Sequence[str]) -> list[str]:
    """Return the paragraphs above a file's functions.

    Args:
        code: the contents of the file.
        codec: the measured codec; for a hemisphere other than z >= 0, its axes differ from the file's.
        command: the command that wrote the file.
        verified: how the file's results compare with the catalogue's.
        figure_lines: the codec's figures (see `figures`).
    """
    encoding, kind = codec.encoding, kind_of(codec)
    compared = verified.replace(" are equal, bit", " are the catalogue's, bit", 1) if kind.is_ours(codec) else verified
    names = ", ".join(f"{code.prefix}_{name}" for name in ("encode", "pack", "unpack", "decode"))
    return [
        f"{codec.name} in {LANGUAGES[code.language].title}: {names}; for a render target, {code.prefix}_to_target and "
        f"{code.prefix}_from_target. {LANGUAGES[code.language].advice}",
        "",
        f"Encoding: {encoding.title}. Source: {encoding.citation}.",
        f"Storage: {codec.storage.title}, {codec.bits} bits, rounding: {rounding_of(codec)}. "
        f"{kind.plural.capitalize()}: {kind.held(codec)}.",
        *figure_lines,
        *table_lines(code.interface.tables),
        f"Verified: {compared}.",
        f"Made by normalbench {version('normalbench')}: {command}",
        _licence(codec),
    ]


def rounding_of(codec: Any) -> str:
    """Return the rounding of a codec of any kind; "nearest" if the codec does not define one."""
    return getattr(codec, "rounding", "nearest")


def _licence(codec: Any) -> str:
    licence = "MIT License, Copyright (c) 2026 The normalbench authors"
    return (
        f"{licence}."
        if kind_of(codec).is_ours(codec)
        else f"Encode and decode are yours. The other functions: {licence}."
    )


def figures(codec: Codec) -> list[str]:
    """Measure a codec and return paragraphs on its errors and its instruction counts."""
    return [*_errors(codec), *_instructions(codec)]


def _errors(codec: Codec) -> Iterator[str]:
    domain = codec.encoding.domain
    if domain not in NORMAL_SETS:
        yield "Errors: not given, because they depend on the view; `normalbench quality` measures them on a scene."
        return
    backend = "jax" if has_twin(codec.encoding) else "glsl"
    chosen = NORMAL_SETS[domain](DEFAULT_COUNT, 0)
    row = quality.measure(quality.QualityCase(codec, chosen, backend, worst_case=codec.encoding.is_exact))
    if row["skipped"]:
        yield f"Errors: not measured here: {row['skipped']}."
        return
    yield (
        f"Error on {row['count']} uniform directions: mean {row['angle_mean_deg']:.4g} degrees, "
        f"RMS {row['angle_rms_deg']:.4g}; {_largest(row['angle_sup_deg'], row['angle_max_deg'])}."
    )


def _largest(supremum: float | None, met: float) -> str:
    """Return text with the supremum in degrees, followed by the largest sampled error if that is larger; with the
    largest sampled error alone if `supremum` is None."""
    if supremum is None:
        return f"largest sampled error {met:.4g} degrees"
    text = f"supremum {supremum:.4g} degrees"
    return text + (f"; largest sampled error in float32 {met:.4g}" if met > supremum * (1 + SAME) else "")


def _instructions(codec: Codec) -> Iterator[str]:
    rows = cost.counted(cost.cases([codec.encoding], (), cost.OPERATIONS), FAMILY, STAGE)
    counts: Sequence[Any] = [row["instructions"] for row in rows.values()]
    if len(counts) != len(cost.OPERATIONS):
        yield "Instructions: not counted here; `normalbench doctor` shows what is missing."
        return
    loops = ", each loop counted once" if any(row["loops"] for row in rows.values()) else ""
    encode, decode = (rows[codec.encoding.name, operation]["instructions"] for operation in cost.OPERATIONS)
    yield f"Instructions: {encode} to encode and {decode} to decode, without packing, on {FAMILY_TITLE}{loops}."
