"""Checksums of a codec's expected codes, in few bytes: they identify a single number that is off by one step.

The codes of 2^16 normals would be hundreds of kilobytes for each codec. Instead, the page holds one word for each
group of 128 normals: the sum of weight(normal, number) code(normal, number), modulo 2^32. A browser subtracts the
sum of its own codes from this word. If the difference is 0, all codes are equal. If it is plus or minus one weight,
the number of the normal with this weight is off by one step. Codes are integers in the order of the numbers that
they stand for, so one step of a float is also a difference of 1.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from ....encodings.codecs.codec import Codec
from ...ground.angles import angles_deg
from ...ground.output import cache as kept
from ...ground.output.sources import sources
from ...shaders.code.channels import Channels
from ...shaders.code.reference import Reference, reference_of, signed
from . import normals
from .normals import COUNT, checksum, hashed

GROUP = 128
# Numbers of a code, at most.
NUMBERS = 4
# Every so many normals one travels with its codes, so that a page can say what they should be.
STRIDE = 2048
DOMAINS = ("sphere", "hemisphere", "view")


def common() -> dict[str, Any]:
    """Return data, as values for JSON, from which browsers make the normals and the weights of checksums, and also
    the checksums of each domain's normals and views."""
    given = normals.hard()
    starts = {"normals": normals.NORMALS, "views": normals.VIEWS, "weights": normals.WEIGHTS, "sums": normals.SUMS}
    return {
        "count": COUNT,
        "group": GROUP,
        "numbers": NUMBERS,
        "stride": STRIDE,
        "hash": {"shifts": normals.SHIFTS, "factors": normals.FACTORS, "starts": starts},
        "hard": {"count": len(given), "data": _base64_text(given, "<f4")},
        "sums": {domain: sums(domain) for domain in DOMAINS},
    }


@cache
def sums(domain: str) -> list[int]:
    """Return the checksums of a domain's normals and of its views, with which a browser checks its own vectors."""
    return [checksum(vectors) for vectors in normals.normals(domain)]


def is_whole(saved: Mapping[str, Any], domain: str, size: int) -> bool:
    """Whether saved checks belong to the normals that this version makes, and have the lengths for codes of `size`
    numbers."""
    counts = {"groups": COUNT // GROUP, "numbers": size, "sample": COUNT // STRIDE * size}
    try:
        is_there = all(len(base64.b64decode(saved[name], validate=True)) == 4 * count for name, count in counts.items())
    except ValueError:
        return False
    return is_there and saved["normals"] == sums(domain)[0]


def checks(codec: Codec) -> dict[str, Any]:
    """Return checksums of the expected codes of a codec for the normals of its domain; they are cached.

    Returns:
        `normals`: the checksum of the normals. `groups`: a checksum for each group of codes; `numbers`: a checksum
        for each number of the codes; `sample`: the codes of every STRIDE-th normal, in the order of the numbers
        that they stand for; all three as base64 of 32-bit integers. `mean_deg`, `max_deg`: the mean and the largest
        angle between the normals and their decoded codes, in degrees.

    Raises:
        ShaderError, NoDeviceError: the encoding has no Python twin, and OpenGL cannot run it.
        OSError: the encoding's files cannot be read.
    """
    key = kept.key_of("live", codec.name, codec.encoding.fingerprint, repr(codec.storage), sources())
    return kept.kept(key, lambda: _codec_checks(codec))


def _codec_checks(codec: Codec) -> dict[str, Any]:
    n, view = normals.normals(codec.encoding.domain)
    reference = reference_of(codec, n, view, compiled=False)
    codes = ordered(codec, reference)
    angles = angles_deg(n, reference.decoded)
    # What is not a number is as far as can be.
    angles = np.where(np.isfinite(angles), angles, 180.0)
    return {
        "normals": sums(codec.encoding.domain)[0],
        "groups": _base64_text(group_sums(codes), "<u4"),
        "numbers": _base64_text(np.array([checksum(number) for number in codes.T], np.uint32), "<u4"),
        "sample": _base64_text(codes[::STRIDE], "<i4"),
        "mean_deg": float(angles.mean()),
        "max_deg": float(angles.max()),
    }


def ordered(codec: Codec, reference: Reference) -> np.ndarray:
    """Return a reference's codes as integers in the order of the numbers that they stand for, int32 of shape (count,
    components). One step of a number is a difference of 1."""
    channels = Channels(codec).channels
    whole = [signed(channel, reference.integers[:, i]) for i, channel in enumerate(channels)]
    return np.stack(whole, axis=1).astype(np.int32)


def weights() -> np.ndarray:
    """Return an odd weight for each number of each code in a group, uint32 of shape (GROUP, NUMBERS)."""
    index = np.arange(GROUP * NUMBERS, dtype=np.uint32).reshape(GROUP, NUMBERS)
    return hashed(np.uint32(normals.WEIGHTS) + index) | np.uint32(1)


def group_sums(codes: np.ndarray) -> np.ndarray:
    """Return a checksum for each group of codes, their weighted sum modulo 2^32: uint32 of shape (count / GROUP,)."""
    size = codes.shape[1]
    weighted = codes.view(np.uint32).reshape(-1, GROUP, size) * weights()[:, :size]
    return weighted.sum(axis=(1, 2), dtype=np.uint32)


def _base64_text(values: np.ndarray, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode("ascii")
