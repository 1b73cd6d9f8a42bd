"""A run with an encoder, a capture, a scene and a layout of one's own: its rows, its page and what `compare` says."""

from normalbench.bench.door.run import options_of
from normalbench.bench.tables.quality.table import QualityOutputs
from normalbench.bench.tables.registry import TABLES

NO_FILES = QualityOutputs()


def test_a_layout_is_measured_as_it_is_unless_an_encoding_is_said():
    said = ({}, {"encoding": "xyz"}, {"storage": "rg8"})
    (as_it_is,), (put_in,), (usual,) = (options_of(TABLES["render"], {"layout": "mine.toml"} | one) for one in said)
    assert (as_it_is.encoding, as_it_is.repeats, put_in.encoding) == (None, 0, ("xyz",))
    assert usual.encoding and usual.storage == ("rg8",), "a storage alone is for what is usual"


def test_a_named_encoding_is_measured_on_all_that_it_is_made_for():
    """Of the scene and a hemisphere alone, half of the directions of a code of the sphere are met by luck."""
    quality = TABLES["quality"]
    said = options_of(quality, {"encoding": "octahedral,xy", "storage": "rg8", "backend": "jax"})
    met = {(step.key["encoding"], step.key["normals"]) for one in said for step in quality.work.steps(one, NO_FILES)}
    both = {(name, on) for name in ("octahedral", "xy") for on in ("playground", "hemisphere")}
    assert met == both | {("octahedral", "sphere"), ("octahedral", "axes")}
    assert {one.normals for one in options_of(quality, {"storage": "rg8"})} == {("playground", "hemisphere")}
    assert {one.normals for one in options_of(quality, {"encoding": "xy", "normals": "axes"})} == {("axes",)}
