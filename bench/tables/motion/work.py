"""Measurement and display of the motion table."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from ....encodings.codecs.codec import Codec
from ....gbuffer.gl.device import Device
from ....gbuffer.scenes.scene import TURNS
from ....reports.charts.chart import Chart
from ...ground.choose import choose
from ...ground.machine.devices import found_device, require_jax
from ...ground.options.counts import check_seed, checked_numbers, in_range
from ...ground.options.targets import checked_setting, checked_target, what_is_left
from ...ground.options.words import text_of
from ...ground.output.errors import UsageError, by_reason, tell
from ...subjects.codecs.names import check_twin, codecs_named, fitting
from ..charts import having
from ..shots import by_shots, shot_steps
from ..table import Row, Sheet, Step, Work
from ..verdicts import codec_name
from . import pictures, turning
from .charts import wobble_chart
from .code_wobble import Motion
from .measure import PICTURE_SWING_DEG, Bench, FrameSequence, MotionCase
from .table import MotionOptions, MotionOutputs

LEAST_TURN_DEG, MOST_TURN_DEG = 1e-4, 45.0
# One pixel or so of the default picture.
USUAL_PICTURE_TURN_DEG = 0.25
MAX_FRAMES, MAX_POINTS = 1000, 2**24
# A code that wobbles by less of its static error stays but for float32's rounding.
LEAST_PLOTTED = 0.01
NO_PICTURES = "none"
OTHER_DOMAIN = "in world space normals have all directions, and this encoding is only for normals that face the camera"


def motions(options: MotionOptions) -> list[Motion]:
    """Return the rotations to measure, for each space, moving thing, axis and turn. Raises UsageError."""
    in_range("--frames", options.frames, 2, MAX_FRAMES)
    chosen = [
        choose(what, given, {name: name for name in known})
        for what, given, known in (
            ("space", options.space, turning.SPACES),
            ("value of --moves", options.moves, turning.MOVES),
            ("axis", options.axis, TURNS),
        )
    ]
    turns = checked_numbers("--turn", options.turn, float, LEAST_TURN_DEG, MOST_TURN_DEG)
    return [
        Motion(space, moves, axis, turn, options.frames)
        for space in chosen[0]
        for moves in chosen[1]
        for axis in chosen[2]
        for turn in turns
    ]


def codecs(options: MotionOptions) -> list[Codec]:
    """Return the requested codecs; codecs that do not fit are named on standard error. Raises UsageError."""
    chosen, left_out = fitting(codecs_named(options.encoding, options.storage, options.rounding))
    for encoding in dict.fromkeys(codec.encoding for codec in chosen):
        check_twin(encoding)
    return what_is_left(chosen, left_out)


def picture_turns(options: MotionOptions) -> tuple[float, ...]:
    """Return the turns for which frames are rendered: the requested turns, empty for "none", by default the turn
    nearest to USUAL_PICTURE_TURN_DEG. Raises UsageError for a turn that is not among --turn."""
    turns = checked_numbers("--turn", options.turn, float, LEAST_TURN_DEG, MOST_TURN_DEG)
    possible = tuple(turn for turn in turns if turn <= PICTURE_SWING_DEG)
    if options.picture_turn is None:
        return tuple(sorted(possible, key=lambda turn: abs(math.log(turn / USUAL_PICTURE_TURN_DEG)))[:1])
    if options.picture_turn == (NO_PICTURES,):
        return ()
    asked = checked_numbers("--picture-turn", options.picture_turn, float, LEAST_TURN_DEG, PICTURE_SWING_DEG)
    if missing := [turn for turn in asked if turn not in turns]:
        raise UsageError(
            f"--picture-turn {missing[0]:g}: not among --turn {text_of(options.turn)}; add it to --turn, or use none"
        )
    return asked


def cases(options: MotionOptions, device: Device | None) -> list[MotionCase]:
    """Return one case for each row; combinations that cannot be measured are named on standard error.

    Raises:
        UsageError: unknown names, numbers out of range, or nothing left to measure.
    """
    in_range("--count", options.count, 1, MAX_POINTS)
    check_seed(options.seed)
    setting = checked_setting(1, options.lights, options.seed)
    chosen, rendered = motions(options), picture_turns(options)
    size, _ = checked_target(options.size, 1, options.frames, device) if device else ((0, 0), 0)
    possible: list[MotionCase] = []
    outside: list[str] = []
    for codec in codecs(options):
        suited = [motion for motion in chosen if is_suited(codec, motion)]
        outside += [] if suited else [codec.name]
        for motion in suited:
            # A smooth sphere that turns looks the same: images are of turning cameras.
            is_rendered = device and motion.moves == turning.MOVES[0] and motion.turn in rendered
            shots = FrameSequence(motion.axis, motion.turn, motion.frames, size, setting) if is_rendered else None
            possible.append(MotionCase(codec, motion, options.count, options.seed, shots))
    return what_is_left(possible, by_reason((name, OTHER_DOMAIN) for name in outside))


def is_suited(codec: Codec, motion: Motion) -> bool:
    """Whether an encoding suits the space of a motion: in world space, normals point in all directions."""
    return motion.space != turning.SPACES[1] or codec.encoding.domain == "sphere"


def _steps(options: MotionOptions, outputs: MotionOutputs) -> list[Step]:
    require_jax()
    device, missing = found_device()
    chosen = cases(options, device)
    if not device and picture_turns(options):
        tell(f"no frames are rendered, so the columns of highlights and images are empty: {missing}")
    return shot_steps(Bench(device, outputs.images is not None), chosen, outputs.images, _key)


def _check(outputs: MotionOutputs, all_steps: Sequence[Step]) -> None:
    if outputs.images and not any(step.case.case.pictures for step in all_steps):
        raise UsageError("--images requires rendered frames: a moving camera, a --picture-turn and an OpenGL device")


def _key(case: MotionCase) -> Row:
    motion, shots = case.motion, case.pictures
    key: Row = {"codec": case.codec.name, "space": motion.space, "moves": motion.moves, "axis": motion.axis}
    key |= {"turn": motion.turn, "frames": motion.frames, "count": case.count, "seed": case.seed}
    return key | ({"size": list(shots.size), "lights": shots.setting.lights} if shots else {})


IMAGE = ("static_psnr_db", "wobble_psnr_db", "reprojected_psnr_db")
LINE = ("encoding", "storage", "rounding", "space", "moves", "axis")
# A code that changes less than this from frame to frame, in degrees, does not wobble.
STILL_DEG = 1e-4


def _lines(rows: Sequence[Row]) -> list[list[Row]]:
    """Return the rows with figures, in groups that differ only in the turn."""
    lines: dict[tuple, list[Row]] = {}
    for row in having(rows, "wobble_deg", "turn_deg"):
        lines.setdefault(tuple(row.get(name) for name in LINE), []).append(row)
    return list(lines.values())


def _verdict(rows: Sequence[Row]) -> Iterator[str]:
    measured = having(rows, "wobble_deg", "turn_deg")
    phrases = []
    for space, moves in dict.fromkeys((row["space"], row["moves"]) for row in measured):
        part = [row for row in measured if (row["space"], row["moves"]) == (space, moves)]
        worst = max(part, key=lambda row: row["wobble_deg"])
        largest = f"up to {worst['wobble_deg']:.2g}° RMS ({codec_name(worst)})"
        phrases.append(
            f"{'none' if worst['wobble_deg'] < STILL_DEG else largest} in {space} space while the {moves} turns"
        )
    if phrases:
        yield f"Change of the error from frame to frame: {'; '.join(phrases)}."


def _summary(rows: Sequence[Row]) -> Iterator[Sheet]:
    """Yield a sheet with the worst turn of each codec, and a sheet with the figures of rendered frames."""
    codes, images = [], []
    for line in _lines(rows):
        worst = max(line, key=lambda row: row["wobble_deg"])
        named = {name: worst[name] for name in LINE if name not in ("rounding", "moves")}
        if len({row["moves"] for row in rows}) > 1:
            named["moves"] = worst["moves"]
        figures = {name: worst[name] for name in ("static_rms_deg", "ratio", "jumps_percent")}
        turn = worst["turn_deg"] if worst["wobble_deg"] else None
        codes.append(named | {"worst_turn_deg": turn, "worst_wobble_deg": worst["wobble_deg"]} | figures)
        for row in line:
            if row.get("highlight_px") is not None:
                names = ("turn_deg", "highlight_px", "peak_percent", *IMAGE)
                images.append(named | {name: row[name] for name in names})
    if codes:
        yield Sheet("normals alone, at the turn with the largest wobble", codes)
    if images:
        yield Sheet("highlights and the displayed image", images)


def _plotted(rows: Sequence[Row]) -> list[Row]:
    """Return the rows to plot against the turn, without encodings that do not wobble, which would compress the others
    on a logarithmic axis."""
    return [row for line in _lines(rows) if any((row["ratio"] or 0) > LEAST_PLOTTED for row in line) for row in line]


def _charts(rows: Sequence[Row]) -> Iterator[Chart]:
    if usable := _plotted(rows):
        yield wobble_chart(usable)


WORK = Work(
    steps=_steps,
    check=_check,
    measure=by_shots(pictures.write),
    verdict=_verdict,
    summary=_summary,
    charts=_charts,
    plotted=lambda done: [wobble_chart(_plotted(done.rows))],
    films=pictures.films,
)
