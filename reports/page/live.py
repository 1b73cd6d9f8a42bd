"""The laboratory of a page: codecs in GLSL ES that the reader's browser runs, unpacked when it is opened."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..charts.looks import colour_map
from .codec_key import CodecKey
from .embedded import Record, small_uri

FOLDER = Path(__file__).parent / "web" / "live"
# In the order in which the page runs them, as one script.
MEASURING = ("checks.js", "probe.js", "measure.js", "timing.js", "measuring.js", "keep.js")
SEEING = (
    "scenes.js",
    "drawn.js",
    "orbit.js",
    "see.js",
    "inspect.js",
    "trips.js",
    "own.js",
    "share.js",
    "files.js",
    "mesh.js",
    "dropped.js",
    "chosen.js",
)
SCRIPTS = ("view.js", "gl.js", *SEEING, *MEASURING, "live.js")
# The encoder that a reader begins with.
EXAMPLE = "first.glsl"
# What the names of every codec's functions begin with.
NAMES = "codec"

# What the pictures of scenes may take, in bytes of text.
SCENES = 200_000


@dataclass(frozen=True)
class Live:
    """A run's data for the laboratory.

    Attributes:
        codecs: the codecs, as `bench.measures.live.programs` returns them.
        storages: the functions of storages, in the same form, for an encoder that the reader types.
        left_out: the reason why a browser cannot run a codec, by codec.
        scenes: image sets of normals: names, pixels as uint8 of shape (height, width, 4), and the slopes of the rays
            through the right and the upper edge.
        unpacking: data for converting pixels to normals.
        helpers: GLSL ES of the functions that users' encoders may call.
        checks: data from which browsers make the normals for the `checks` of each codec.
    """

    codecs: Sequence[Record]
    storages: Sequence[Record]
    left_out: Mapping[str, str] = field(default_factory=dict)
    helpers: str = ""
    scenes: Sequence[tuple[str, np.ndarray, np.ndarray]] = ()
    unpacking: Mapping[str, Any] = field(default_factory=dict)
    checks: Mapping[str, Any] = field(default_factory=dict)

    def data(self, about: Mapping[str, str]) -> str:
        """Return the laboratory's data as JSON text.

        Args:
            about: facts about the page, by name."""
        content = {
            **about,
            "codecs": [_named(codec) for codec in self.codecs],
            # Away from the texts, which pack better next to each other.
            "sums": [codec.get("checks") for codec in self.codecs],
            "storages": [_named(storage) for storage in self.storages],
            "helpers": self.helpers,
            "scenes": list(self._scenes()),
            "unpacking": dict(self.unpacking),
            "checks": dict(self.checks),
            "shaders": {path.name: _shader(path) for path in sorted(FOLDER.glob("shaders/**/*.*"))},
            "colours": colour_map(),
        }
        return json.dumps(content, sort_keys=True)

    def _scenes(self) -> Iterator[Record]:
        """Yield the scenes that fit, in order, in a total of SCENES bytes."""
        left = SCENES
        for name, pixels, slope in self.scenes:
            uri = small_uri(pixels)
            left -= len(uri)
            if left >= 0:
                height, width = pixels.shape[:2]
                yield {"title": name, "width": width, "height": height, "slope": slope.tolist(), "pixels": uri}


def _named(codec: Record) -> Record:
    key = CodecKey(codec["encoding"], codec["storage"], codec["rounding"])
    texts = {name: value for name, value in codec.items() if name != "checks"}
    return {**texts, "label": key.label, "names": NAMES}


def _shader(path: Path) -> str:
    """Return a shader's text without comments, except that the example, which a reader sees, keeps them."""
    text = path.read_text(encoding="utf-8")
    return text if path.name == EXAMPLE else _bare(re.sub(r" +//.*", "", text))


def script() -> str:
    """Return the laboratory's scripts joined into one, without indentation and comment lines. No string literal in
    them may span several lines."""
    return _bare("\n".join((FOLDER / name).read_text(encoding="utf-8") for name in SCRIPTS))


def _bare(text: str) -> str:
    """Return text without indentation and comment lines, which a page does not need."""
    return re.sub(r"^\s*(//.*\n|(?=\S))", "", text, flags=re.MULTILINE)
