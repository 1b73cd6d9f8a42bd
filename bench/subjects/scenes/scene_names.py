"""Scenes by name: from the catalogue, users' mesh files, and captured frames."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from ....encodings.codecs.files import called
from ....gbuffer.scenes.catalogue import SCENES, SceneMaker
from ....gbuffer.scenes.files.read import FRAMES, READERS, file_scene
from ....gbuffer.scenes.scene import Scene
from ....gbuffer.scenes.setting import Setting
from ...ground.choose import choose_or_read
from ...ground.options.words import Names
from ...ground.output.errors import tell
from .captured_frame import captured_frame, lines_of
from .frame_file import ENDING, read_frame_file
from .mesh_files import mesh_file, say_notes

ENDINGS = (*READERS, ENDING)


def scene_makers_named(names: Names) -> list[SceneMaker]:
    """Return the scenes with these names: from the catalogue, mesh files, or captured frames.

    Raises:
        UsageError: a name is unknown, or a file cannot be read.
    """
    notes: dict[Path, Sequence[str]] = {}
    lines: list[str] = []

    def scene_of(path: Path) -> SceneMaker:
        name = called(path.name)
        if path.suffix.lower() == ENDING:
            frame = read_frame_file(path)
            capture = captured_frame(frame)
            lines.extend(lines_of(frame, capture))
            return SceneMaker(
                name, f"the pixels of {name}", partial(_given, capture.scene), FRAMES, None, True, capture.sides
            )
        file = mesh_file(path)
        notes[path] = file.notes
        return SceneMaker(name, f"the meshes of {name}", partial(file_scene, file), FRAMES, None, file.is_metal_rough)

    makers = choose_or_read("scene", names, SCENES, ENDINGS, scene_of)
    say_notes(notes)
    for line in lines:
        tell(line)
    return makers


def _given(scene: Scene, _: Setting) -> Scene:
    """Return the given scene for any setting."""
    return scene
