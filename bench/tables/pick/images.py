"""Images lit with decoded normals: their errors in many orientations, and the displayed image in one orientation."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ....encodings.codecs.codec import Codec
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.layout import WORLD, engines_space
from ....gbuffer.layouts.words import LayoutError
from ....gbuffer.scenes.catalogue import SCENES, SceneMaker
from ...ground.output import cache as kept
from ...ground.output.errors import tell
from ...measures.images import turns
from ...measures.images.orientations import POLES, rotations, yaws
from ...measures.images.sampled import SampledImage
from ...measures.images.whole import SIZE, Trip, Turn, WholeImage, whole_images
from ...shaders.code.twin import has_twin
from .. import shots
from ..motion.trips import trip_of
from ..quality import measure as quality
from ..table import Row
from .answer import IMAGE, image_name
from .kept_figures import figures_key

if TYPE_CHECKING:
    from .measure import PickCase

# Not a pole: independent random rotations.
TURNED = "turned"
# By image and pole, by class ("" for the frame), the error of each orientation.
Found = dict[str, dict[str, dict[str, list[float]]]]


class Images:
    """A context manager for the images of a question's scenes. The surfaces of each scene are drawn once and released
    at the end."""

    def __init__(self, device: Device):
        self._device, self._stack = device, ExitStack()
        self._whole: dict[tuple[Any, ...], Mapping[float | None, WholeImage]] = {}
        self._sampled: dict[int, SampledImage] = {}
        self._trips: dict[Codec, Trip] = {}

    def __enter__(self) -> Images:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def first(self, case: PickCase) -> Row:
        """Return the image columns from a few yaws, enough to recognise encodings that are far from the best."""
        return _with_conditions(columns(self._errors(case, 0, turns.FIRST, _poles(case))), case)

    def of(self, case: PickCase) -> Row:
        """Return the image columns: PSNRs over covered pixels in the encoding's domain, for each scene and power.
        Empty if the device or a layout does not support the codec.

        Images with effects use only a few yaws, because each is rendered in full, which is slow.
        """
        poles = _poles(case)
        if case.said.get("effects"):
            errors = self._errors(case, 0, turns.FIRST, poles)
        else:
            errors, count = self._errors(case, 0, turns.ALL, [*poles, TURNED] if len(poles) > 1 else poles), turns.ALL
            while errors and count < turns.MOST and (turns.error_db(*_frames_and_pole(errors)) or 0.0) > turns.EXACT_DB:
                _, pole = _frames_and_pole(errors)
                _extend(errors, self._errors(case, count, count, [pole]))
                count *= 2
        row = _with_conditions(columns(errors), case)
        if case.codec.encoding.domain != "sphere":
            lost = {maker.name: self._lost_percent(case, maker) for maker in case.makers}
            row["image_lost_scene"] = max(lost, key=lambda name: lost[name], default=None)
            row["image_lost_percent"] = max(lost.values(), default=0.0)
        if case.said["needs"] == "view":
            row["image_view_angles"] = ". ".join(self._view_angles_text(case, maker) for maker in case.makers)
        return row

    def _errors(self, case: PickCase, first: int, count: int, poles: Sequence[str]) -> Found:
        """Return the errors by image and pole: for `count` yaws from number `first`, or for as many rotations for the
        pole TURNED. Scenes that the device cannot draw are left out."""
        errors: Found = {}
        for maker in case.makers:
            known = maker.name if maker is SCENES.get(maker.name) else None
            about = (case.setting, case.powers, case.said.get("effects") or "", first, count, tuple(poles))
            key = figures_key("image errors", case.codec, known, *about, self._device.renderer)
            try:
                errors |= kept.figures(key, partial(self._errors_now, case, maker, first, count, poles))
            except (LayoutError, *shots.UNMEASURABLE):
                continue
        return errors

    def _errors_now(self, case: PickCase, maker: SceneMaker, first: int, count: int, poles: Sequence[str]) -> Found:
        trip, domain = self._trip(case.codec), case.codec.encoding.domain
        errors: Found = {}
        for power, whole in self._images(case, maker).items():
            image = whole if case.said.get("effects") else self._sample(whole, case.setting.seed)
            by_pole = {
                pole: image.by_class(trip, _turns(pole, first, count, case.setting.seed), domain) for pole in poles
            }
            if all(by_pole.values()):
                errors[image_name(maker.name, power)] = {
                    pole: {name: values.tolist() for name, values in means.items()} for pole, means in by_pole.items()
                }
        return errors

    def _trip(self, codec: Codec) -> Trip:
        if codec not in self._trips:
            if has_twin(codec.encoding):
                self._trips[codec] = partial(quality.round_trip, codec)
            elif codec.encoding.is_half:
                raise LayoutError(f"{codec.name}: the renderer computes in 32 bits")
            else:
                passes = self._stack.enter_context(trip_of(codec))
                self._trips[codec] = lambda normals, positions: passes(normals, positions)[1]
        return self._trips[codec]

    def _images(self, case: PickCase, maker: SceneMaker) -> Mapping[float | None, WholeImage]:
        """Return the images of a scene by specular power (None without powers), drawn once for all codecs. Raises
        UsageError if the scene shows no surface."""
        question = (maker, case.setting, case.powers, case.pipeline)
        if question not in self._whole:
            powers = case.powers_of(maker)
            images = whole_images(self._device, self._stack, case.pipeline, maker, case.setting, powers)
            covered = 100.0 * float(np.mean(next(iter(images.values())).covered))
            shots.require_surface(maker, covered > 0)
            for line in shots.says_little(maker.name, covered):
                tell(line)
            self._whole[question] = images
        return self._whole[question]

    def _sample(self, whole: WholeImage, seed: int) -> SampledImage:
        if id(whole) not in self._sampled:
            self._sampled[id(whole)] = SampledImage(whole, seed, self._device, self._stack)
        return self._sampled[id(whole)]

    def _lost_percent(self, case: PickCase, maker: SceneMaker) -> float:
        """Return the percentage of covered pixels whose normals are outside the encoding's domain."""
        whole, encoding = next(iter(self._images(case, maker).values())), case.codec.encoding
        if encoding.domain == "view":
            return 100.0 * float(np.mean(whole.view_angles() > encoding.reach_deg))
        held = np.count_nonzero(whole.held_by(encoding.domain))
        return 100.0 * (1 - held / max(np.count_nonzero(whole.covered), 1))

    def _view_angles_text(self, case: PickCase, maker: SceneMaker) -> str:
        whole = next(iter(self._images(case, maker).values()))
        common, rare = np.percentile(whole.view_angles(), (99.0, 99.9))
        within = f"99% of visible normals are within {common:.0f}° of the line of sight, 99.9% within {rare:.0f}°"
        return f"In {maker.name} {within}"

    def shown(self, case: PickCase, maker: SceneMaker, pole: str) -> dict[float | None, tuple[np.ndarray, np.ndarray]]:
        """Return for each power (None without powers) the displayed image at the first yaw, and the image of exact
        normals: (height, width, 3), 0 to 1.

        Raises:
            LayoutError, or one of shots.UNMEASURABLE: the codec is not supported.
        """
        (turn,) = _turns(pole, 0, 1, case.setting.seed)
        trip = self._trip(case.codec)
        return {power: (whole.shown(trip, turn), whole.exact) for power, whole in self._images(case, maker).items()}


def _with_conditions(row: Row, case: PickCase) -> Row:
    """Return image columns with the size, exposure and display of each scene in words; an empty row is unchanged."""
    parts = []
    for maker in case.makers:
        exposure = "a measured exposure" if maker.exposure is None else f"{maker.exposure:g} stops"
        shown = f"{maker.tone_mapping} with specular antialiasing" if maker.is_metal_rough else "clipped"
        parts.append(f"{maker.name} at {'x'.join(map(str, maker.within(SIZE)))}, {exposure}, {shown}")
    return row and row | {"image_conditions": "; ".join(parts)}


def _poles(case: PickCase) -> Sequence[str]:
    is_of_world = engines_space(case.codec.encoding) == WORLD and case.said["needs"] != "view"
    return list(POLES) if is_of_world else [turns.VIEW_SPACE]


def _turns(pole: str, first: int, count: int, seed: int) -> Sequence[Turn]:
    """Return the rotations from world axes to the encoding's axes: many orientations, or only None in view space."""
    if pole == turns.VIEW_SPACE:
        return [None]
    if pole == TURNED:
        return list(rotations(first, count, seed))
    return [POLES[pole] @ yaw for yaw in yaws(first, count, seed)]


def _extend(image_errors: Found, more: Found) -> None:
    for name, by_pole in more.items():
        for pole, by_class in by_pole.items():
            for of, values in by_class.items():
                image_errors[name][pole][of] = image_errors[name][pole][of] + values


def _frames(image_errors: Found) -> turns.Errors:
    """Return the errors of whole frames, by image and pole, without the pole TURNED."""
    return {
        name: {pole: by_class[""] for pole, by_class in by_pole.items() if pole != TURNED}
        for name, by_pole in image_errors.items()
    }


def _frames_and_pole(image_errors: Found) -> tuple[turns.Errors, str]:
    frames = _frames(image_errors)
    return frames, turns.best_pole(frames)


def columns(image_errors: Found) -> Row:
    """Return the columns on a codec's images; empty if the codec has no images."""
    if not image_errors:
        return {}
    frames, pole = _frames_and_pole(image_errors)
    row: Row = {f"{IMAGE}{name}": turns.image_db(by_pole[pole]) for name, by_pole in frames.items()}
    worst = min(frames, key=lambda name: row[f"{IMAGE}{name}"])
    by_pole = {other: turns.worst_db(frames, other, range(turns.count_of(frames, other))) for other in frames[worst]}
    row |= {"image_se_db": turns.error_db(frames, pole), "image_two_worst_db": turns.two_worst_db(frames[worst][pole])}
    row |= {"image_pole": pole or None, "image_wrong_pole_db": by_pole[pole] - min(by_pole.values()) if pole else None}
    if all(TURNED in by_pole for by_pole in image_errors.values()):
        row["image_turned_db"] = min(turns.image_db(by_pole[TURNED][""]) for by_pole in image_errors.values())
    classes = {
        name: {of: turns.image_db(errors) for of, errors in by_pole[pole].items() if of}
        for name, by_pole in image_errors.items()
    }
    return row | {"image_classes": json.dumps(classes), "image_errors": json.dumps(frames)}
