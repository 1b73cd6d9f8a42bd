"""Generated code of light, quantities, motion and depth for values that no image should contain: its texels equal
the catalogue's, which encodings/test_odd_values.py compares with the specifications of the formats."""

from itertools import product

import numpy as np
import pytest
from languages import RUN, require_runner
from test_code_kinds import codec_of

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.kinds.depth import FAR, NEAR
from normalbench.bench.shaders.code.reference import Reference, reference_of
from normalbench.bench.shaders.code.run import runner
from normalbench.encodings.catalogue import CURVE_ENCODINGS, DEPTH_ENCODINGS, LIGHT_BUFFERS, MOTION_ENCODINGS

ODD = np.float32([np.nan, np.inf, -np.inf, 3e38, -3e38, -1.0, -1e-3, 1e-42, -1e-42, -0.0, 0.0, 0.25, 65409, 65520])


CODECS = [
    *(
        ("light", codec.encoding.name, codec.storage.name)
        for codec in LIGHT_BUFFERS.values()
        if not codec.storage.curved
    ),
    *(("curve", name, "r8") for name in CURVE_ENCODINGS),
    *(("motion", name, storage) for name in MOTION_ENCODINGS for storage in ("rg8", "rg16f")),
    *(("depth", name, "packed24") for name in DEPTH_ENCODINGS),
]


SETTINGS = {"curve": (1.0, 0.0), "motion": (0.125, 0.0), "depth": (NEAR, FAR), "light": (0.0, 0.0)}


def given(kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Return every triple of odd values, padded for light, and the settings of the kind's functions."""
    rows = np.array(list(product(ODD, repeat=3)), np.float32)
    n = np.pad(rows, ((0, 0), (0, 1))) if kind == "light" else rows
    return n, np.broadcast_to(np.float32([*SETTINGS[kind], 0.0]), (len(rows), 3))


@pytest.mark.drawn(3)
@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind, name, storage, language", [(*codec, "c") for codec in CODECS])
def test_code_gives_the_catalogues_texels_for_odd_values(kind, name, storage, language, tmp_path):
    """Values next to a tie may differ by one step; the bits of NaN are not specified."""
    require_runner(language)
    codec = codec_of(kind, name, storage)
    code = code_of(codec, language, "p")
    for file, data in code.files([]).items():
        (tmp_path / file).write_bytes(data)
    expected = reference_of(codec, *given(kind), compiled=False)
    ran = runner(language).run(tmp_path / code.name, code.interface, expected.n, expected.view, expected.texels)
    wrong = differing(expected, ran)
    assert not wrong.any(), (
        f"{wrong.sum()} of {len(wrong)}: {expected.n[wrong][0]} is decoded to {ran.decoded[wrong][0]}, "
        f"not {expected.decoded[wrong][0]}; words {ran.words[wrong][0]}, not {expected.words[wrong][0]}"
    )


def differing(expected: Reference, ran) -> np.ndarray:
    """Return a mask of the values that decode differently."""
    with np.errstate(invalid="ignore"):
        apart = np.abs(ran.decoded.astype(np.float64) - expected.decoded)
        near = apart <= 0.01 * np.abs(expected.decoded) + 1e-6
    alike = near | np.equal(ran.decoded, expected.decoded) | (np.isnan(ran.decoded) & np.isnan(expected.decoded))
    return ~alike.all(axis=1)


# What C's compiler alone does not show: each language has its own max, and a way of its own to compare.
FEW = [
    ("light", "rgb9e5", "rgba8"),
    ("light", "log", "rgba8"),
    ("curve", "srgb", "r8"),
    ("depth", "window", "packed24"),
]


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(
    "kind, name, storage, language", [(*codec, language) for codec in FEW for language in RUN if language != "c"]
)
def test_code_gives_the_catalogues_texels_for_odd_values_in_other_languages(kind, name, storage, language, tmp_path):
    test_code_gives_the_catalogues_texels_for_odd_values(kind, name, storage, language, tmp_path)
