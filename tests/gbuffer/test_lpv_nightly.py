"""Light propagation volumes: a further format and a further pipeline."""

import test_lpv_slow


def test_a_shared_exponent_of_the_volumes(gl):
    test_lpv_slow.test_formats_of_the_volumes_and_of_sums(gl, {"format": "shared"}, 38)


def test_hybrid_adds_it_to_the_ambient_light(gl):
    test_lpv_slow.test_a_pipeline_adds_it_to_the_ambient_light(gl, "hybrid")
