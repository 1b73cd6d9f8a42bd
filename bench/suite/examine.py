"""What `doctor FILE` does: says what is likely wrong with an encoding, and draws its error over the sphere."""

from __future__ import annotations

from pathlib import Path

from ...encodings.codecs.codec import Codec
from ...encodings.storages.storage import STORAGES
from ...reports.charts import charts
from ..codecs.user_encodings import examined
from ..output.errors import UsageError, tell
from ..output.writing import check_plot, save_plot, write
from ..tables.quality.sphere_maps import sphere_map

STORAGE = "rgba8"


def examine_encoding(file: Path | None, plot: Path | None, format: str, output: Path | None) -> int:
    """Write a row for each finding, and the picture if one is asked for.

    Returns:
        the exit status: 1 where something is likely wrong.

    Raises:
        UsageError: there is no file, it is not an encoding, or something cannot be written.
    """
    if file is None:
        raise UsageError("--plot draws an encoding's error: name its file")
    check_plot(plot)
    encoding, wrong, notes, is_measurable = examined(file)
    about = {"file": file.name, "encoding": encoding.name, "domain": encoding.domain}
    write([about | {"finding": line} for line in [*wrong, *notes] or ["nothing is likely wrong"]], format, output)
    if plot and is_measurable:
        found = sphere_map(Codec(encoding, STORAGES[STORAGE]))
        save_plot(plot, charts.sphere_chart({f"{encoding.name}/{STORAGE}": found.mean_deg}))
        tell(f"the error over the sphere is in {plot}")
    return int(bool(wrong))
