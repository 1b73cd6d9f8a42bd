"""How much codes wobble: a chart over the turn, and an animation of a highlight."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from . import specs
from .charts import Row, codec_label
from .plots import COLOURS, DASHES, drawn_off_screen

# What a difference is multiplied by; grey is none.
GAIN = 8.0
# Each pixel is shown as a square of this many.
ENLARGED = 2
CAPTIONS = ("code", "exact", f"difference x {GAIN:g}")
CAPTION_HEIGHT, GAP = 14, 4
MILLISECONDS = 80
# What may tell lines of one codec apart.
CONDITIONS = ("space", "moves", "axis")


def _line_name(row: Row, rows: Sequence[Row]) -> str:
    others = [name for name in CONDITIONS if len({one.get(name) for one in rows}) > 1]
    return " ".join([codec_label(row), *(str(row.get(name)) for name in others)])


def lines(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """The rows of each line by its name, in order of the turn."""
    found: dict[str, list[Row]] = {}
    for row in sorted(rows, key=lambda row: row["turn_deg"]):
        found.setdefault(_line_name(row, rows), []).append(row)
    return dict(sorted(found.items()))


def motion_chart(rows: Sequence[Row]) -> Any:
    """The wobble over the turn, a line for each code, its colour the codec's.

    Args:
        rows: of the motion table: encoding, storage, space, moves, axis, turn_deg, wobble_deg.

    Returns:
        a figure for `plots.save`.
    """
    pyplot = drawn_off_screen()
    from matplotlib.ticker import LogLocator

    figure, axis = pyplot.subplots(figsize=(8.2, 4.8), layout="constrained")
    codecs, dashes = dict.fromkeys(map(codec_label, rows)), dict[str, dict[str, None]]()
    for name, line in lines(rows).items():
        codec = codec_label(line[0])
        own = dashes.setdefault(codec, {})
        own[name] = None
        colour, dash = COLOURS[list(codecs).index(codec) % len(COLOURS)], DASHES[(len(own) - 1) % len(DASHES)]
        turns, wobbles = ([row[column] for row in line] for column in ("turn_deg", "wobble_deg"))
        axis.plot(turns, wobbles, color=colour, linestyle=dash, marker="o", markersize=4, label=name)
    axis.set_xscale("log")
    axis.set_yscale("log")
    for one in (axis.xaxis, axis.yaxis):
        # As plain text, which matplotlib lays out much faster than powers of ten.
        one.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        one.set_major_formatter("{x:g}")
        one.set_minor_formatter("")
    axis.set_xlabel("turn, degrees a frame")
    axis.set_ylabel("wobble, degrees")
    axis.grid(alpha=0.3)
    if rows:
        figure.legend(loc="outside upper center", ncols=3, fontsize=8, frameon=False)
    return figure


def motion_specs(rows: Sequence[Row]) -> list[specs.Spec]:
    """The same as an interactive chart.

    Args:
        rows: as `motion_chart` takes them.
    """
    found = [
        {"line": name, "codec": codec_label(row)}
        | {"x": row["turn_deg"], "y": specs.rounded(row["wobble_deg"]), "ratio": specs.rounded(row.get("ratio"))}
        for name, line in lines(rows).items()
        for row in line
        if row["wobble_deg"] > 0
    ]
    scale = {"type": "log", "nice": False}
    x = {"field": "x", "type": "quantitative", "scale": scale, "title": "turn, degrees a frame"}
    y = {"field": "y", "type": "quantitative", "scale": {"type": "log"}, "title": "wobble, degrees"}
    plain = {"axis": {"format": "~g"}}
    colour = {"field": "line", "type": "nominal", "sort": None, "scale": {"range": specs.PALETTE}, "title": None}
    tooltip = specs.tips(line="code", x="turn, degrees a frame", y="wobble, degrees", ratio="ratio")
    opacity = specs.if_lit(1, 0.15)
    encoding = {"x": x | plain, "y": y | plain, "color": colour | {"legend": {"columns": 2}}}
    mark = {"type": "line", "point": True, "strokeWidth": 1.8}
    layer = [{"mark": mark, "encoding": {"opacity": opacity, "tooltip": tooltip}}]
    said = "The RMS change of a code's error from one frame to the next over the turn, a line for each code."
    return [specs.spec(found, said, encoding=encoding, layer=layer, height=360)]


def beside(one: np.ndarray, other: np.ndarray, title: str) -> Image.Image:
    """A frame of an animation: a code, exact normals, and GAIN times their difference around grey.

    Args:
        one, other: displayed images, (height, width, 3), 0 to 1.
        title: above all of them.
    """
    apart = 0.5 + GAIN * (np.nan_to_num(one, nan=1.0) - other)
    height, width = (size * ENLARGED for size in one.shape[:2])
    wide = 3 * width + 2 * GAP
    sheet = Image.new("RGB", (wide, height + 2 * CAPTION_HEIGHT), "white")
    text = ImageDraw.Draw(sheet)
    text.text((2, 1), title, fill="black")
    for at, (pixels, caption) in enumerate(zip((one, other, apart), CAPTIONS, strict=True)):
        bytes_ = np.round(np.clip(np.nan_to_num(pixels), 0, 1) * 255).astype(np.uint8)
        left = at * (width + GAP)
        text.text((left + 2, CAPTION_HEIGHT), caption, fill="black")
        shown = Image.fromarray(bytes_).resize((width, height), Image.Resampling.NEAREST)
        sheet.paste(shown, (left, 2 * CAPTION_HEIGHT))
    return sheet


def write_animation(path: Path, frames: Sequence[Image.Image]) -> None:
    """Write an animated PNG that goes on for ever. Raises OSError."""
    first, *others = frames
    first.save(path, format="png", save_all=True, append_images=others, duration=MILLISECONDS, loop=0)
