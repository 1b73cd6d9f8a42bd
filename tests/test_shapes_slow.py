"""Annotations of array shapes are true in every call that other tests make."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
# Each function whose annotations say shapes is called by one of them.
RUN = (
    "bench/measures/metrics/test_metrics.py",
    "bench/measures/metrics/test_visibility.py",
    "bench/measures/metrics/test_visibility_slow.py",
    "bench/tables/test_depth_images.py",
    "bench/tables/test_lights.py::test_the_bound_is_half_a_code_per_blend",
    "bench/tables/test_lights_slow.py::test_the_device_sums_lights_like_the_model_with_the_same_rounding",
    "bench/tables/test_render.py::test_flip_is_measured_on_request",
    "bench/tables/test_render.py::test_two_encoders_with_the_same_name_have_separate_rows",
    "encodings/test_curve_encodings.py",
    "encodings/test_depth.py",
    "encodings/test_fingerprint.py",
    "encodings/test_frame_encodings.py",
    "encodings/test_kinds.py::test_codecs_of_every_kind_have_the_same_interface",
    "encodings/test_light_encodings.py",
    "encodings/test_motion_encodings.py",
    "encodings/test_normal_encodings.py",
    "encodings/test_storage.py::test_floats_of_any_form_round_to_nearest_or_toward_zero",
)


@pytest.mark.usefixtures("gl")
def test_every_call_has_the_annotated_shapes():
    """If an array has another shape, pytest shows the array and its function."""
    words = "import sys, shape_checks; sys.exit(shape_checks.main(*sys.argv[1:]))"
    given = (
        "-n",
        "0",
        "-q",
        "--tb",
        "short",
        "--maxfail",
        "5",
        "-p",
        "no:cacheprovider",
        *(str(TESTS / name) for name in RUN),
    )
    # What xdist tells its workers is not for it.
    own = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment = {**own, "PYTHONPATH": str(TESTS / "inputs")}
    done = subprocess.run([sys.executable, "-c", words, *given], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-20_000:] + done.stderr
