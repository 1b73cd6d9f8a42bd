"""`normalbench motion`: the wobble of codes, highlights and images, animations, and bad input."""

import json
import math

import numpy as np
import pytest
from PIL import Image
from typed import codecs_named

from normalbench.bench.measures.metrics.totals import psnr_db
from normalbench.bench.tables.motion import highlights, panel, turning
from normalbench.bench.tables.motion.code_wobble import Motion, code_wobble
from normalbench.bench.tables.motion.measure import Differences, in_space, on_surfaces
from normalbench.bench.tables.motion.table import MotionOptions
from normalbench.bench.tables.motion.trips import trip_of
from normalbench.bench.tables.motion.work import motions, picture_turns
from normalbench.gbuffer.scenes.scene import TURNS, View
from normalbench.reports.page.pixels import MAX_FILM, film_uri

COUNT, SEED = 2**14, 0


SMALL = ("--count", "2048", "--frames", "4", "--size", "96x72", "--lights", "2")


def wobble(name, space="view", moves="camera", axis="yaw", turn=0.25, frames=32, count=COUNT, seed=SEED):
    (codec,) = codecs_named(name, "rgba8", "nearest")
    with trip_of(codec) as trip:
        return code_wobble(trip, codec.encoding.domain, Motion(space, moves, axis, turn, frames), count, seed)


def ramp(step):
    """Return the round trip of a linear ramp: the angle about y, in steps of `step` degrees."""

    def trip(n, _):
        angle = np.degrees(np.arctan2(n[:, 0].astype(float), n[:, 2]))
        code = np.rint(angle / step)
        stored, out = np.radians(code * step), np.hypot(n[:, 0], n[:, 2]).astype(float)
        return code[:, None], np.stack([np.sin(stored) * out, n[:, 1], np.cos(stored) * out], axis=1)

    return trip


@pytest.mark.parametrize("codes_a_frame", [0.05, 0.25, 0.5, 7.1])
def test_a_linear_ramp_wobbles_like_a_sawtooth(codes_a_frame):
    """A sawtooth's autocorrelation at a lag of f periods is 1 - 6 f (1 - f), so the ratio is sqrt(6 f (1 - f)). The
    share of codes that change per frame is at most 1."""
    step = 0.5
    motion = Motion("view", "camera", "yaw", codes_a_frame * step, 8)
    row = code_wobble(ramp(step), "sphere", motion, COUNT, SEED)
    f = codes_a_frame % 1
    assert row["ratio"] == pytest.approx(math.sqrt(6 * f * (1 - f)), rel=0.03)
    assert row["jumps_percent"] == pytest.approx(100 * min(codes_a_frame, 1), rel=0.03)
    assert row["static_rms_deg"] < step / math.sqrt(12)


def linear_colour(n, _):
    """Return the code and the decoded normal: x is a linear ramp in 8 bits, and y and z are exact."""
    code = np.rint(n[:, 0].astype(float) * 127.5)
    return code[:, None], np.stack([code / 127.5, n[:, 1], n[:, 2]], axis=1)


def test_a_ramp_of_many_codes_per_frame_is_noise():
    """A linear colour ramp at up to 18 codes per frame, each point at its own speed, has a ratio of 1, within 5%. Of
    three such channels, yaw leaves y unchanged: a third of the squared error stays."""
    motion = Motion("view", "camera", "yaw", 8.0, 16)
    assert code_wobble(linear_colour, "sphere", motion, COUNT, SEED)["ratio"] == pytest.approx(1, rel=0.05)
    assert wobble("xyz_renormalised", turn=8.0, frames=16)["ratio"] == pytest.approx(math.sqrt(2 / 3), rel=0.03)


@pytest.mark.parametrize("axis", TURNS)
@pytest.mark.parametrize("name", ["octahedral", "spheremap", "best_fit"])
def test_a_code_in_world_space_does_not_change_while_a_camera_turns(name, axis):
    """The code is the same to the bit, but changes while an object turns."""
    row = wobble(name, "world", "camera", axis, frames=4, count=4096)
    assert (row["wobble_deg"], row["jumps_percent"], row["ratio"]) == (0, 0, 0) and row["static_rms_deg"] > 0
    assert wobble(name, "world", "object", axis, frames=4, count=4096)["ratio"] > 0.3


def test_only_normals_in_an_encodings_domain_count():
    """Normals with z < 0 would come back from `xy` mirrored, about 100 degrees off."""
    row = wobble("xy", turn=1.0, count=4096)
    assert row["static_rms_deg"] < 5 and 0 < row["wobble_deg"] < 5


@pytest.mark.parametrize("axis", TURNS)
def test_an_error_that_turns_with_the_surface_is_not_wobble(axis):
    """An offset along n x k stays on a surface turning about k, and turns by 40 degrees per frame in view space."""
    k = np.eye(3)[TURNS.index(axis)]

    def swirl(n, _):
        return np.zeros((len(n), 1)), n + 1e-3 * np.cross(n, k)

    row = code_wobble(swirl, "sphere", Motion("view", "camera", axis, 40.0, 3), 1000, SEED)
    assert row["ratio"] < 1e-3 < row["static_rms_deg"] and row["jumps_percent"] == 0, row


def test_nan_counts_as_the_opposite_direction():
    def broken(n, _):
        return np.zeros((len(n), 1)), np.where(np.arange(len(n))[:, None] % 2, np.nan, n)

    row = code_wobble(broken, "sphere", Motion("view", "camera", "yaw", 1.0, 2), 1000, SEED)
    assert row["invalid"] == 1000 and row["static_rms_deg"] == pytest.approx(math.degrees(math.sqrt(2)), rel=1e-5)


def test_a_turn_goes_back_and_forth():
    """All steps have the same size and stay within the swing; a step beyond the swing goes there and back."""
    assert turning.angles(10.0, 8).tolist() == [0, 10, 20, 30, 20, 10, 0, 10]
    assert turning.angles(45.0, 4).tolist() == [0, 45, 0, 45]
    angles = turning.angles(0.25, 1000)
    assert angles.max() == turning.SWING_DEG and set(np.abs(np.diff(angles)).round(9)) == {0.25}


@pytest.mark.parametrize(
    "axis, forward, up",
    [("yaw", (-1, 0, 0), (0, 1, 0)), ("pitch", (0, 1, 0), (0, 0, 1)), ("roll", (0, 0, -1), (-1, 0, 0))],
)
def test_a_camera_turns_left_up_and_counter_clockwise(axis, forward, up):
    """The camera turns by 90 degrees on the spot; a full turn brings it back."""
    view = View((1.0, 2.0, 3.0), (1.0, 2.0, 0.0), 40.0, 1.0, 10.0)
    turned = view.turned(axis, 90.0)
    assert np.subtract(turned.target, turned.eye) / 3 == pytest.approx(forward, abs=1e-12)
    assert turned.matrix()[1, :3] == pytest.approx(up, abs=1e-12) and turned.eye == view.eye
    assert view.turned(axis, 360.0).matrix() == pytest.approx(view.matrix(), abs=1e-12)


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    return tmp_path_factory.mktemp("pictures")


@pytest.mark.parametrize("axis", TURNS)
def test_a_camera_orbits_its_target(axis):
    """The camera keeps its distance and its target, and turns as it would on the spot."""
    view = View((3.0, 2.0, 5.0), (1.0, 0.0, -1.0), 40.0, 0.1, 20.0)
    gone = panel.around(view, axis, 7.0)
    assert np.linalg.norm(np.subtract(gone.eye, gone.target)) == pytest.approx(np.sqrt(44))
    assert gone.target == view.target
    assert gone.matrix()[:3, :3] == pytest.approx(view.turned(axis, 7.0).matrix()[:3, :3])


def test_codes_on_surfaces_match_a_turned_camera():
    """A normal and its position are turned, encoded, decoded and turned back."""
    (codec,) = codecs_named("octahedral", "rg8", "nearest")
    n = np.array([[0.48, 0.6, 0.64]], np.float32)
    matrix = turning.rotations("roll", 30.0, 2)[1]
    with trip_of(codec) as trip:
        decoded = on_surfaces(trip, matrix, matrix)(n, n)
        by_hand = trip((n @ matrix.T).astype(np.float32), n)[1] @ matrix
    assert decoded == pytest.approx(by_hand, abs=1e-6)


def test_a_code_in_world_space_is_the_same_from_every_camera():
    """In world space the G-buffer stores the same normal for two cameras; in view space it does not."""
    (codec,) = codecs_named("octahedral", "rg8", "nearest")
    n = np.array([[0.48, 0.6, 0.64], [-0.36, 0.48, 0.8]])
    first = View((0.0, 0.0, 5.0), (0.0, 1.0, 0.0), 40.0, 1.0, 10.0)
    differences = {}
    with trip_of(codec) as trip:
        for space in turning.SPACES:
            seen = []
            for view in (first, first.turned("roll", 20.0).turned("yaw", 7.0)):
                to_view = view.matrix()[:3, :3]
                mine = (n @ to_view.T).astype(np.float32)
                seen.append(in_space(trip, space, view)(mine, mine) @ to_view)
            differences[space] = np.abs(seen[0] - seen[1]).max()
    assert differences["world"] < 1e-6 and differences["view"] > 1e-3, differences


def test_a_highlight_is_at_the_centroid_of_its_light():
    """A sphere has two lit pixels, the right pixel 3 times as bright; then the brightness moves down by a pixel."""
    spheres, light = np.zeros((4, 5), int), np.zeros((4, 5, 3))
    spheres[1:3, 1:4] = 1
    light[1, 1, 0], light[1, 3, 0] = 1.0, 3.0
    light[3, 4, 0] = 100.0  # beyond the sphere
    before, other = highlights.spots(light, spheres), highlights.spots(np.roll(light, 1, axis=0), spheres)
    assert before.centroids[0, 0].tolist() == [2.5, 1.0] and before.peaks[0, 0] == 3.0
    assert np.isnan(before.centroids[1:]).all() and np.isnan(before.centroids[0, 1:]).all()
    lit = [highlights.Spots(spots.centroids[:, :1], spots.peaks[:, :1]) for spots in (before, other, before)]
    lit[1].peaks[0] = 1.5
    moved, flickered = highlights.wobble(lit, lit[0])
    assert moved[0] == 1.0 and flickered[0] == 50.0**2


def test_a_difference_counts_where_both_frames_have_a_surface():
    """A difference of 0.1 vanishes on one of the two pixels that both frames cover."""
    first, other = np.full((1, 3, 3), 0.1), np.zeros((1, 3, 3))
    other[0, 1], other[0, 2] = 0.1, 9.0
    sums = Differences()
    sums.add(first, np.array([[True, True, False]]))
    sums.add(other, np.array([[True, True, True]]))
    assert sums.wobble_db == pytest.approx(psnr_db(0.01 / 2)) and sums.static[0] == pytest.approx(0.01)


def test_an_animation_that_is_damaged_or_too_large_is_left_out(tmp_path):
    damaged, large = tmp_path / "damaged.png", tmp_path / "large.png"
    damaged.write_bytes(b"\x89PNG\r\n")
    noise = np.random.default_rng(SEED).integers(0, 256, (600, 600, 3), np.uint8)
    Image.fromarray(noise).save(large)
    assert large.stat().st_size > MAX_FILM
    assert film_uri(damaged) == film_uri(large) == film_uri(tmp_path / "none.png") == ""


def test_a_code_that_does_not_move_leaves_the_plot_empty_without_an_error(run, tmp_path):
    words = ("motion", "--encoding", "octahedral", "--space", "world", "--picture-turn", "none", *SMALL)
    plot = tmp_path / "plot.svg"
    status, _, err = run(*words, "--plot", str(plot))
    assert (status, err) == (0, f"normalbench: the chart is in {plot}\n") and plot.exists()


def test_frames_are_rendered_for_the_turn_nearest_a_quarter_of_a_degree():
    assert picture_turns(MotionOptions()) == (0.25,)
    assert picture_turns(MotionOptions(turn="0.01,1,4")) == (1.0,)
    assert picture_turns(MotionOptions(turn="20")) == ()
    assert picture_turns(MotionOptions(picture_turn="none")) == ()
    assert picture_turns(MotionOptions(picture_turn="1,0.01")) == (1.0, 0.01)
    assert len(motions(MotionOptions(axis="all", moves="all", space="all"))) == 2 * 2 * 3 * 5


def test_only_codes_are_measured_without_a_device(run, monkeypatch):
    """One line says that no frames are rendered."""
    from normalbench.bench.tables.motion import work

    monkeypatch.setattr(work, "found_device", lambda: (None, "there is no GL device"))
    status, out, err = run("motion", "--encoding", "octahedral", *SMALL, "--format", "json")
    assert status == 0 and err.count("\n") == 1 and "no frames are rendered" in err and "no GL device" in err
    assert all(row["highlight_px"] is None and row["ratio"] is not None for row in json.loads(out))


@pytest.mark.parametrize(
    "words, said",
    [
        (("--encoding", "octo"), "unknown encoding 'octo'"),
        (("--space", "screen"), "unknown space 'screen'; known: all, view, world"),
        (("--moves", "light"), "unknown value of --moves 'light'; known: all, camera, object"),
        (("--axis", "x"), "unknown axis 'x'; known: all, pitch, yaw, roll"),
        (("--turn", "0"), "--turn 0: expected numbers from 0.0001 to 45, comma-separated"),
        (("--turn", "fast"), "--turn fast: expected numbers from 0.0001 to 45, comma-separated"),
        (("--turn", "nan"), "--turn nan: expected numbers from 0.0001 to 45, comma-separated"),
        (
            ("--picture-turn", "2"),
            "--picture-turn 2: not among --turn 0.01,0.05,0.25,0.5,1; add it to --turn, or use none",
        ),
        (("--turn", "20", "--picture-turn", "20"), "--picture-turn 20: expected numbers from 0.0001 to 8"),
        (("--frames", "1"), "--frames 1: out of range; use 2 to 1000"),
        (("--count", "0"), "--count 0: out of range; use 1 to 16777216"),
        (("--seed", "-1"), "--seed -1: out of range; use 0"),
        (("--size", "0x5"), "WIDTHxHEIGHT"),
        (("--lights", "-1"), "--lights -1: out of range; use 0"),
        (("--space", "world", "--encoding", "xy"), "xy/rg8: in world space normals have all directions"),
        (("--encoding", "xyz"), "xyz/rg8: 3 components, but RG8 has 2 channels"),
        (("--picture-turn", "none", "--images", "pictures"), "--images requires rendered frames"),
        (("--plot", "plot.gif"), "unsupported plot format"),
        (("--images", "/proc/none"), "cannot write to /proc/none"),
    ],
)
@pytest.mark.usefixtures("gl")
def test_bad_input_is_a_one_line_error_and_nothing_is_written(run, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    status, out, err = run("motion", *words)
    assert (status, out) == (2, "") and said in err and err.count("\n") == 1, err
    assert not list(tmp_path.iterdir())


def test_the_help_lists_all_axes_spaces_and_moves(run):
    _, out, _ = run("motion", "--help")
    assert all(word in out for word in (*TURNS, *turning.SPACES, *turning.MOVES))
