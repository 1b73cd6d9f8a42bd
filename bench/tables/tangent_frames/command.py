"""What `frames` does."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ....encodings.catalogue import FRAME_ENCODINGS
from ....encodings.codecs.frame_codec import FrameCodec
from ....encodings.storages.storage import FRAME_STORAGES
from ...options.command_options import FramesOptions
from ...options.counts import check_seed, checked_count
from ...output.errors import pick
from ...output.progress import progress
from ...output.writing import check_writable, say_skipped, write
from ..quality.measure import require_device, require_jax
from ..render.command import what_is_left
from . import measure as frames
from .sets import frame_sets_named

# What a narrow terminal goes without, the first first.
EXPENDABLE = (
    *("device", "rounded_by", "seed", "codes", "reached_max_percent", "reached_mean_percent", "limit_mean_deg"),
    *("limit_max_deg", "tangent_rms_deg", "normal_rms_deg", "tangent_mean_deg", "normal_mean_deg", "rotation_mean_deg"),
    *("count", "limit_rms_deg", "tangent_max_deg", "normal_max_deg", "invalid"),
)


@dataclass(frozen=True, kw_only=True)
class FramesRequest(FramesOptions):
    """What to measure, as typed: comma-separated names; no storage is where each code usually lies."""

    def cases(self) -> list[frames.Case]:
        """One case for each row.

        Raises:
            UsageError: unknown names, a file that cannot be read, or nothing that fits.
            MissingError: only GLSL is asked for and there is no GL device.
        """
        check_seed(self.seed)
        count = checked_count(self.count)
        codecs = self._codecs()
        backends = pick("back end", self.backend, {name: name for name in frames.BACKENDS})
        require_jax()
        if backends == ["glsl"]:
            require_device()
        sets = frame_sets_named(self.frames, count, self.seed)
        return [frames.Case(codec, chosen, backend) for chosen in sets for codec in codecs for backend in backends]

    def _codecs(self) -> list[FrameCodec]:
        """Those that do not fit are named on standard error."""
        made, complaints = list[FrameCodec](), list[str]()
        for encoding in pick("frame encoding", self.encoding, FRAME_ENCODINGS):
            names = ",".join(encoding.storages) if self.storage is None else self.storage
            for storage in pick("frame storage", names, FRAME_STORAGES):
                codec = FrameCodec(encoding, storage)
                if codec.misfit:
                    complaints.append(f"{codec.name}: {codec.misfit}")
                else:
                    made.append(codec)
        return what_is_left(made, complaints)


def frames_command(request: FramesRequest, format: str, output: Path | None) -> int:
    """Measure, then write the rows. Exit status 1 where one is below its limit."""
    cases = request.cases()
    if output:
        check_writable(output)
    with progress(len(cases)) as tick:
        rows = in_order(frames.rows(cases, tick))
    say_skipped(rows)
    below = [row for row in rows if row["below_limit"]]
    for row in below:
        wrong = f"{row['codes']} codes cannot do that: the measure is wrong"
        print(f"normalbench: {row['encoding']}/{row['storage']}: {row['below_limit']}; {wrong}", file=sys.stderr)
    shown = [{c: v for c, v in row.items() if c not in ("skipped", "below_limit")} for row in rows]
    write(shown if format == "table" else rows, format, output, EXPENDABLE)
    return 1 if below else 0


def in_order(rows: Iterable[frames.Row]) -> list[frames.Row]:
    """Rows of one set and of as many bits together, the best codec first; those without figures last."""
    found = list(rows)
    sets = list(dict.fromkeys(row["frame_set"] for row in found))
    best: dict[tuple, float] = {}
    for row in found:
        rms, codec = row["rotation_rms_deg"], _codec_of(row)
        best[codec] = min(best.get(codec, math.inf), math.inf if rms is None else rms)
    return sorted(found, key=lambda row: (sets.index(row["frame_set"]), row["bits"], best[_codec_of(row)]))


def _codec_of(row: frames.Row) -> tuple:
    return row["frame_set"], row["encoding"], row["storage"]
