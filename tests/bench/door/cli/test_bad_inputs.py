"""The list of bad inputs, each with the tests that try it, and tests that fit no other file."""

import ast
import json
import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tiers import files_of
from typed import checked_numbers, first_look

from normalbench.bench.door.gates.limits import limit
from normalbench.bench.ground.output.errors import UsageError
from normalbench.gbuffer.codecs.loops import loop_limit

TESTS = Path(__file__).parents[3]


# Input, answer, and by file the tests that hold it.
ANSWERS = {
    "NaN or infinite normal in a file: masked and counted, over a share refused": {
        "test_captures": ["test_nan_is_refused_or_masked_and_counted_as_requested"],
        "test_bad_scene_files": ["test_bad_gltf_is_a_one_line_error", "test_bad_text_is_a_one_line_error"],
    },
    "zero-length normal: background, counted, never NaN": {
        "test_captures": ["test_zero_length_normals_are_background"],
    },
    "not unit, or packed as [0, 1]: refused with the option that would read it": {
        "test_captures": [
            "test_packed_floats_are_read_with_unpack",
            "test_floats_that_are_not_packed_are_not_read_with_unpack",
            "test_normals_that_are_not_unit_length_are_refused_with_their_lengths",
        ],
    },
    "truncated or corrupt EXR, glTF, OBJ, PLY: refused with file, place, remedy": {
        "test_bad_captures": [
            "test_truncated_exr_is_a_one_line_error",
        ],
        "test_attack": ["test_damaged_input_is_measured_or_refused_in_one_line"],
        "test_bad_scene_files": [
            "test_truncated_glb_is_a_one_line_error",
            "test_bad_text_is_a_one_line_error",
        ],
        "test_packed_scenes": [
            "test_bad_meshopt_view_is_a_one_line_error",
            "test_bad_draco_primitive_is_a_one_line_error",
        ],
    },
    "index out of range, node cycle: refused": {
        "test_bad_scene_files": ["test_bad_gltf_is_a_one_line_error", "test_bad_text_is_a_one_line_error"],
    },
    "path that leaves the folder, network address: refused, nothing is downloaded": {
        "test_bad_scene_files": ["test_nothing_is_read_outside_the_folder_or_from_the_network"],
    },
    "image or texture larger than the device or a budget: refused before allocation": {
        "test_bad_captures": [
            "test_exr_of_wrong_size_or_sampling_is_a_one_line_error",
            "test_bad_file_is_a_one_line_error",
        ],
        "test_bad_scene_files": ["test_large_files_are_refused_before_they_are_read"],
        "test_scene_textures": ["test_bad_image_is_a_one_line_error", "test_images_of_a_file_share_one_pixel_limit"],
        "test_render": ["test_bad_input_is_a_one_line_error_and_nothing_is_written"],
    },
    "a user's shader that does not compile: its file and line, other cases go on": {
        "test_user_encodings": ["test_invalid_file_does_not_affect_other_encodings"],
        "test_cli": ["test_a_users_broken_shader_loses_its_rows_and_is_an_error_if_measured_alone"],
    },
    "a user's shader that does not end: a process of its own, a time limit, loops counted": {
        "test_user_encodings": ["test_a_shader_that_does_not_end_or_kills_the_process_is_reported"],
        "test_bad_inputs": ["test_an_endless_loop_does_not_affect_other_encodings"],
    },
    "identical images: inf in tables, null and exact in JSON": {
        "test_bad_inputs": ["test_identical_normals_have_infinite_psnr"],
    },
    "no GL driver: JAX measures, GL rows skipped with the reason, what needs GL exits 3": {
        "test_cli": [
            "test_jax_measures_without_an_opengl_driver",
            "test_glsl_without_an_opengl_driver_exits_with_3_and_says_what_to_install",
        ],
        "test_plugin": ["test_jax_rows_are_checked_and_others_skipped_without_an_opengl_driver"],
    },
    "damaged, hostile or enormous device file: its place in one line, nothing is added, markup stays text": {
        "test_device_file": [
            "test_bad_file_is_a_one_line_error_with_its_name_and_location",
            "test_an_enormous_file_is_refused_before_it_is_read",
            "test_damaged_file_is_read_or_refused_with_a_one_line_error",
        ],
        "test_import": ["test_one_bad_file_of_several_leaves_the_run_as_it_was"],
        "test_devices_site": [
            "test_damaged_files_are_reported_and_left_out",
            "test_markup_in_a_device_file_stays_text",
        ],
    },
    "interrupted run, full disk: finished rows are kept, running again resumes": {
        "test_killed_writers": ["test_a_writer_killed_before_any_of_its_changes_leaves_whole_files"],
        "test_cli": ["test_a_run_that_fails_at_the_end_keeps_its_rows_and_no_partial_table"],
    },
    "fuzzed TOML and gate expressions: one line, soon, nothing else opened": {
        "test_attack": ["test_damaged_input_is_measured_or_refused_in_one_line"],
        "test_bad_inputs": ["test_thresholds_are_read_or_refused"],
        "test_check": ["test_no_gate_causes_a_traceback"],
    },
}


def _tests_in(name: str) -> set[str]:
    trees = [ast.parse(path.read_text()) for path in files_of(TESTS, name)]
    return {node.name for tree in trees for node in tree.body if isinstance(node, ast.FunctionDef)}


@pytest.mark.parametrize("what", ANSWERS)
def test_every_answer_has_its_tests(what):
    for file, names in ANSWERS[what].items():
        assert set(names) <= _tests_in(file), f"{file} has no {set(names) - _tests_in(file)}"


@contextmanager
def soon(seconds: float = 2.0) -> Iterator[None]:
    start = time.process_time()
    yield
    taken = time.process_time() - start
    assert taken < seconds, f"{taken:.1f} s"


LOOPS = """
vec2 mine_encode(vec3 n, vec3 view) {
    float s = 0.0;
    %s
    return n.xy * (s >= 0.0 ? 1.0 : 0.5);
}
vec3 mine_decode(vec2 e, vec3 view) {
    return vec3(e, sqrt(max(0.0, 1.0 - dot(e, e))));
}
"""


TOO_LONG = {
    "while": "while (s < 1.0) { s *= 0.5; }",
    "for": "for (int i = 0; i >= 0; s += 1e-9) ;",
    "for without a condition": "for (;;) { if (n.x > 2.0) break; s += 1.0; }",
    "do": "do { s += n.z * n.z * 1e-9; } while (s < 1.0 /* ) */);",
    "for too long": "for (int i = 0; i < 100000; i++) { s += 1e-5; }",
    "one in another": "for (int i = 0; i < 256; i++) for (int j = 0; j < 256; j++) s += 1e-9;",
    "one after another": "for (int i = 0; i < 40000; i++) s += 1e-9; for (int i = 0; i < 40000; i++) s += 1e-9;",
    "a keyword by another name": "REPEAT (s < 0.7) s += 1e-5;",
    "in a function": "for (int i = 0; i < 300; i++) s += inner(s);",
    "of few directions": "for (int i = 0; i < (n.z > 0.99 ? 70000 : 3); i++) s += 1e-9;",
}


BEFORE = """
#define REPEAT while
float inner(float s) { int left = 300; do { s *= 0.999; left--; } while (left > 0); return s; }
"""


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("what", TOO_LONG)
def test_a_loop_that_the_device_stops_is_reported(gl, tmp_path, what):
    """A software driver silently stops all loops of a shader at once, so its rows would be wrong."""
    path = tmp_path / "mine.glsl"
    path.write_text(BEFORE + LOOPS % TOO_LONG[what])
    most = loop_limit(gl)
    if not most:
        pytest.skip("this device makes all turns")
    message = first_look(path)["broken"]
    assert message.startswith("the loops of encode for [")
    assert f"this device silently ends a shader's loops after {most} iterations" in message


@pytest.mark.usefixtures("gl")
def test_loops_that_end_are_measured(tmp_path):
    """Two nested loops have 62,500 iterations in total."""
    path = tmp_path / "mine.glsl"
    path.write_text(
        LOOPS % "for (int i = 0; i < 250; i++) { int j = 0; while (true) { s += 1e-9; if (++j >= 250) break; } }"
    )
    assert "broken" not in first_look(path)


def test_identical_normals_have_infinite_psnr(run):
    command = ("quality", "--encoding", "xyz", "--storage", "rgba32f", "--normals", "axes", "--backend", "jax")
    (row,) = json.loads(run(*command, "--format", "json")[1])
    assert row["psnr_db"] is None and row["exact"] is True
    assert run(*command)[1].count(" inf ") == 2, "psnr_db and psnr_article_db"


@pytest.mark.usefixtures("gl")
def test_identical_frames_have_infinite_psnr(run):
    command = ("render", "--layout", "fp32", "--size", "64x48", "--lights", "2", "--repeats", "1")
    (row,) = json.loads(run(*command, "--format", "json")[1])
    assert row["psnr_db"] is None and row["exact"] is True and " inf " in run(*command)[1]


@pytest.mark.parametrize(
    "command", [("depth", "--near"), ("depth", "--distance"), ("lights", "--sum"), ("lights", "--counts")]
)
@pytest.mark.parametrize("text", ["", ",", "1,x", "nan", "-1", "0", "1e99", "9" * 5000])
def test_errors_about_lists_of_numbers_have_the_same_form(run, command, text):
    status, out, err = run(*command, text)
    assert (status, out) == (2, "") and err.count("\n") == 1
    shown = text.strip(",") if len(text) < 10 else f"{text[:6]}... ({len(text)} digits)"
    begin = f"normalbench: {command[1]} {shown}: "
    assert err.startswith(begin) and err.endswith(", comma-separated\n") and len(err) < 2000, err[-200:]


def test_repeated_numbers_in_a_list_are_kept_once():
    assert checked_numbers("--x", " 2,1,, 2 ,", int, 1, 2) == (2, 1)
    assert checked_numbers("--x", "0.5,1e0", float, 0.5, 1.0) == (0.5, 1.0)


TEXTS = st.one_of(
    st.text(max_size=50),
    st.tuples(
        st.sampled_from(["at least", "at most", " AT  LEAST", "at\tmost", "about"]),
        st.sampled_from(["", " ", "\n ", "\u00a0"]),
        st.one_of(st.text("0123456789.e+-", max_size=12), st.floats().map(str), st.text(max_size=8)),
    ).map("".join),
)


@settings(max_examples=500, deadline=None, derandomize=True)
@given(TEXTS)
def test_thresholds_are_read_or_refused(text):
    """A threshold is read exactly or refused in one line; for any other text the result is None."""
    try:
        bound = limit("psnr_db", text)
    except UsageError as error:
        assert str(error).startswith("psnr_db: ") and "is not a " in str(error)
        return
    if bound:
        assert bound.side in ("at least", "at most") and not math.isnan(bound.value)
        assert limit("psnr_db", str(bound)).value == pytest.approx(bound.value, rel=1e-8)


@pytest.mark.parametrize("text", ["1" * 10**6, " " * 10**6, "1." * 10**6, "x" + " " * 10**6 + "y", "e" * 10**6])
def test_a_very_long_threshold_is_read_quickly(text):
    with soon():
        for side in ("at least ", "at most\n"):
            try:
                assert limit("x", side + text) is None or math.isinf(limit("x", side + text).value)
            except UsageError as error:
                assert len(str(error)) < 100


LONG = "d" * 5000


FRAME = {"fov": 60, "near": 0.1, "far": 9, "depth": {"file": f"{LONG}.exr"}, "normal": {"file": "n.exr"}}


BUFFERS = {"asset": {"version": "2.0"}, "buffers": [{"uri": f"{LONG}.bin", "byteLength": 36}]}


POINTS = {
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "nodes": [{"mesh": 0}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
}


@pytest.mark.parametrize(
    ("name", "text", "command"),
    [
        ("a.json", json.dumps(FRAME | {"basecolor": [1, 1, 1], "roughness": 1}), "budget --bytes 12 --scene a.json"),
        ("a.gltf", json.dumps(BUFFERS | POINTS), "quality --backend jax --normals a.gltf#vertices"),
        ("a.obj", f"mtllib {LONG}.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "quality --backend jax --normals a.obj"),
        ("a.toml", f"[[gate]]\nnormals = '{LONG}.png'\npsnr_db = 'at least 1'\n", "check a.toml"),
        ("a", "", f"quality --backend jax --normals {LONG}.ply"),
        ("a", "", f"history {LONG} {LONG}"),
    ],
)
def test_a_name_that_is_too_long_is_reported(run, tmp_path, monkeypatch, name, text, command):
    """The message does not mention writing, and its end is not truncated."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_text(text)
    status, out, err = run(*command.split())
    assert (status, out) == (2, "") and "write" not in err, err
    assert err.endswith(("its name is too long\n", "File name too long\n")) and err.count("\n") == 1, err
