"""A page's sections: what each asks, shows and was measured by. Nothing here knows HTML."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from ..charts import charts, plots
from ..charts.drawings import Drawing, for_drawing
from ..charts.pareto import pareto_figure
from .found import Found, Row, whole
from .verdict import BACKENDS, LEADING, is_number


@dataclass(frozen=True)
class Sheet:
    """A table to show.

    Attributes:
        title: its caption.
        rows: all with the same columns.
        folded: whether it is shown only when asked for.
    """

    title: str
    rows: Sequence[Row]
    folded: bool = False


@dataclass(frozen=True)
class Section:
    """A part of a page.

    Attributes:
        key: its anchor.
        title, intro: what it is called and asks.
        table: the run's table that it is about.
        method: how it is measured, in sentences.
        conditions: columns that say under what conditions; the same for few rows or many.
        parts: a column whose values are tables of their own.
        drawings: makes its charts from its rows.
    """

    key: str
    title: str
    intro: str
    table: str
    method: str
    conditions: tuple[str, ...]
    drawings: Callable[[Found, Sequence[Row]], Iterator[Drawing]]
    parts: str | None = None

    def rows(self, found: Found) -> list[Row]:
        """The run's rows; none where it has no such table."""
        return whole(found.tables.get(self.table, ()))

    def sheets(self, found: Found) -> Iterator[Sheet]:
        """Its tables: those that people look at first, then every row."""
        for title, rows in found.short.get(self.table, ()):
            if rows:
                yield Sheet(title, whole(rows))
        rows = self.rows(found)
        for value in dict.fromkeys(row.get(self.parts) for row in rows) if self.parts else (None,):
            part = [row for row in rows if not self.parts or row.get(self.parts) == value]
            if part:
                name = f"{self.table}, {value}" if self.parts else self.table
                yield Sheet(f"Every row of {name}", _with_domain(found, _worth_showing(part)), folded=True)

    def measured(self, found: Found) -> list[tuple[str, str]]:
        """The conditions, what each column says in these rows."""
        rows, said = self.rows(found), []
        for column in self.conditions:
            values = list(dict.fromkeys(str(row[column]) for row in rows if row.get(column) is not None))
            if values:
                said.append((column.replace("_", " "), ", ".join(values[:8]) + (" ..." if len(values) > 8 else "")))
        return said


def _worth_showing(rows: Sequence[Row]) -> list[Row]:
    """Less the columns that are empty in every row, and what only a program reads."""
    kept = [c for c in rows[0] if c not in FOR_PROGRAMS and any(row[c] is not None for row in rows)]
    return [{column: row[column] for column in kept} for row in rows]


FOR_PROGRAMS = ("angle_counts", charts.EACH)


def _with_domain(found: Found, rows: Sequence[Row]) -> list[Row]:
    """What an encoding is made for beside its name, where there are encodings of normals."""
    if not any(row.get("encoding") in found.domains for row in rows):
        return list(rows)
    return [
        {"encoding": row["encoding"], "domain": found.domains.get(row["encoding"])} | row
        if "encoding" in row
        else dict(row)
        for row in rows
    ]


def _having(rows: Sequence[Row], *columns: str) -> list[Row]:
    """Rows with a finite figure in each of the columns, for drawing."""
    usable = [row for row in rows if all(is_number(row.get(c)) and math.isfinite(row[c]) for c in columns)]
    return for_drawing(usable, FOR_PROGRAMS)


def _one_backend(rows: Sequence[Row]) -> list[Row]:
    backends = list(dict.fromkeys(row.get("backend") for row in rows))
    chosen = next((b for b in backends if b in BACKENDS), backends[0] if backends else None)
    return [row for row in rows if row.get("backend") == chosen]


def histograms(_: Found, rows: Sequence[Row]) -> Iterator[Drawing]:
    """A chart for each set of normals; none of rows that keep no histogram."""
    usable = [r for r in _having(rows, "bits", "angle_mean_deg") if charts.bins(r.get("angle_counts"))]
    for at, normals in enumerate(dict.fromkeys(str(row.get("normals")) for row in usable)):
        part = _one_backend([row for row in usable if str(row.get("normals")) == normals])
        title = f"Angles on {normals}, by {part[0].get('backend')}"
        said = "The share of normals over their angle in degrees, on a logarithmic scale, each codec as high as the "
        said += "others; the best mean on top. The figures are in the tables of what normals lose."
        yield Drawing(f"angles-{at}", title, said, partial(charts.histogram_chart, part))


def no_drawings(*_: object) -> Iterator[Drawing]:
    """For tables that speak for themselves."""
    yield from ()


def _images(_: Found, rows: Sequence[Row]) -> Iterator[Drawing]:
    usable = _having(rows, LEADING, "normal_psnr_db")
    for at, scene in enumerate(dict.fromkeys(row.get("scene") for row in usable)):
        part = [row for row in usable if row.get("scene") == scene]
        said = "PSNR in dB of the final image of each codec, beside that of the normals in its G-buffer. The figures "
        said += "are in the table below."
        title = f"The image of {scene} beside the normals it was lit by"
        yield Drawing(f"image-{at}", title, said, partial(charts.image_chart, part))


def _fronts(found: Found, _: Sequence[Row]) -> Iterator[Drawing]:
    for at, front in enumerate(found.fronts):
        title = f"Instructions against {front.error.label.removesuffix(', dB')}"
        said = (
            "Each codec by the instructions of encoding or decoding it and its storage, and by its error; grey where "
        )
        said += "another is no dearer, no worse and takes no more bits. The figures are in the tables."
        yield Drawing(f"cost-{at}", title, said, partial(pareto_figure, front.panels, front.error))


def _passes(_: Found, rows: Sequence[Row]) -> Iterator[Drawing]:
    usable = [row for row in _having(rows, charts.FRAME) if charts.passes_of(row)]
    if usable:
        said = "A bar for each pipeline, parted by pass: milliseconds a frame, medians. The figures are in the table."
        yield Drawing("passes", "What a frame's milliseconds go into", said, partial(charts.passes_chart, usable))


def _lights(_: Found, rows: Sequence[Row]) -> Iterator[Drawing]:
    equal = [r for r in _having(rows, "sum", "lights", "error", "bound") if r.get("experiment") == "equal"]
    random = [r for r in _having(rows, "lights", "model_max", "bound") if r.get("experiment") == "random"]
    if equal or random:
        said = "What is lost of the sum over the number of lights, by the model, a line for each light buffer; dotted: "
        said += "the most it can be. The figures are in the rows of the experiments equal and random."
        yield Drawing("lights", "Error over the number of lights", said, partial(plots.lights_figure, equal + random))


def _depths(_: Found, rows: Sequence[Row]) -> Iterator[Drawing]:
    usable = _one_backend(_having(rows, "distance", "error_max", "near", "far", "fov"))
    if usable:
        said = "The largest distance between true and rebuilt position over the distance from the eye, both on "
        said += "logarithmic scales, a line for each depth code in its storage. The figures are in the table."
        yield Drawing("depth", "Position error over distance", said, partial(plots.depth_figure, usable))


SECTIONS = (
    Section(
        "quality",
        "What normals lose",
        "Every encoding in its storage, on the article's scene and on uniform directions: how far is the decoded "
        "normal from the one that went in?",
        "quality",
        "Each normal is encoded, stored as the render target stores it, decoded, and compared with itself. JAX "
        "emulates the storage bit for bit; GLSL encodes in a fragment shader into the real target and decodes from it. "
        "Sums are in 64 bits; an angle is atan2 of cross and dot product. Decodes are not renormalised for the PSNR.",
        ("normals", "storage", "rounding", "backend", "count", "background", "seed", "device", "rounded_by"),
        no_drawings,
    ),
    Section(
        "image",
        "What the image says",
        "The same codes in the G-buffer of a renderer that is exact otherwise: how far is the final image, as "
        "displayed, from one in 32-bit floats?",
        "render",
        "Each codec's image against that of the same pipeline with every target in 32-bit floats, clipped and in sRGB "
        "before 8 bits, every pixel, averaged over the moments of the scene.",
        ("scene", "pipeline", "layout", "light_buffer", "size", "samples", "lights", "frames", "seed", "device"),
        _images,
    ),
    Section(
        "passes",
        "What the passes take",
        "A frame of each pipeline in the layout that it is published with: where do its milliseconds go?",
        "passes",
        "Medians over repeated frames after a warm-up; the spread is the distance of the quartiles. Timer queries on a "
        "GPU; on a software rasteriser a clock around each finished pass, which compares passes with each other and is "
        "not a GPU's time. The clock is named below.",
        (
            "scene",
            "objects",
            "lights",
            "shadow",
            "size",
            "samples",
            "light_buffer",
            "repeats",
            "clock",
            "seed",
            "device",
        ),
        _passes,
    ),
    Section(
        "light",
        "What a light buffer loses",
        "Lights are added up one by one, and every sum is rounded: what is left of them in each light buffer?",
        "lights",
        "The model, in JAX, stands beside what the GL device does when it blends. equal: N equal lights of a known "
        "sum. random: coloured lights with falloff in three orders. banding: one lamp's falloff. chromaticity: a "
        "highlight's colour rebuilt from one target. image: a frame against 32-bit floats.",
        ("experiment", "pipeline", "scene", "power", "size", "seed", "device", "rounds"),
        _lights,
        parts="experiment",
    ),
    Section(
        "depth",
        "What depth loses",
        "A view-space position is rebuilt from the stored depth: how far off is it, at which distance?",
        "depth",
        "Points anywhere on the screen at each distance, within a sixteenth of it, and spread evenly over the range. "
        "Errors are distances in the unit of the planes. z/w and reversed z/w go through real depth buffers.",
        ("near", "far", "fov", "count", "backend", "seed", "device", "rounded_by"),
        _depths,
    ),
    Section(
        "frames",
        "What tangent frames lose",
        "A normal, a tangent and the side of the bitangent in one texel: how far is the decoded frame turned?",
        "frames",
        "Rotations spread evenly by Haar's measure, half of them mirrored, through each code in its storage as normals "
        "go. The angle is that of the rotation from the true frame to the decoded one; lost hands are counted. The "
        "limit is of as many codes: the ball of rotations that is one code's share.",
        ("frame_set", "count", "backend", "seed", "device", "rounded_by"),
        no_drawings,
    ),
    Section(
        "cost",
        "What it costs",
        "What a current compiler makes of each encoder and decoder, and whether it is worth it.",
        "cost",
        "A kernel around the encoding's own GLSL is compiled by Mesa's RADV for GPUs that need not be there, less an "
        "empty kernel that moves the same numbers, so that doing nothing costs exactly 0. Counts hold for one Mesa.",
        ("stage", "family", "driver", "compiler", "device"),
        _fronts,
    ),
)
