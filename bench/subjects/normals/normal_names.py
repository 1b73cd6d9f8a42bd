"""Sets of normals by name: from the catalogue, and from users' captures and meshes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, get_type_hints

from ....encodings.codecs.encoding import Encoding
from ....encodings.codecs.files import called
from ....gbuffer.scenes.files import read as files
from ...ground.choose import choose_or_read, names_a_folder
from ...ground.options.counts import checked_sides
from ...ground.options.option import Count, Reading, fields_of
from ...ground.options.words import Given, Names, text_of
from ...ground.output.errors import UsageError, tell
from ..scenes.mesh_files import mesh_file, say_notes
from . import vertices
from .captures import CODE_SPACES, capture
from .normal_sets import LACKS_RAYS, NORMAL_SETS, NormalSet, from_arrays
from .own_errors import own_error_note
from .pixel_files import MAX_PIXELS, has_normals_alone
from .pixel_files import READERS as IMAGES

WORLD = CODE_SPACES[1]
SEES_NOTHING = "its camera sees nothing; move it, or remove it to frame everything"
MAX_SIDE = 16384
ENDINGS = (*IMAGES, *files.READERS, *vertices.ENDINGS)
JPEG = "JPEG compression changes normals; save the frame as EXR or PNG"
# By its ending, why a file of another kind is not read, and what is.
OTHERS: Mapping[str, str] = MappingProxyType(
    {".jpg": JPEG, ".jpeg": JPEG, ".npz": "an archive of arrays; save one array as .npy with np.save"}
)


def normal_sets_named(
    names: Names, count: int, seed: int, reading: Reading, needs_rays: bool = False
) -> list[NormalSet]:
    """Return the sets with these names: from the catalogue, captures, or meshes seen by a camera.

    If `needs_rays`, captures without an angle of view are reported on standard error.

    Raises:
        UsageError: a name is unknown, a file cannot be read, or an option applies to no file.
    """
    typed = [word for word in names if isinstance(word, str)]
    for word in typed:
        _check_kind(word)
    is_read_so = any(has_normals_alone(Path(word)) for word in typed)
    if reading != Reading(size=reading.size) and not is_read_so:
        reason = f"--normals {text_of(names)} names no capture ({', '.join(IMAGES)})"
        raise UsageError(f"options for captures are given, but {reason}")

    notes: dict[Path, list[str]] = {}

    def read(path: Path) -> Callable[[int, int], NormalSet]:
        if path.suffix.lower() in vertices.ENDINGS:
            normal_set, notes[path] = vertices.vertex_set(path)
        elif has_normals_alone(path):
            normal_set, notes[path] = capture(path, reading)
            if needs_rays and reading.code_space == WORLD and reading.view_matrix is None:
                raise UsageError("encodings that need the view ray require --view-matrix with --code-space world")
            if needs_rays and reading.fov is None and normal_set.has_rays:
                notes[path].append("without --fov, encodings that need view rays use parallel rays")
        else:
            normal_set, notes[path] = mesh_set(path, reading.size)
        return given(normal_set)

    words = [Given(word.name, given(word.value)) if isinstance(word, Given) else word for word in names]
    sets = [make(count, seed) for make in choose_or_read("normal set", words, NORMAL_SETS, ENDINGS, read)]
    say_notes(notes)
    return sets


def lacking_rays(pairs: Iterable[tuple[Encoding, NormalSet]]) -> list[str]:
    """Return a line for each pair of an encoding and a set that cannot be measured for lack of view rays."""
    return [
        f"{encoding.name} on {normal_set.name}: {LACKS_RAYS}"
        for encoding, normal_set in pairs
        if not normal_set.serves(encoding)
    ]


def check_rays(sets: Iterable[NormalSet], needs_rays: bool) -> None:
    """Raise UsageError if an encoding to be measured needs view rays and a set has none."""
    if needs_rays and (lacking := next((normal_set for normal_set in sets if not normal_set.has_rays), None)):
        raise UsageError(f"--normals {lacking.name}: cannot be used with this encoding: {LACKS_RAYS}")


def _check_kind(word: str) -> None:
    """Raise UsageError for a file of an unsupported kind, a folder, or an unknown part of a file."""
    vertices.check_part(word)
    if (ending := Path(word).suffix.lower()) in OTHERS:
        raise UsageError(f"{word}: {OTHERS[ending]}")
    if names_a_folder(word) and word not in NORMAL_SETS and ending not in ENDINGS:
        raise UsageError(f"{word}: it is a folder; name files in it, separated by commas")


def say_count_is_unused(options: Any) -> None:
    """Tell the user that --count has no effect, if it is given and every set of normals is a file."""
    known = fields_of(type(options))
    if not isinstance(options, Reading) or "count" not in known:
        return
    if getattr(options, "count", None) == known["count"].default or not _is_of_normals(type(options)):
        return
    words = [str(word) for word in getattr(options, "normals", None) or ("sphere",)]
    if all(Path(word).suffix.lower() in ENDINGS for word in words):
        tell(f"--count has no effect on files: every normal of {', '.join(words)} is measured")


def _is_of_normals(options: type) -> bool:
    """Whether the option `count` is the number of normals in a set, not of something made from the normals."""
    return get_type_hints(options, include_extras=True)["count"] == Count


def given(normal_set: NormalSet) -> Callable[[int, int], NormalSet]:
    """Return a function that returns this set for any count and seed."""
    return lambda *_: normal_set


def mesh_set(path: Path, size: str) -> tuple[NormalSet, list[str]]:
    """Return the meshes in a file as the file's camera sees them, or as a camera that frames them does; and remarks
    on the set.

    Raises UsageError.
    """
    sides = checked_sides(size, MAX_SIDE, "for the image of a mesh")
    if math.prod(sides) > MAX_PIXELS:
        raise UsageError(f"--size {size}: {math.prod(sides)} pixels; the maximum is {MAX_PIXELS} (2^25)")
    file = mesh_file(path)
    seen = files.seen(file, sides)
    if not seen.covered.any():
        raise UsageError(f"{path}: {SEES_NOTHING}")
    notes = [*file.notes, *([] if file.view else ["no camera in it: everything is framed, from one side"])]
    if (own := seen.map_error_deg) is not None:
        notes.append(own_error_note("its normal maps have 8 bits per channel and", own))
    of_vertices, vertex_notes = vertices.drawn_error(path)
    name = called(path.name)
    normal_set = from_arrays(name, f"the meshes of {name}", seen.normals, seen.positions, seen.covered, sides[::-1])
    own = math.hypot(seen.map_error_deg or 0.0, of_vertices)
    return replace(normal_set, own_error_deg=own or None), notes + vertex_notes
