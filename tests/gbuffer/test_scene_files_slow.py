"""Users' meshes as scenes: normals under every transform, the formats, cameras, and what bad files get."""

from dataclasses import replace

import numpy as np
import pytest
from written import as_document

from normalbench.bench.subjects.normals.normal_names import mesh_set
from normalbench.bench.subjects.normals.normal_sets import playground
from normalbench.bench.tables.quality.measure import Case, measure
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.scenes.built_in.playground import CAMERA, in_view_space


def test_the_playground_as_a_file_is_measured_as_the_playground(tmp_path):
    """By its own camera. Vertices are rounded to float32, which moves edges by a few pixels and figures by 0.01 dB."""
    document = as_document(in_view_space())
    lens = {"yfov": np.radians(CAMERA.fov), "znear": CAMERA.near, "zfar": CAMERA.far}
    document.json["cameras"] = [{"type": "perspective", "perspective": lens}]
    document.node(camera=0)
    made, _ = mesh_set(document.write(tmp_path / "playground.glb"), "640x480")
    assert made.background == pytest.approx(playground().background, abs=20)
    for name in ("xy", "octahedral"):
        case = Case(Codec(ENCODINGS[name], STORAGES["rgba8"]), made, "jax")
        figures = [measure(replace(case, normal_set=s))["psnr_db"] for s in (made, playground())]
        assert figures[0] == pytest.approx(figures[1], abs=0.01), name
