"""Captured frames as sets of normals: choice and meaning of the channels, the background, and checks."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import jax
import jax.numpy as jnp
import numpy as np

from ....encodings.codecs.files import called, file_text
from ....encodings.storages.rounding import from_srgb, to_srgb
from ....gbuffer.scenes.files.mesh_file import Rounding
from ...ground.choose import choose_one
from ...ground.options.option import Reading
from ...ground.output.errors import UsageError
from .capture_diagnoses import MIRRORED, SWAPPED, some_pixels, which_way
from .normal_sets import OBJECT, NormalSet, from_arrays
from .own_errors import FINE, bits_text, own_error_deg, own_error_note
from .pixel_files import CLOUDS, READERS, Pixels, read_pixels, read_plane, refused

# Shorter is not a direction: background. Whole numbers have no 0 within [-1, 1]; 8 bits come within 0.007 of it.
BACKGROUND = 0.02
# 8 bits cut off are up to 0.014 off, a filter at an edge more.
UNIT_WITHIN = 0.05
# And that is what few normals, at edges, may be beyond.
OFF_UNIT_SHARE = 0.01
# Of numbers of 8 bits that stand for [-1, 1].
EIGHT_BITS = Rounding(127.5)
# Lengths this near to 1 are rounding of float32: such normals are measured as they are.
ROUNDING = 1e-6
ROTATION_WITHIN = 1e-3
AXES = ("XYZ", "xyz", "RGB", "rgb")
NORMAL_WORDS = re.compile(r"n|nrm.*|.*norm.*", re.IGNORECASE)
# A left-handed view space, z into the screen, as Direct3D and most engines on it have it.
SPACES: Mapping[str, np.ndarray | None] = MappingProxyType(
    {"view": np.eye(3), "view-left-handed": MIRRORED, "world": None}
)
CODE_SPACES = ("view", "world")


def _curve_on_arrays(curve: Callable[[jax.Array], jax.Array | np.ndarray]) -> Callable[[np.ndarray], np.ndarray]:
    return lambda stored: np.asarray(curve(jnp.asarray(stored)))


# What takes a curve off that the components of a file were given, (3, ...) in [0, 1].
CURVES: Mapping[str, Callable[[np.ndarray], np.ndarray]] = MappingProxyType(
    {"linear": lambda stored: stored, "srgb": _curve_on_arrays(from_srgb), "srgb-removed": _curve_on_arrays(to_srgb)}
)


@dataclass(frozen=True, eq=False)
class Captured:
    """The normals in an image file.

    Attributes:
        normals: planes of shape (3, height, width) or (3, count), in the space in which normals are encoded; unit
            length where `covered`, otherwise 0.
        covered: which normals count.
        not_finite: the number of surface normals that are NaN or infinite.
        own_error_deg: the mean angle of the file's own error; None if it is unknown.
        turns: the transforms that were applied.
        notes: remarks on the normals.
    """

    normals: np.ndarray
    covered: np.ndarray
    not_finite: int
    own_error_deg: float | None
    turns: Turns
    notes: list[str]


def capture(path: Path, reading: Reading) -> tuple[NormalSet, list[str]]:
    """Return the normals in an image file as a set, and remarks on them. Raises UsageError like `captured`."""
    image = captured(path, reading)
    shape = image.covered.shape if image.covered.ndim == 2 else None
    n = np.moveaxis(image.normals, 0, -1).astype(np.float32)
    name = called(path.name)
    rays = (_rays(n, reading.fov) @ image.turns.of_rays.T).astype(np.float32)
    normal_set = from_arrays(name, f"normals of {name}", n, rays, image.covered, shape, image.not_finite)
    space = OBJECT if is_in_object_space(path, reading) else checked(reading).code_space
    return replace(normal_set, code_space=space, own_error_deg=image.own_error_deg), image.notes


def captured(path: Path, reading: Reading, within: np.ndarray | None = None) -> Captured:
    """Return the normals in an image file.

    Args:
        within: a mask of the pixels that may show a surface, of the image's shape; None for all pixels.

    Raises:
        UsageError: the file cannot be read, or does not contain unit normals as described by `reading`.
    """
    reading = checked(reading)
    turns, notes = turns_of(reading)
    chosen: list[str] = []

    def choose(names: Sequence[str]) -> Sequence[str]:
        chosen[:] = chosen_channels(path, names, reading.channels)
        return chosen

    pixels = read_pixels(path, choose)
    surface = _mask(path, reading, pixels.shape)
    if within is not None:
        check_size(path, pixels.shape, within.shape)
        surface = surface & within
    n, covered, of_lengths = _directions_and_remarks(path, pixels, surface, reading)
    not_finite = int((surface & ~np.isfinite(n).all(axis=0)).sum())
    n = np.where(covered, n, 0)
    notes += of_lengths
    if not is_in_object_space(path, reading):
        notes += _which_way(n, covered, turns.to_view, reading, chosen)
    roundings = _roundings(pixels, reading)
    own = own_error_deg(np.moveaxis(n, 0, -1)[covered], roundings) if roundings else None
    notes += _of_roundings(roundings, own, is_image=not pixels.roundings)
    if not np.array_equal(turns.to_code, np.eye(3)):
        n = np.tensordot(turns.to_code, n, 1)
    return Captured(n, covered, not_finite, own, turns, notes)


def check_size(path: Path, shape: tuple[int, ...], wanted: tuple[int, ...]) -> None:
    """Raise UsageError if an image does not have the wanted size, (height, width), of the frame's depth."""
    if shape != wanted:
        sides, others = (" x ".join(map(str, size[::-1])) for size in (shape, wanted))
        raise refused(path, f"it is {sides}, but the depth is {others}", "save all images of a frame in the same size")


def is_in_object_space(path: Path, reading: Reading) -> bool:
    """Whether a file is a point cloud, and no option implies that a camera captured it."""
    usual = Reading()
    options = (reading.space, reading.code_space, reading.view_matrix, reading.fov)
    return path.suffix.lower() in CLOUDS and options == (usual.space, usual.code_space, usual.view_matrix, usual.fov)


def _roundings(pixels: Pixels, reading: Reading) -> Sequence[Rounding]:
    """Return the roundings of a file's normals; empty if they are unknown, such as with a transfer curve."""
    if pixels.roundings or pixels.steps is None or reading.curve != "linear":
        return pixels.roundings
    return (Rounding(pixels.steps / 2),)


def _of_roundings(roundings: Sequence[Rounding], own: float | None, is_image: bool) -> list[str]:
    """Return remarks on normals that a file stores in few bits, with a mean error of `own` degrees; empty if the
    error is unknown or small."""
    if is_image and roundings == (EIGHT_BITS,):
        return [
            "8 bits per channel, with errors of about 0.2 degrees: 8-bit storages look better on them than "
            "they are; captures in 16 bits or floats favour no storage"
        ]
    if own is None or own < FINE:
        return []
    return [own_error_note(f"its normals have {bits_text(roundings)} and", own)]


def checked(reading: Reading) -> Reading:
    """Return a reading with the names as the program spells them. Raises UsageError for unknown names and for values
    out of range."""
    if not 0 <= reading.nan_share <= 1:
        raise UsageError(f"--nan-share {reading.nan_share}: out of range; use 0 to 1")
    if reading.fov is not None and not 1 <= reading.fov <= 175:
        raise UsageError(f"--fov {reading.fov}: out of range; use 1 to 175 degrees")
    space, curve = choose_one("space", reading.space, SPACES), choose_one("curve", reading.curve, CURVES)
    code_space = choose_one("code space", reading.code_space, CODE_SPACES)
    return replace(reading, space=space, curve=curve, code_space=code_space)


# Channels


def _layer_channels(names: Sequence[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield each layer's name with its three channels, such as N.X N.Y N.Z, normal.R .., Nx Ny Nz or 0 1 2. The name
    is empty if the channel names are only these letters or digits."""
    known = set(names)
    for name in names:
        stem, axis = name[:-1], name[-1:]
        for axes in AXES:
            three = [stem + other for other in axes]
            if axis == axes[0] and known.issuperset(three):
                yield stem.rstrip("._"), three
    if known.issuperset("012"):
        yield "", list("012")


def chosen_channels(path: Path, names: Sequence[str], asked: str | None) -> list[str]:
    """Return the names of three channels: the requested channels, or else the channels that are named like normals,
    the only three that belong together, or R, G and B.

    Raises:
        UsageError: channels are missing, or the choice is ambiguous.
    """
    layers = dict(_layer_channels(names))
    shown = ", ".join(names[:40]) + (", ..." if len(names) > 40 else "")
    if len(names) < 3:
        remedy = "a normal has three channels; save z too, which is sqrt(max(0, 1 - x*x - y*y)) if it is not negative"
        raise refused(path, f"it has {shown}", remedy)
    if asked is not None:
        words = [word.strip() for word in asked.split(",")]
        if len(words) == 1 and words[0] in layers:
            return layers[words[0]]
        if len(words) == 3 and set(words) <= set(names):
            return words
        raise refused(path, f"no channels {asked!r}; it has {shown}", "name a layer or three channels with --channels")
    likely = [layer for layer in layers if NORMAL_WORDS.fullmatch(re.split(r"[._ ]", layer)[-1])]
    if len(likely) > 1:
        raise refused(path, f"layers {', '.join(likely)} may hold normals", f"choose one with --channels {likely[0]}")
    if likely or "" in layers or len(layers) == 1:
        return layers[likely[0] if likely else "" if "" in layers else next(iter(layers))]
    raise refused(path, f"no channel names suggest normals; it has {shown}", "name three with --channels x,y,z")


# What is surface


def _mask(path: Path, reading: Reading, shape: tuple[int, ...]) -> np.ndarray:
    """Return which pixels the reading's mask, an image file or a channel of the image, marks as surface: bool of the
    image's shape, all true without a mask. Raises UsageError if the mask has the wrong size."""
    asked = reading.mask
    if asked is None:
        return np.ones(shape, bool)
    named = Path(asked)
    if named.suffix.lower() in READERS:
        where, mask = f"--mask {named}", _mask_of_file(named)
        mask = mask.reshape(-1) if len(shape) == 1 else mask
    else:
        where, mask = f"channel {asked}", read_pixels(path, lambda names: _one_channel(path, names, asked)).planes[0]
    if mask.shape != shape:
        sides = " x ".join(map(str, mask.shape))
        raise refused(path, f"{where} is {sides}, normals are {' x '.join(map(str, shape))}", "use the same size")
    return np.isfinite(mask) & (mask != 0)


def _mask_of_file(path: Path) -> np.ndarray:
    """Return the first channel of an image, of shape (height, width)."""
    return read_plane(path, lambda names: names[:1]).planes[0]


def _one_channel(path: Path, names: Sequence[str], asked: str) -> list[str]:
    if asked not in names:
        raise refused(path, f"no channel {asked!r} for a mask; it has {', '.join(names[:40])}", "use --mask FILE")
    return [asked]


def _directions_and_remarks(
    path: Path, pixels: Pixels, surface: np.ndarray, reading: Reading
) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Return normals as planes, which of them count and therefore have unit length, and remarks on them."""
    stored = pixels.planes if pixels.full is None else pixels.planes / pixels.planes.dtype.type(pixels.full)
    stored = CURVES[reading.curve](stored)
    unpack = pixels.full is not None if reading.unpack is None else reading.unpack
    # What a cleared target holds is background however it is packed.
    surface = surface & (stored != 0).any(axis=0)
    finite = np.asarray(np.isfinite(stored).all(axis=0))
    _check_finite(path, surface, finite, reading.nan_share)
    n = stored * 2 - 1 if unpack else stored
    length = _plane_lengths(n)
    covered = surface & finite & (length >= BACKGROUND)
    if not covered.any() and path.suffix.lower() in CLOUDS:
        raise refused(path, "none of its points has a normal: nx, ny and nz are 0, as in splats", "export normals")
    if not covered.any():
        raise refused(path, "no normals: every pixel is background", "check --channels, --mask and --unpack")
    notes = _checked_unit(path, stored, length, covered, reading, unpack)
    far = covered & (abs(length - 1) > ROUNDING)
    return np.divide(n, length, out=n.copy(), where=far), covered, notes


def _plane_lengths(n: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore", over="ignore"):
        squares = sum(np.square(plane, dtype=np.float64) for plane in n)
        return np.sqrt(squares).astype(n.dtype)


def _check_finite(path: Path, surface: np.ndarray, finite: np.ndarray, share: float) -> None:
    bad = surface & ~finite
    count, most = int(bad.sum()), max(int(surface.sum()), 1)
    if count > share * most:
        first = ", ".join(
            f"{word} {index}" for word, index in zip(("row", "column"), np.argwhere(bad)[0], strict=False)
        )
        needed = math.ceil(1e6 * count / most) / 1e6
        raise refused(
            path,
            f"{count} of {most} normals are NaN or infinite, the first at {first}",
            f"use --nan-share {needed:g} to mask and count them, or --mask to exclude them",
        )


def _checked_unit(
    path: Path, stored: np.ndarray, length: np.ndarray, covered: np.ndarray, reading: Reading, unpacked: bool
) -> list[str]:
    """Return remarks if a few normals do not have unit length. If more do not, raise UsageError with the option that
    would read them correctly."""
    off = float(np.mean(abs(length[covered] - 1) > UNIT_WITHIN))
    complaint = f"{off:.1%} of the normals are not unit length"
    if off <= OFF_UNIT_SHARE:
        return [] if off == 0 or reading.normalise else [f"{off:.3%} of the normals are not unit length: normalised"]
    components = stored[:, covered]
    low, high = (float(f(components)) for f in (np.min, np.max))
    remedy = next(_readings_that_fit(components, reading.curve, unpacked), None)
    if reading.normalise:
        return [f"{complaint}, normalised; with {remedy} they would be unit length"] if remedy else []
    if remedy:
        raise refused(path, f"{complaint}; all components are in [{low:.3g}, {high:.3g}]", f"use {remedy}")
    median = float(np.median(length[covered]))
    raise refused(
        path,
        f"{complaint}: lengths {length[covered].min():.3g} to {length[covered].max():.3g}, median {median:.3g}, "
        f"components in [{low:.3g}, {high:.3g}]",
        "use --normalise to accept them, or --channels to choose others",
    )


def _readings_that_fit(components: np.ndarray, curve: str, unpacked: bool) -> Iterator[str]:
    """Yield other options, such as `--curve srgb --no-unpack`, for which nearly all normals would have unit length;
    nothing unless the current curve is linear.

    Args:
        components: components decoded by `curve`, of shape (3, count).
    """
    if curve != "linear":
        return
    is_share = bool((components >= 0).all() and (components <= 1).all())
    for name, apply in CURVES.items():
        for unpack in (True, False):
            if (name, unpack) == (curve, unpacked) or not (is_share or (name, unpack) == ("linear", False)):
                continue
            read = apply(components) * 2 - 1 if unpack else components
            lengths = _plane_lengths(read)
            # A grey background of packed normals has no length when unpacked.
            surface = lengths[lengths >= BACKGROUND]
            if len(surface) and np.mean(abs(surface - 1) <= UNIT_WITHIN) >= 1 - 10 * OFF_UNIT_SHARE:
                packing = [] if unpack == unpacked else ["--unpack" if unpack else "--no-unpack"]
                yield " ".join(([] if name == curve else [f"--curve {name}"]) + packing)


# Where they point


@dataclass(frozen=True, eq=False)
class Turns:
    """The transforms of a frame, as (3, 3) matrices for column vectors.

    Attributes:
        to_view: from the file's normals to view space; None if it is unknown.
        to_code: from the file's normals to the space in which normals are encoded.
        of_rays: from rays in view space to the space in which normals are encoded.
    """

    to_view: np.ndarray | None
    to_code: np.ndarray
    of_rays: np.ndarray


def turns_of(reading: Reading) -> tuple[Turns, list[str]]:
    """Return the transforms of a frame, and remarks on them.

    Raises:
        UsageError: the matrix between two spaces is missing, is not needed, or is not a rotation.
    """
    known, is_world, same = SPACES[reading.space], reading.code_space == CODE_SPACES[1], np.eye(3)
    if reading.view_matrix is None:
        if (known is None) != is_world:
            raise _matrix_error(reading)
        if known is None and reading.fov is not None:
            raise UsageError("--fov gives rays in view space; use --view-matrix to transform them to world space")
        return Turns(known, same if known is None else known, same), []
    if known is not None and not is_world:
        raise UsageError(f"--view-matrix cannot be used with --space {reading.space}, unless --code-space is world")
    matrix, notes = _rotation_and_remarks(reading.view_matrix)
    if not is_world:
        return Turns(matrix, matrix, same), notes
    return Turns(matrix, same, matrix.T) if known is None else Turns(known, matrix.T @ known, matrix.T), notes


def _matrix_error(reading: Reading) -> UsageError:
    asked, other = f"--space {reading.space}", ""
    if SPACES[reading.space] is None:
        other = "; or use --code-space world if the engine encodes world-space normals"
    else:
        asked += f" --code-space {reading.code_space}"
    return UsageError(
        f"{asked} needs --view-matrix, 9 or 16 numbers row by row or a text file of them, which transform world space "
        f"to view space: x right, y up, z towards the viewer{other}"
    )


def _rotation_and_remarks(text: str) -> tuple[np.ndarray, list[str]]:
    option = f"--view-matrix {text}"
    matrix = _numbers_of(text, option)
    linear = matrix[:3, :3]
    if matrix.shape == (4, 4):
        _check_affine(matrix, option)
    square = linear @ linear.T
    scale = np.trace(square) / 3
    if not scale > 0 or not np.allclose(square / scale, np.eye(3), atol=ROTATION_WITHIN):
        raise UsageError(f"{option}: not a rotation: its rows are not at right angles, or differ in length")
    size = math.sqrt(scale)
    is_scaled = abs(size - 1) > ROTATION_WITHIN
    return linear / size, [f"the rows of --view-matrix have length {size:.4g}: the scale is ignored"] * is_scaled


def _numbers_of(text: str, option: str) -> np.ndarray:
    """Return the 3 x 3 or 4 x 4 matrix in a text, or in the text file of that name. Raises UsageError."""
    if re.search(r"[^-+0-9.eE,;\s]", text):
        try:
            text = file_text(Path(text))[:4096]
        except (OSError, ValueError) as error:
            raise UsageError(f"{option}: neither numbers nor a text file of numbers: {error}") from error
    try:
        numbers = [float(word) for word in re.split(r"[\s,;\[\]()]+", text) if word]
    except ValueError as error:
        raise UsageError(f"{option}: neither numbers nor a text file of numbers") from error
    if len(numbers) not in (9, 16):
        raise UsageError(f"{option}: {len(numbers)} numbers; expected 9 or 16, row by row")
    side = math.isqrt(len(numbers))
    return np.array(numbers).reshape(side, side)


def _check_affine(matrix: np.ndarray, option: str) -> None:
    """Raise UsageError if a 4 x 4 matrix is for row vectors or contains a projection."""
    below, beside = matrix[3, :3], matrix[:3, 3]
    if below.any() and not beside.any():
        turned = typed(matrix[:3, :3].T)
        raise UsageError(f"{option}: its translation is in the last row, for row vectors; use --view-matrix {turned}")
    if below.any():
        raise UsageError(f"{option}: its last row is not 0, 0, 0, 1, as with a projection; give only the view matrix")


def typed(matrix: np.ndarray) -> str:
    """Return a matrix as text for --view-matrix: numbers row by row, separated by commas."""
    return ",".join(f"{value + 0.0:.7g}" for value in matrix.ravel())


def _which_way(
    n: np.ndarray, covered: np.ndarray, to_view: np.ndarray | None, reading: Reading, chosen: Sequence[str]
) -> list[str]:
    """Return a line on the likely mistake in the space of normals, of shape (3, height, width) or (3, count), with
    its remedy; empty if no mistake is found."""
    if to_view is None:
        return []
    is_world = SPACES[reading.space] is None
    pixels = some_pixels(np.moveaxis(n, 0, -1), covered)
    finding = which_way(pixels, to_view, reading.fov, is_world)
    return [f"{finding.said}: {_remedy_text(finding.remedy, is_world, chosen)}"] if finding else []


def _remedy_text(remedy: np.ndarray | float | None, is_world: bool, chosen: Sequence[str]) -> str:
    if remedy is SWAPPED:
        return f"use --channels {','.join(reversed(chosen))}"
    if isinstance(remedy, np.ndarray):
        space = next(
            (name for name, known in SPACES.items() if known is not None and np.array_equal(known, remedy)), None
        )
        return f"use --space {space}" if space else f"use --space world --view-matrix {typed(remedy)}"
    if remedy is not None:
        return "check --fov, which is the vertical angle"
    if is_world:
        return "check --view-matrix"
    return (
        "if they are in world space, use --space world --view-matrix to transform them; if the engine encodes "
        "world-space normals, use --space world --code-space world"
    )


def _rays(n: np.ndarray, fov: float | None) -> np.ndarray:
    """Return view-space positions at depth 1, of shape (..., 3): through each pixel's centre, or straight ahead if
    `fov` is None or the normals are a list."""
    view = np.broadcast_to(np.array([0, 0, -1], np.float32), n.shape)
    if fov is None or n.ndim != 3:
        return view
    height, width = n.shape[:2]
    half = math.tan(math.radians(fov) / 2)
    view = view.copy()
    view[..., 0] = ((np.arange(width) + 0.5) / width * 2 - 1) * half * width / height
    view[..., 1] = ((1 - (np.arange(height) + 0.5) / height * 2) * half)[:, None]
    return view
