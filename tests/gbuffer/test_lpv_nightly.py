"""Light propagation volumes: another format and another pipeline."""

import test_lpv_slow


def test_volumes_work_with_a_shared_exponent(gl):
    test_lpv_slow.test_the_formats_of_volumes_and_sums_have_the_expected_accuracy(gl, {"format": "shared"}, 38)


def test_hybrid_adds_the_volumes_to_the_ambient_light(gl):
    test_lpv_slow.test_a_pipeline_adds_the_volumes_to_the_ambient_light(gl, "hybrid")
