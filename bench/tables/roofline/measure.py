"""The time that a codec's bytes and instructions take in a frame, by the roofline model.

Williams, Waterman, Patterson (2009), Roofline: An Insightful Visual Performance Model for Multicore Architectures.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any

from ....encodings.codecs.codec import Codec
from ....gbuffer.defines.packings import SIGN, packing_of
from ...ground.options.gpu_families import usual_stage
from ..cost import measure as cost
from ..cost.codec_costs import Costs, LeftOutError, Where
from ..table import Row
from .rates import Rates
from .table import TABLE

# Full-rate instructions where a family's rates are known, and instructions as they are elsewhere.
COLUMNS = ("issue_slots", "instructions")
# Two times that differ by less are one: counts are whole numbers.
TIE = 1e-9


@dataclass(frozen=True)
class Frame:
    """The use of a G-buffer in a frame.

    Attributes:
        size: width and height in pixels.
        reads: number of passes that read and decode each pixel's normal.
        overdraw: number of times that each pixel's normal is encoded and written.
        cache_share: share of the last-level cache that is available to normals.
    """

    size: tuple[int, int]
    reads: int
    overdraw: float
    cache_share: float

    @property
    def pixels(self) -> int:
        return prod(self.size)


@dataclass(frozen=True)
class Work:
    """A codec's work per pixel: bytes, and instructions to encode and to decode."""

    bytes: float
    encode: float
    decode: float

    def instructions(self, frame: Frame) -> float:
        """Return the instructions per pixel over all passes of a frame."""
        return frame.overdraw * self.encode + frame.reads * self.decode

    def traffic(self, frame: Frame) -> float:
        """Return the bytes that a frame writes and reads."""
        return frame.pixels * self.bytes * (frame.overdraw + frame.reads)

    def is_cached(self, frame: Frame, rates: Rates) -> bool:
        """Whether all normals fit in their share of the cache."""
        return 0 < frame.pixels * self.bytes <= frame.cache_share * rates.cache * 1e6

    def times(self, frame: Frame, rates: Rates) -> tuple[float, float]:
        """Return the time of a frame's bytes and the time of its instructions, in seconds."""
        moved = self.traffic(frame) / (self.bandwidth(frame, rates) * 1e9)
        return moved, frame.pixels * self.instructions(frame) / rates.instructions

    def bandwidth(self, frame: Frame, rates: Rates) -> float:
        """Return the bandwidth for normals in GB/s: the cache's if they fit in their share, else the memory's."""
        return rates.cached if self.is_cached(frame, rates) else rates.memory


@dataclass(frozen=True, eq=False)
class RooflineCase:
    """Codecs to compare on one GPU, in several frames.

    Attributes:
        codecs: the codecs.
        gpu, rates: the GPU's name and rates.
        frames: uses of the G-buffer to compare the codecs in.
        is_shared: whether other data shares each texel, so that only a code's own bits count.
    """

    codecs: Sequence[Codec]
    gpu: str
    rates: Rates
    frames: Sequence[Frame]
    is_shared: bool = False

    def rows(self) -> Iterator[Row]:
        """Yield a row for each codec and frame, with the reason in `skipped` if the codec's cost is not known."""
        driver = next((row["driver"] for row in self._counts if row["driver"]), None)
        for codec in self.codecs:
            work = self._works[codec]
            for frame in self.frames:
                row = self._row(codec, frame) | {"driver": driver}
                yield row | ({"skipped": work} if isinstance(work, str) else _figures(work, frame, self.rates))

    def work(self, codec: Codec) -> Work | None:
        """Return the work of a codec; None if its cost is not known."""
        work = self._works[codec]
        return None if isinstance(work, str) else work

    @cached_property
    def _works(self) -> dict[Codec, Work | str]:
        """The work of each codec, or the reason why it is not known."""
        costs = Costs(self._counts)
        lost = next((row["skipped"] for row in self._counts if row["skipped"] and not row["encoding"]), None)
        works: dict[Codec, Work | str] = {}
        for codec in self.codecs:
            try:
                encode, decode = (self._operation_cost(costs, codec, operation) for operation in cost.OPERATIONS)
                works[codec] = Work(self._bytes_per_pixel(codec), encode, decode)
            except LeftOutError as reason:
                works[codec] = lost or str(reason)
        return works

    def _bytes_per_pixel(self, codec: Codec) -> float:
        return codec.bits / 8 if self.is_shared else codec.storage.texel_bytes

    def _operation_cost(self, costs: Costs, codec: Codec, operation: str) -> float:
        column = COLUMNS[all(row[COLUMNS[0]] is None for row in self._counts)]
        return costs.of(codec, Where("isa", self.rates.family, self._stage), operation, column).cost

    @cached_property
    def _counts(self) -> list[Row]:
        """The cost rows from which the codecs' costs are computed."""
        packings = dict.fromkeys(packing_of(codec) for codec in self.codecs)
        encodings = dict.fromkeys(codec.encoding for codec in self.codecs)
        chosen = cost.cases(encodings, [*packings, *SIGN], cost.OPERATIONS)
        return [row for row, _ in cost.isa_rows(chosen, [self._stage], [self.rates.family], [], cost.nobody)]

    @property
    def _stage(self) -> str:
        return usual_stage(self.rates.family)

    def _row(self, codec: Codec, frame: Frame) -> Row:
        size = "x".join(map(str, frame.size))
        about: Row = {"encoding": codec.encoding.name, "storage": codec.storage.name, "gpu": self.gpu, "size": size}
        about |= {"reads": frame.reads, "overdraw": frame.overdraw, "bits": codec.bits}
        return TABLE.empty() | about | {"shared": self.is_shared, "family": self.rates.family}


def _figures(work: Work, frame: Frame, rates: Rates) -> Row:
    memory, alu = work.times(frame, rates)
    figures: Row = {"bytes_per_pixel": work.bytes, "encode": work.encode, "decode": work.decode}
    figures |= {"instructions": work.instructions(frame), "megabytes": work.traffic(frame) / 1e6}
    figures |= {"memory_us": memory * 1e6, "alu_us": alu * 1e6, "frame_us": max(memory, alu) * 1e6}
    figures["ridge"] = rates.ridge(work.bandwidth(frame, rates))
    return figures | {"bound": "memory" if memory >= alu else "alu", "in_cache": work.is_cached(frame, rates)}


def ranked(rows: Sequence[Row]) -> list[Row]:
    """Return the rows by GPU, size and reads, the fastest first, with their ranks; rows without figures come last in
    each group."""
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault((row["gpu"], row["size"], row["reads"]), []).append(row)
    return [row for group in groups.values() for row in _ranked_rows(group)]


def _ranked_rows(group: Sequence[Row]) -> Iterator[Row]:
    known = sorted((row for row in group if row["frame_us"] is not None), key=lambda row: row["frame_us"])
    for row in known:
        faster = sum(other["frame_us"] < row["frame_us"] * (1 - TIE) for other in known)
        yield row | {"rank": 1 + faster}
    yield from (row for row in group if row["frame_us"] is None)


MOST_READS = 64


def from_reads(candidate: Work, other: Work, rates: Rates, frame: Frame) -> str:
    """Return the numbers of reads at which one codec is faster than another: "always", "never", "from 3", "up to 2",
    "equal".

    Each time is the larger of two linear functions of the reads, so a codec may also be faster only in a range: "from
    3 to 5".
    """
    wins, loses = [], []
    for reads in range(1, MOST_READS + 1):
        read_frame = Frame(frame.size, reads, frame.overdraw, frame.cache_share)
        a, b = (max(work.times(read_frame, rates)) for work in (candidate, other))
        wins += [reads] if a < b * (1 - TIE) else []
        loses += [reads] if b < a * (1 - TIE) else []
    if not wins:
        return "never" if loses else "equal"
    if len(wins) == MOST_READS:
        return "always"
    first, last = wins[0], wins[-1]
    if last == MOST_READS:
        return f"from {first}"
    return f"up to {last}" if first == 1 else f"from {first} to {last}"
