"""Images embedded in a page, with lossless compression."""

from __future__ import annotations

import base64
import itertools
import json
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from io import BytesIO
from typing import Any
from urllib.parse import quote

import numpy as np
from PIL import Image

from ..charts.looks import colour_map
from ..charts.pictures import GAIN, POWER
from .pixels import LEAST_LOG2, NOT_A_NUMBER, STEPS_PER_OCTAVE, ImagePixels, NormalPixels, Pictured, Subject

# What all pictures inside a page may take, in bytes of text; and inside one of a whole run, which has much besides.
BUDGET, BUDGET_OF_A_RUN = 1_750_000, 330_000
# Inside a page a picture is at most this wide or high: larger ones are shown as every second pixel, or every third.
INSIDE = 400
# Pixels that WebP has room for on a side.
LARGEST_WEBP = 16383
# WebP's own scale of 0 to 6: 4 takes 1.7 times as long for a seventieth less.
EFFORT = 3
# Each holds a picture in full size.
WORKERS = 4

Record = dict[str, Any]


@dataclass(frozen=True)
class Gallery:
    """The pictures of a page.

    Attributes:
        subjects: subjects with their pictures, as pictures.js reads them.
        left_out: names of codecs whose pictures are left out to keep the page small.
        damaged: names of codecs whose files cannot be read.
        files: texts of scripts next to the page, by file name.
    """

    subjects: Sequence[Record] = ()
    left_out: Sequence[str] = ()
    damaged: Sequence[str] = ()
    files: dict[str, str] = field(default_factory=dict)

    @property
    def data(self) -> Record:
        """The subjects and the constants that pictures.js needs to show them."""
        angle = {"least_log2": LEAST_LOG2, "steps_per_octave": STEPS_PER_OCTAVE, "not_a_number": NOT_A_NUMBER}
        articles = {"gain": GAIN, "power": POWER}
        pictures = {"subjects": self.subjects, "left_out": list(self.left_out)}
        return pictures | {"angle": angle, "articles": articles, "colours": colour_map()}


def data_uri(pixels: Image.Image) -> str:
    """Return an image as a data URI with lossless WebP."""
    data = BytesIO()
    # Colours of transparent pixels are kept as well.
    pixels.save(data, format="webp", lossless=True, exact=True, method=EFFORT)
    return "data:image/webp;base64," + base64.b64encode(data.getvalue()).decode("ascii")


def small_uri(pixels: np.ndarray) -> str:
    """Return uint8 pixels of shape (height, width, channels) as an image in a data URI, with lossless WebP."""
    return data_uri(Image.fromarray(pixels))


def _bytes_uri(planes: Sequence[np.ndarray]) -> str:
    """Return up to three planes of bytes, (height, width), as the channels of an image in a data URI."""
    channels = [planes[min(i, len(planes) - 1)] for i in range(3)]
    return small_uri(np.stack(channels, axis=-1))


def _code_uris(codes: np.ndarray, bits: Sequence[int]) -> list[str]:
    """Return codes as images in data URIs. Each component is shifted up to whole bytes; each image holds three bytes,
    in the order of the highest byte of every component, then the next byte and so on."""
    planes: list[np.ndarray] = []
    sizes = [-(-count // 8) for count in bits]
    for level in range(max(sizes)):
        for i, (size, count) in enumerate(zip(sizes, bits, strict=True)):
            if level < size:
                aligned = codes[..., i].astype(np.uint64) << np.uint64(8 * size - count)
                planes.append((aligned >> np.uint64(8 * (size - 1 - level)) & np.uint64(255)).astype(np.uint8))
    return [_bytes_uri(planes[first : first + 3]) for first in range(0, len(planes), 3)]


def _planes(pixels: NormalPixels | ImagePixels, original: np.ndarray, step: int) -> Record:
    """Return every `step`-th pixel of a codec in both directions, as images in data URIs for pictures.js."""
    if isinstance(pixels, NormalPixels):
        angle, codes, decoded = (plane[::step, ::step] for plane in (pixels.angle, pixels.codes, pixels.decoded))
        coded = {"codes": _code_uris(codes, pixels.bits), "bits": list(pixels.bits)}
        return {"angle": _bytes_uri([angle]), "decoded": small_uri(np.ascontiguousarray(decoded)), **coded}
    # Most pixels are as the original's: the difference takes a fraction of the bytes.
    apart = pixels.final[::step, ::step] - original[::step, ::step]
    flip = {} if pixels.flip is None else {"flip": _bytes_uri([pixels.flip[::step, ::step]])}
    return {"apart": small_uri(np.ascontiguousarray(apart)), **flip}


class _Packer:
    """Takes the pictures of one subject."""

    def __init__(self, subject: Subject, original: np.ndarray, is_beside: bool):
        self.subject, self.original = subject, original
        self.step = -(-max(original.shape[:2]) // (LARGEST_WEBP if is_beside else INSIDE))
        shown = np.ascontiguousarray(original[:: self.step, :: self.step])
        self.record: Record = {
            "title": subject.title,
            "of": subject.of,
            "height": shown.shape[0],
            "width": shown.shape[1],
            "step": self.step,
            "original": small_uri(shown),
        }
        self.taken: dict[str, Record] = {}
        self.has_flip, self.is_full = True, False

    def planes(self, pictured: Pictured) -> Record | None:
        """Return a codec's pixels, empty if there is no more room; None if unreadable or of the wrong size."""
        pixels = pictured.load()
        self.has_flip = self.has_flip and isinstance(pixels, ImagePixels) and pixels.flip is not None
        if not pixels or pixels.shape != self.original.shape:
            return None
        return {} if self.is_full else _planes(pixels, self.original, self.step)

    def size_with(self, planes: Record) -> int:
        """Return the size that a codec's pixels add to the page; the first codec also adds the original."""
        return len(json.dumps(planes)) + (0 if self.taken else len(self.record["original"]))

    def take(self, pictured: Pictured, what: Record) -> None:
        """Add a codec and its pixels to the subject's pictures on the page."""
        self.taken[pictured.label] = {"label": pictured.label, "codec": pictured.codec} | what

    @property
    def shown(self) -> Record:
        """The subject as pictures.js reads it."""
        codecs = [self.taken[codec.label] for codec in self.subject.codecs if codec.label in self.taken]
        return self.record | {"codecs": codecs, "flip": self.has_flip}


def gallery(subjects: Sequence[Subject], beside: str = "", budget: int = BUDGET) -> Gallery:
    """Return the pictures of a page.

    Args:
        subjects: the available subjects.
        beside: folder, as the page names it, of scripts with all pictures in full size. If it is empty, the page
            itself
            holds the pictures: for each subject those of the first codecs that fit.
        budget: maximum size of the pictures inside the page.
    """
    originals = [(subject, subject.original()) for subject in subjects]
    packers = [_Packer(subject, image, bool(beside)) for subject, image in originals if image is not None]
    damaged = [subject.title for subject, image in originals if image is None]
    left_out: list[str] = []
    files: dict[str, str] = {}
    with ThreadPoolExecutor(WORKERS) as pool:
        for packer, codec, planes in _packed(pool, packers):
            name = f"{codec.label}, {packer.subject.title}"
            if planes is None:
                damaged.append(name)
            elif beside:
                file = f"{len(files)}.js"
                files[file] = f"keepPicture({json.dumps(file)}, {json.dumps(planes)});\n"
                packer.take(codec, {"file": quote(f"{beside}/{file}"), "name": file})
            elif packer.is_full or (size := packer.size_with(planes)) > budget:
                packer.is_full = True
                left_out.append(name)
            else:
                budget -= size
                packer.take(codec, planes)
    return Gallery([packer.shown for packer in packers if packer.taken], left_out, damaged, files)


def _packed(pool: ThreadPoolExecutor, packers: Sequence[_Packer]) -> Iterator[tuple[_Packer, Pictured, Record | None]]:
    """Yield each codec's pixels. A few codecs are packed at a time, so that codecs of a subject that turns out to be
    full are not packed."""
    wanted = list(_in_turn(packers))
    for start in range(0, len(wanted), WORKERS):
        few = wanted[start : start + WORKERS]
        for (packer, codec), planes in zip(few, pool.map(lambda item: item[0].planes(item[1]), few), strict=True):
            yield packer, codec, planes


def _in_turn(packers: Sequence[_Packer]) -> Iterator[tuple[_Packer, Pictured]]:
    """Yield codecs in the order in which they get room: first those that each subject puts first, then, by rank, the
    next codec of each subject in turn."""
    ranked = [
        [(packer, codec) for codec in sorted(packer.subject.codecs, key=lambda shown: shown.rank)] for packer in packers
    ]
    yield from (pair for turn in ranked for pair in turn[: turn[0][0].subject.first])
    for turn in itertools.zip_longest(*(turn[turn[0][0].subject.first :] for turn in ranked)):
        yield from filter(None, turn)
