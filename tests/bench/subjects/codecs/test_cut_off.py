"""Findings for truncated codes, however they are packed, and no findings for rounded codes."""

import re

import numpy as np
import pytest

from normalbench.bench.ground.directions import directions, unit
from normalbench.bench.subjects.codecs.doctor.cut_off import cut_off
from normalbench.bench.subjects.codecs.doctor.probe import Probe, trip_of


def octahedral(n):
    p = n / np.abs(n).sum(axis=1, keepdims=True)
    return np.where(n[:, 2:] < 0, (1 - np.abs(p[:, 1::-1])) * np.where(p[:, :2] < 0, -1, 1), p[:, :2])


def of_octahedral(c):
    z = 1 - np.abs(c).sum(axis=1, keepdims=True)
    return unit(np.concatenate([c - np.where(c < 0, -1, 1) * np.maximum(-z, 0), z], axis=1))


def of_xy(c):
    return np.concatenate([c, np.sqrt(np.maximum(0, 1 - (c**2).sum(axis=1, keepdims=True)))], axis=1)


def angles(n):
    return np.stack([np.arctan2(n[:, 1], n[:, 0]) / np.pi, n[:, 2]], axis=1)


def of_angles(c):
    across = np.sqrt(np.maximum(0, 1 - c[:, 1] ** 2))
    return np.stack([np.cos(c[:, 0] * np.pi) * across, np.sin(c[:, 0] * np.pi) * across, c[:, 1]], axis=1)


MAPS = {
    "octahedral": (octahedral, of_octahedral, -1.0),
    "xy": (lambda n: n[:, :2], of_xy, 0.0),
    "xyz": (lambda n: n, unit, -1.0),
    "angles": (angles, of_angles, -1.0),
}
BITS = {2: ((5, 5), (11, 10), (16, 16)), 3: ((8, 8, 8), (11, 11, 10))}
SIZED = [(name, bits) for name in MAPS for bits in BITS[3 if name == "xyz" else 2]]
# A number in [0, 1] and the largest integer to an integer, and back.
RIGHT = {
    "rounded": (lambda x, most: np.floor(x * most + 0.5), lambda i, most: i / most),
    "the half added by decode": (lambda x, most: np.floor(x * most), lambda i, most: (i + 0.5) / most),
    "as many steps as codes": (
        lambda x, most: np.minimum(np.floor(x * (most + 1)), most),
        lambda i, most: (i + 0.5) / (most + 1),
    ),
}
CUT = {
    "cut off": (lambda x, most: np.floor(x * most), lambda i, most: i / most),
    "cut off upwards": (lambda x, most: np.ceil(x * most), lambda i, most: i / most),
    "256 steps": (lambda x, most: np.minimum(np.floor(x * (most + 1)), most), lambda i, most: i / (most + 1)),
}


def said(name, bits, encode, decode) -> list[str]:
    """Return the findings for a map in integers of given bits, packed into one float64 that hides the integers."""
    to, back, least = MAPS[name]
    most = [2.0**size - 1 for size in bits]
    places = np.cumprod([1, *(top + 1 for top in most[:-1])])

    def packed(n):
        numbers = to(n.astype(np.float64)) * 0.5 + 0.5
        return (
            sum(encode(x, top) * place for x, top, place in zip(numbers.T, most, places, strict=True))[:, None] / 2**40
        )

    def unpacked(code):
        whole = code[:, 0] * 2**40
        numbers = [decode(whole // place % (top + 1), top) for top, place in zip(most, places, strict=True)]
        return back(np.stack(numbers, axis=1) * 2 - 1)

    probe = Probe(packed, unpacked, 1, is_packed=True)
    n = directions()
    trip = trip_of(probe, n[n[:, 2] > least])
    return list(cut_off(trip.of(trip.is_finite), probe))


@pytest.mark.parametrize("way", RIGHT)
@pytest.mark.parametrize("name, bits", SIZED)
def test_a_code_in_the_middle_of_its_directions_has_no_findings(name, bits, way):
    assert said(name, bits, *RIGHT[way]) == []


@pytest.mark.parametrize("way", CUT)
@pytest.mark.parametrize("name, bits", SIZED)
def test_truncated_code_is_reported(name, bits, way):
    """For every map, bit count and side, rounding would halve the error."""
    assert said(name, bits, *CUT[way]) == ["codes are truncated instead of rounded: rounding would halve the error"]


def of_signed(cut):
    """Return encode and decode for [-1, 1] as signed integers in two's complement: (x * 2 - 1) * (most // 2)."""

    def encode(x, most):
        return cut((x * 2 - 1) * (most // 2)) % (most + 1)

    def decode(i, most):
        return (i - np.where(i > most // 2, most + 1, 0)) / (most // 2) * 0.5 + 0.5

    return encode, decode


@pytest.mark.parametrize("bits", BITS[2])
def test_truncated_signed_codes_are_reported(bits):
    """Truncation is toward 0, which cancels the shifts of the quadrants, or downwards."""
    expected = ["codes are truncated instead of rounded: rounding would halve the error"]
    for cut in (np.trunc, np.floor):
        assert said("octahedral", bits, *of_signed(cut)) == expected
    assert said("octahedral", bits, *of_signed(lambda x: np.floor(x + 0.5))) == []


def test_xyz_truncated_toward_0_is_reported_as_shifted():
    """Renormalisation removes most of the shift."""
    (line,) = said("xyz", (8, 8, 8), *of_signed(np.trunc))
    assert line.startswith("codes are shifted, ") and 70 < int(re.findall(r"(\d+)%", line)[0]) < 85, line
    assert said("xyz", (8, 8, 8), *of_signed(lambda x: np.floor(x + 0.5))) == []


def test_truncation_of_one_of_two_numbers_is_reported():
    """The finer number is truncated, the other rounded. Rounding both leaves 0.79 of the root mean square error."""

    def encode(x, most):
        return np.floor(x * most + (0.5 if most == 2**10 - 1 else 0.0))

    (line,) = said("octahedral", (11, 10), encode, RIGHT["rounded"][1])
    assert line.startswith("codes are truncated instead of rounded: rounding would reduce the error to"), line
    assert 74 < float(line.split()[-1].rstrip("%")) < 84, line


def test_scale_of_one_step_is_not_mistaken_for_truncation():
    (line,) = said("octahedral", (8, 8), lambda x, most: np.floor(x * (most - 1) + 0.5), lambda i, most: i / most)
    assert line.startswith("codes are shifted, "), line
