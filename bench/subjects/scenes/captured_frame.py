"""Captured frames as scenes: the surface in each pixel, from images that are read like normals and depths."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.shared.position import Camera
from ....gbuffer.scenes.metal_rough import DIELECTRIC
from ....gbuffer.scenes.pixels import PixelSurfaces, pixel_scene
from ....gbuffer.scenes.scene import Scene, View
from ...ground.choose import choose_one
from ...ground.options.option import Reading
from ...ground.output.errors import UsageError
from ..depths.depth_images import CODES, VIEW, DepthImage, DepthReading, depth_image, read_depths
from ..normals.captures import CURVES, Turns, captured, check_size, turns_of
from ..normals.pixel_files import READERS, Pixels, read_pixels, read_plane, refused
from .frame_file import COLOUR, ENTRIES, FrameFile, as_keys

# Pixels of a frame that are drawn; of larger ones every second row and column, every third and so on.
MOST_PIXELS = 2**18
# What stands in for a quantity that a frame does not have.
STAND_INS = {"metallic": 0.0, "f0": DIELECTRIC, "ao": 1.0, "emissive": 0.0}
# By how much numbers may be beyond 0 and 1: rounding of floats of 16 bits.
BEYOND = 1e-3
MOST_LIGHT = 1e6


@dataclass(frozen=True, eq=False)
class CapturedFrame:
    """A captured frame as a scene.

    Attributes:
        scene: the scene, under the default environment of mesh files.
        sides: width and height in pixels of the rendered part.
        notes: remarks on the frame, as lines.
    """

    scene: Scene
    sides: tuple[int, int]
    notes: Sequence[str]


def captured_frame(frame: FrameFile) -> CapturedFrame:
    """Return the frame that a file describes. Raises UsageError, in one line, if the images do not match."""
    reader = _Reader(frame)
    pixels = reader.pixels()
    pixels, every, fov = _fewer(pixels, frame.fov)
    height, width = pixels.depth.shape
    notes = [*reader.notes]
    if every > 1:
        notes.append(f"drawn: one row and one column in {every} ({width} x {height} pixels), without averaging")
    scene = pixel_scene(pixels, _view(frame, fov, reader.to_world))
    return CapturedFrame(scene, (width, height), notes)


def _view(frame: FrameFile, fov: float, to_world: np.ndarray) -> View:
    """Return the view from the origin; the columns of `to_world` are the axes of view space."""
    (_, up, back) = (tuple(map(float, axis)) for axis in to_world.T)
    return View((0.0, 0.0, 0.0), (-back[0], -back[1], -back[2]), fov, frame.near, frame.far, (up[0], up[1], up[2]))


def _fewer(pixels: PixelSurfaces, fov: float) -> tuple[PixelSurfaces, int, float]:
    """Return a regular subset of pixels that is small enough to draw, its step in pixels, and its vertical angle of
    view in degrees."""
    height, width = pixels.depth.shape
    every = math.isqrt(max(height * width - 1, 0) // MOST_PIXELS) + 1
    rows, columns = height // every, width // every
    first = [(whole - kept * every + every) // 2 for whole, kept in ((height, rows), (width, columns))]
    some = tuple(slice(start, start + kept * every, every) for start, kept in zip(first, (rows, columns), strict=True))
    sampled_pixels = PixelSurfaces(**{field.name: getattr(pixels, field.name)[some] for field in fields(pixels)})
    up = math.tan(math.radians(fov) / 2) * rows * every / height
    return sampled_pixels, every, 2 * math.degrees(math.atan(up))


class _Reader:
    """The contents of a frame's images.

    Attributes:
        notes: remarks on the images.
        to_world: the matrix (3, 3) from view space to a right-handed world space with y up, for column vectors; the
            identity if no matrix is known.
    """

    def __init__(self, frame: FrameFile):
        self.notes: list[str] = []
        self._frame = frame
        self._coarse: dict[int, list[str]] = {}
        self.to_world = np.eye(3)
        if frame.view_matrix is not None:
            reading = Reading(space="world", view_matrix=frame.view_matrix)
            self.to_world = upright(self._asked("view_matrix", lambda: _to_view(turns_of(reading)[0])).T)

    def pixels(self) -> PixelSurfaces:
        depth = self._depth()
        normal, covered = self._normals(depth > 0)
        if not covered.any():
            raise self._frame.error("depth", "no pixel has both a valid depth and a valid normal")
        depth = np.where(covered, depth, np.float32(0))
        quantities = {name: self._quantity(name, covered) for name in ENTRIES if name not in ("depth", "normal")}
        smooth, roughness = quantities.pop("smoothness"), quantities.pop("roughness")
        if smooth is not None:
            roughness = 1 - smooth
        assert roughness is not None
        quantities = {name: self._stood_in(name, quantity, depth.shape) for name, quantity in quantities.items()}
        self._say_what_stands_in()
        return PixelSurfaces(depth=depth, normal=normal, roughness=roughness, **quantities)

    def _asked(self, name: str, read: Callable[[], Any]) -> Any:
        """Return the result of `read` for an entry. Raises a UsageError that names the entry."""
        try:
            return read()
        except UsageError as error:
            raise self._frame.error(name, error) from error

    def _note(self, name: str, lines: Sequence[str]) -> None:
        self.notes += [f"{name}: {as_keys(line)}" for line in lines]

    def _depth(self) -> np.ndarray:
        options = dict(self._frame.entries["depth"])
        path = Path(options.pop("file"))
        image = self._asked("depth", lambda: _depth_image(path, DepthReading(fov=self._frame.fov, **options)))
        camera = Camera(self._frame.near, self._frame.far, self._frame.fov, image.aspect)
        surface = image.surface(camera)
        if not surface.any():
            raise self._frame.error("depth", _out_of_reach(path, image, camera))
        missing = image.not_finite
        self._note("depth", [*image.notes, *[f"{missing} values are NaN and count as background"] * bool(missing)])
        return surface

    def _normals(self, within: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        options = dict(self._frame.entries["normal"])
        path = Path(options.pop("file"))
        reading = Reading(fov=self._frame.fov, **options)
        if reading.space == "world":
            if self._frame.view_matrix is None:
                raise self._frame.error("normal", "--space world requires --view-matrix and --fov")
            reading = replace(reading, view_matrix=self._frame.view_matrix)
        image = self._asked("normal", lambda: captured(path, reading, within))
        self._note("normal", image.notes)
        return np.moveaxis(image.normals, 0, -1).astype(np.float32), image.covered

    def _quantity(self, name: str, covered: np.ndarray) -> np.ndarray | None:
        """Return a quantity for all pixels, 0 on the background and, unless it is emissive, clipped to [0, 1]; None
        if the frame does not have the quantity. Raises UsageError for impossible values."""
        entry = self._frame.entries.get(name)
        if entry is None:
            return None
        if isinstance(entry, dict):
            quantity = self._asked(name, lambda: self._image(name, entry, covered))
        else:
            quantity = np.multiply.outer(covered, np.asarray(entry)).astype(np.float32)
        self._asked(name, lambda: _check_range(name, quantity[covered]))
        return quantity if name == "emissive" else np.clip(quantity, 0.0, 1.0)

    def _image(self, name: str, entry: dict[str, Any], covered: np.ndarray) -> np.ndarray:
        path = Path(entry["file"])
        pixels = _planes(path, name, entry)
        check_size(path, pixels.shape, covered.shape)
        _check_finite(path, pixels.planes, covered)
        if pixels.steps:
            self._coarse.setdefault(pixels.steps.bit_length(), []).append(name)
        curve = choose_one("curve", entry.get("curve", "linear"), CURVES)
        if name == "base_color" and "curve" not in entry and pixels.full == READS_AS_COLOUR:
            self._note(
                name, ['8 bits without "curve" are read as linear; for images meant for screens use "curve": "srgb"']
            )
        image = CURVES[curve](np.where(covered, pixels.planes, 0) / np.float32(pixels.full or 1))
        image = np.moveaxis(image * np.float32(entry.get("scale", 1.0)), 0, -1).astype(np.float32)
        return image if ENTRIES[name] is COLOUR else image[..., 0]

    def _stood_in(self, name: str, quantity: np.ndarray | None, shape: tuple[int, ...]) -> np.ndarray:
        if quantity is not None:
            return quantity
        sides = (*shape, 3) if ENTRIES[name] is COLOUR else shape
        return np.full(sides, STAND_INS[name], np.float32)

    def _say_what_stands_in(self) -> None:
        lacking = [f"{name} ({value:g})" for name, value in STAND_INS.items() if name not in self._frame.entries]
        if lacking:
            self.notes.append(f"it has no {', '.join(lacking)}: the value in parentheses is used everywhere")
        for bits, names in self._coarse.items():
            steps = f"{', '.join(names)}: {bits}-bit steps"
            self.notes.append(f"{steps}; encodings with the same steps look better than they are")


# What stands for 1 in images that programs write for screens.
READS_AS_COLOUR = 255


def _to_view(turns: Turns) -> np.ndarray:
    assert turns.to_view is not None
    return turns.to_view


def upright(to_world: np.ndarray) -> np.ndarray:
    """Return the matrix from view space to a right-handed world with y up, as for environments.

    The axes of this world are the axes of the original world, reordered and possibly mirrored.

    Args:
        to_world: the matrix from view space to the original world; its axis closest to the camera's up becomes y.
    """
    axis = int(np.argmax(abs(to_world[:, 1])))
    y = np.sign(to_world[axis, 1]) * to_world[axis]
    x, z = np.delete(to_world, axis, axis=0)
    turned = np.stack([x, y, z])
    return turned if np.linalg.det(turned) > 0 else np.stack([x, y, -z])


def _depth_image(path: Path, reading: DepthReading) -> DepthImage:
    code = choose_one("code of --depths-are", reading.depths_are, (VIEW, *CODES))
    return depth_image(path, read_depths(path, reading.channel), replace(reading, depths_are=code))


def _out_of_reach(path: Path, image: DepthImage, camera: Camera) -> UsageError:
    depths = image.depths(camera)
    depths = depths[np.isfinite(depths)]
    reach = f"{depths.min():.4g} to {depths.max():.4g}" if len(depths) else "not finite"
    return refused(path, f"no depth is between near and far; depths are {reach}", "check --depths-are and --depth-unit")


def _planes(path: Path, name: str, entry: dict[str, Any]) -> Pixels:
    """Return the channels of a quantity: three for a colour, otherwise one. Raises UsageError."""
    if path.suffix.lower() not in READERS:
        raise UsageError(f"{path}: not an image; supported: {', '.join(READERS)}")
    if ENTRIES[name] is COLOUR:
        return read_pixels(path, lambda names: _colours(path, names, entry.get("channels")))
    return read_plane(path, lambda names: [_one(path, names, entry.get("channel"))])


def _colours(path: Path, names: Sequence[str], asked: str | None) -> list[str]:
    words = [word.strip() for word in asked.split(",")] if asked else ["R", "G", "B"]
    if not asked and set("012") <= set(names):
        return list("012")
    if len(words) != 3 or not set(words) <= set(names):
        what = f"no channels {','.join(words)}; it has {', '.join(names[:40])}"
        raise refused(path, what, "name three with --channels")
    return words


def _one(path: Path, names: Sequence[str], asked: str | None) -> str:
    if asked is None and len(names) == 1:
        return names[0]
    if asked is not None and asked in names:
        return asked
    what = "no channel is named" if asked is None else f"no channel {asked!r}"
    raise refused(path, f"{what}; it has {', '.join(names[:40])}", "name one with --channel")


def _check_finite(path: Path, planes: np.ndarray, covered: np.ndarray) -> None:
    bad = ~np.isfinite(planes).all(axis=0) & covered
    if bad.any():
        row, column = map(int, np.argwhere(bad)[0])
        what = f"{bad.sum()} of {covered.sum()} pixels are NaN or infinite, the first at row {row}, column {column}"
        raise refused(path, what, "exclude them with a mask of the normals")


def _check_range(name: str, numbers: np.ndarray) -> None:
    """Raise UsageError for values that a quantity cannot have."""
    low, high = float(numbers.min()), float(numbers.max())
    if name == "emissive":
        if not 0 <= low <= high <= MOST_LIGHT:
            raise UsageError(f"its values are {low:.3g} to {high:.3g}; light must be 0 to {MOST_LIGHT:g}")
    elif not -BEYOND <= low <= high <= 1 + BEYOND:
        raise UsageError(f"its values are {low:.3g} to {high:.3g}, but must be 0 to 1; rescale them with --scale")


def lines_of(frame: FrameFile, capture: CapturedFrame) -> Iterator[str]:
    """Yield the lines to report about a frame on standard error."""
    yield from (f"{frame.path}: {note}" for note in capture.notes)
