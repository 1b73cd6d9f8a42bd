"""Generated C with arbitrary input: no undefined behaviour, and the same results at each optimisation level."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from everyday import GLSL
from languages import require_runner
from typed import codecs_named, read_encoding

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.run import c
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

SANITIZERS = ("-g", "-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all")


COUNT = 3000


# Those that compute with whole numbers, read tables or divide; the nightly has all, and the largest table.
FEW = (
    "spherical_fibonacci/rg8",
    "spherical_lut/rg8",
    "octahedral_precise/rgb10a2",
    "xyz/rgba8_snorm",
)


def hostile():
    """Return COUNT vectors, views and texels: pairs of odd numbers, unit vectors, then arbitrary bits."""
    odd = [0.0, -0.0, 1.0, -1.0, np.inf, -np.inf, np.nan, 1e-40, -1e-40, 3e38, -3e38, 2.0**31, 2.0**32, 1e10, 0.5]
    rng = np.random.default_rng(0)
    few = np.array(list(itertools.product(odd, odd, (0.0, -1.0, np.nan))), np.float32)
    unit = rng.normal(size=(COUNT // 3, 3)).astype(np.float32)
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    anything = rng.integers(0, 2**32, (COUNT, 3), np.uint64).astype(np.uint32).view(np.float32)
    n = np.concatenate([few, unit, anything])[:COUNT]
    view = np.roll(n[::-1], 1, axis=1)
    texels = rng.integers(0, 2**32, (COUNT, 4), np.uint64).astype(np.uint32).view(np.float32)
    texels[:1000] = rng.choice(odd, (1000, 4))
    return n, view, texels


def ran(codec, folder):
    """Return the results that differ between -O0 and -O2 under the sanitizers, or an empty string."""
    code = code_of(codec, "c", "p")
    for name, data in code.files([]).items():
        (folder / name).write_bytes(data)
    runs = []
    # Behind the wall that is around users' code a sanitizer cannot look at its own process.
    interface = replace(code.interface, is_ours=True)
    for level in ("-O0", "-O2"):
        with c.built(folder / code.name, interface, "cc", [level, "-ffp-contract=off", *SANITIZERS]) as run:
            runs.append(run(*hostile()))
    # The bits of what is no number are nobody's business.
    same = [np.array_equal(a, b, equal_nan=a.dtype.kind == "f") for a, b in zip(*runs, strict=True)]
    return "" if all(same) else f"{codec.name}: -O0 and -O2 differ in {dict(zip(runs[0]._fields, same, strict=True))}"


def codec_of(name):
    (codec,) = codecs_named(*name.split("/"), "nearest")
    return codec


@pytest.mark.parametrize("name", FEW)
def test_c_code_is_well_defined_for_any_input(name, tmp_path):
    """3000 arbitrary vectors, views and texels pass the sanitizers and give the same results at -O0 and -O2."""
    require_runner("c")
    wrong = ran(codec_of(name), tmp_path)
    assert not wrong, wrong


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("name", ["guard before a table", "conversions", "vector by a number", "hexadecimal numbers"])
def test_c_code_of_a_users_shader_is_well_defined_for_any_input(name, tmp_path):
    """C defines the results that GLSL leaves undefined."""
    require_runner("c")
    (tmp_path / "mine.glsl").write_text(GLSL[name])
    wrong = ran(Codec(read_encoding(tmp_path / "mine.glsl"), STORAGES["rg16"], "nearest"), tmp_path)
    assert not wrong, wrong
