"""Normal encodings: both backends have the same errors, and every direction comes back."""

import pytest

from normalbench.bench.subjects.normals.normal_sets import hemisphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES


@pytest.mark.usefixtures("gl")
def test_both_languages_use_the_same_stereographic_scale():
    """At scale 1 the disk covers the hemisphere, and both languages are more accurate there than at scale 1.7777."""
    psnr = {}
    for scale in (1.0, 1.7777):
        codec = Codec(ENCODINGS["stereographic"].with_parameters({"scale": scale}), STORAGES["rgba8"])
        for backend in ("jax", "glsl"):
            row = quality.measure(quality.QualityCase(codec, hemisphere(2**18), backend))
            psnr[scale, backend] = row["psnr_db"]
        assert abs(psnr[scale, "jax"] - psnr[scale, "glsl"]) <= 0.02, psnr
    assert psnr[1.0, "jax"] > psnr[1.7777, "jax"] + 3, psnr
