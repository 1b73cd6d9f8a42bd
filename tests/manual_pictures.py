"""Redraw the manual's pictures with the commands that their pages show.

    python -m tests.manual_pictures studio occlusion

Without names, all pictures are drawn, which takes two minutes. README's two pictures are screenshots of a run's page,
and `scenes` needs the three models that its caption names.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs" / "pictures"
SEVEN = ("xyz", "xy", "spherical", "spheremap", "stereographic", "per_pixel_view", "octahedral")
KINDS = ("encoded", "decoded", "error", "power")
# Pixels that a page shows of a picture's width.
MOST_WIDE = 960


class Picture(NamedTuple):
    """A picture in the manual.

    Attributes:
        command: the start of the command that draws the picture, as its page shows it.
        rows: for each row, patterns of the files that are placed side by side; the command writes these files.
    """

    command: str
    rows: tuple[tuple[str, ...], ...]


def _effect(command: str, *names: str) -> Picture:
    """Return a picture of an effect: the images with exact normals in one row."""
    return Picture(f"normalbench effects --effect {command}", (tuple(f"*reference-{name}.png" for name in names),))


PICTURES = {
    "budget": Picture("normalbench budget --bytes 12,16,20", (("budget.png",),)),
    "roughness": Picture("normalbench roughness --plot", (("roughness.png",),)),
    "room": Picture("normalbench render --scene room --encoding octahedral --images", (("*reference.png",),)),
    "studio": Picture("normalbench render --encoding octahedral --storage rg8,rgb10a2", (("*reference.png",),)),
    "seven-methods": Picture(
        "normalbench quality --encoding xyz,xy",
        tuple(tuple(f"*-{name}-*-{kind}.png" for kind in KINDS) for name in SEVEN),
    ),
    "occlusion": Picture(
        "normalbench effects --effect ssao,hbao",
        tuple(tuple(f"{name}-*reference-effect.png" for name in row) for row in (("ssao", "hbao"), ("sao", "gtao"))),
    ),
    "propagation": _effect("lpv", "final", "effect"),
    "skin": _effect("subsurface", "final", "effect"),
    "lake": _effect("water", "final", "effect"),
    "reflections": Picture("normalbench effects --effect ssr:rays=8", (("*reference-final.png", "*-rg8-*-final.png"),)),
}  # fmt: skip


def command_of(name: str, pages: dict[Path, str]) -> str:
    """Return the command that draws a picture, as the page that has the picture shows it. Raises ValueError if the
    page does not show exactly one such command."""
    (page,) = (text for text in pages.values() if f"(pictures/{name}.png)" in text)
    (command,) = re.findall(rf"^    ({re.escape(PICTURES[name].command)}.*)$", page, re.M)
    return command


def draw(name: str, pages: dict[Path, str]) -> None:
    """Draw a picture and write it to the manual's folder."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = shlex.split(command_of(name, pages))[1:]
        subprocess.run([sys.executable, "-m", "normalbench", *arguments], cwd=folder, check=True)
        lines = [np.hstack([_pixels(Path(folder), pattern) for pattern in row]) for row in PICTURES[name].rows]
    image = Image.fromarray(np.vstack(lines))
    image.thumbnail((MOST_WIDE, image.height))
    image.save(FOLDER / f"{name}.png", optimize=True)


def _pixels(folder: Path, pattern: str) -> np.ndarray:
    (path,) = folder.rglob(pattern)
    return np.asarray(Image.open(path).convert("RGB"))


if __name__ == "__main__":
    texts = {path: path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("*.md")}
    for picture in sys.argv[1:] or PICTURES:
        draw(picture, texts)
