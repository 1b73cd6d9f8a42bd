"""A run with a user's encoder, capture, scene and layout: its rows, its page and the output of `compare`."""

from normalbench.bench.door.run import options_of
from normalbench.bench.tables.quality.table import QualityOutputs
from normalbench.bench.tables.registry import TABLES

NO_FILES = QualityOutputs()


def test_a_layout_is_measured_unchanged_unless_an_encoding_is_given():
    asks = ({}, {"encoding": "xyz"}, {"storage": "rg8"})
    (as_it_is,), (put_in,), (usual,) = (options_of(TABLES["render"], {"layout": "mine.toml"} | ask) for ask in asks)
    assert (as_it_is.encoding, as_it_is.repeats, put_in.encoding) == (None, 0, ("xyz",))
    assert usual.encoding and usual.storage == ("rg8",), "a storage alone is for what is usual"


def test_a_named_encoding_is_measured_on_its_whole_domain():
    """The scene and a hemisphere would cover only half of the directions of an encoding of the sphere."""
    quality = TABLES["quality"]
    asks = options_of(quality, {"encoding": "octahedral,xy", "storage": "rg8", "backend": "jax"})
    met = {(step.key["encoding"], step.key["normals"]) for ask in asks for step in quality.work.steps(ask, NO_FILES)}
    both = {(name, on) for name in ("octahedral", "xy") for on in ("playground", "hemisphere")}
    assert met == both | {("octahedral", "sphere"), ("octahedral", "axes")}
    assert {ask.normals for ask in options_of(quality, {"storage": "rg8"})} == {("playground", "hemisphere")}
    assert {ask.normals for ask in options_of(quality, {"encoding": "xy", "normals": "axes"})} == {("axes",)}
