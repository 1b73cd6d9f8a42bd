"""Pictures of normal maps after block compression."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ....reports.charts import pictures
from ...ground.output.writing import whole_file
from .measure import UNMEASURABLE, Clock, MapCase, bands, through

# Of the pictures of a codec those that a code in channels of its own does not need.
KINDS = ("decoded", "error")


def stem(case: MapCase) -> str:
    """Return the start of the names of a case's picture files, without the kind of picture."""
    parts = (case.normal_set.name, case.encoding.name, case.block.name, case.swizzle.name, case.decoder)
    return "-".join(parts).replace("/", "_in_")


def write(cases: Iterable[MapCase], folder: Path) -> None:
    """Write pictures of the decoded normals and of their error, multiplied by `pictures.GAIN`, for each case that can
    be measured here. Raises OSError."""
    for case in cases:
        try:
            images = _case_pictures(case)
        except UNMEASURABLE:
            continue
        for kind in KINDS:
            with whole_file(folder / f"{stem(case)}-{kind}.png") as partial:
                pictures.write_png(partial, images[kind])


def _case_pictures(case: MapCase) -> dict[str, np.ndarray]:
    parts = list(bands(case.normal_set))
    decoded = np.concatenate([through(case, band, Clock()) for band in parts])
    n = np.concatenate([band.n[: band.real[0], : band.real[1]] for band in parts])
    covered = np.concatenate([band.covered for band in parts])
    return pictures.codec_pictures(n, np.zeros_like(n), decoded, covered)
