"""Lists of the names to choose from. Imports nothing heavy."""

from __future__ import annotations

from ....encodings.catalogue import (
    CURVE_ENCODINGS,
    DEPTH_ENCODINGS,
    ENCODINGS,
    FRAME_ENCODINGS,
    LIGHT_BUFFERS,
    MOTION_ENCODINGS,
)
from ....encodings.codecs.encoding import Encoding
from ....encodings.codecs.variants import known_settings
from ....encodings.storages.depth_storage import DEPTH_STORAGES
from ....encodings.storages.rules import rule_of
from ....encodings.storages.storage import FRAME_STORAGES, MOTION_STORAGES, STORAGES, Storage
from ....gbuffer.effects.catalogue import EFFECTS
from ....gbuffer.effects.effect import Choice, Number
from ....gbuffer.environment.catalogue import ENVIRONMENTS
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.scenes.catalogue import SCENES
from ....reports.sheets import Row
from ...ground.choose import choose
from ...ground.options.words import Names

# Said here and not asked of normal_sets.py, which imports JAX; a test compares the two.
NORMAL_SETS = {
    "sphere": "directions spread evenly over the sphere, seeded",
    "hemisphere": "directions spread evenly over z >= 0, seeded",
    "axes": "axis-aligned, with +0 and -0, and neighbours a few ulps (units in the last place) away",
    "playground": "the scene of Pranckevicius' article rendered at 640 x 480, with four similar lamp arms",
}

# Sets that users' files are, by how they are named.
FILES_OF_NORMALS = {
    "FRAME.exr": "a captured frame; also .png, .tif, .dds, .hdr, .webp and .npy",
    "MESH.glb": "a mesh as a camera sees it; also .gltf, .obj and .ply",
    "MESH.glb#vertices": "its vertex normals in object space, each vertex once; also .gltf, .obj and .ply",
    "POINTS.ply": "the normals of a point cloud in object space: nx, ny, nz and no faces",
}

FILES_OF_DEPTHS = {"DEPTH.exr": "the depths of a frame; also .png, .tif and .npy; for `depth --depths`"}

FRAME_SETS = {"rotations": "rotations spread evenly, of either handedness, seeded"}

HOW = {"add": "adding", "multiply": "multiplying", "read": "reading and writing"}
COLUMNS = (
    *("kind", "name", "engine", "year", "title", "components", "domain", "bytes_per_pixel", "bytes_with_light"),
    *("reflects_by", "decals", "holds", "from"),
)


def _row(kind: str, name: str, title: str, **more: object) -> Row:
    return dict.fromkeys(COLUMNS) | {"kind": kind, "name": name, "title": title} | more


def _encodings() -> list[Row]:
    return [
        _row("encoding", e.name, e.title, domain=e.domain, holds=_settings_of(e))
        | {"components": f"{e.components}" + (" + sign" if e.sign_bits else ""), "from": e.citation}
        for e in ENCODINGS.values()
    ]


def _settings_of(encoding: Encoding) -> str | None:
    """Return `settings:` and the settings allowed after an encoding's name, joined by commas; None if it has none."""
    settings = ", ".join(known_settings(encoding))
    return f"settings: {settings}" if settings else None


# Storages by their bits, and what each holds; B are bits of a number, E and M of exponent and mantissa.
BY_BITS = {
    "unorm:B:...": "c/2+1/2 is i/(2^B-1), i from 0 to 2^B-1",
    "snorm:B:...": "c is i/(2^(B-1)-1), exact at -1, 0 and 1",
    "snorm_full:B:...": "c is i/2^(B-1), exact at -1, 0, not at 1",
    "snorm_gl2:B:...": "c is (2i+1)/(2^B-1): unorm's numbers",
    "centred:B:...": "snorm's integers and a half, in UNORM",
    "uint:B:... sint:B:...": "unorm and snorm in one integer, x lowest",
    "float:E:M ufloat:E:M": "as many as fit in 8 bytes, at most 4",
    "unorm:4:4..16:16": "every storage in a range of bit counts",
}


def _storages() -> list[Row]:
    named = [_row("storage", s.name, _rule_text(s), holds=_texel_text(s)) for s in STORAGES.values()]
    return named + [_row("storage by bits", name, holds) for name, holds in BY_BITS.items()]


def _rule_text(storage: Storage) -> str:
    """Return the bits of a storage as text; for floats, with the number of channels in front, as in `4 x ...`."""
    return f"{storage.channels} x {rule_of(storage)}" if storage.kind == "float" else rule_of(storage)


def _texel_text(storage: Storage) -> str:
    """Return a phrase on the size of a storage's texel and how components are placed in it."""
    texel = f"{storage.texel_bytes} bytes"
    return f"{texel}, across channels" if storage.is_packed else f"{texel}, one channel each"


def _depths() -> list[Row]:
    return [
        *(
            _row("depth", d.name, d.title, holds=f"usually in {', '.join(d.storages)}") | {"from": d.citation}
            for d in DEPTH_ENCODINGS.values()
        ),
        *(_row("depth storage", s.name, s.title, holds=f"{s.bits} bits") for s in DEPTH_STORAGES.values()),
        *(_row("depth set", name, title) for name, title in FILES_OF_DEPTHS.items()),
    ]


def _frames() -> list[Row]:
    return [
        *(
            _row("frame", f.name, f.title, holds=f"usually in {', '.join(f.storages)}") | {"from": f.citation}
            for f in FRAME_ENCODINGS.values()
        ),
        *(_row("frame storage", s.name, rule_of(s), holds=_texel_text(s)) for s in FRAME_STORAGES.values()),
        *(_row("frame set", name, title) for name, title in FRAME_SETS.items()),
    ]


def _vectors() -> list[Row]:
    return [
        *(
            _row("motion", m.name, m.title, holds=f"usually in {', '.join(m.storages)}") | {"from": m.citation}
            for m in MOTION_ENCODINGS.values()
        ),
        *(_row("motion storage", s.name, rule_of(s), holds=_texel_text(s)) for s in MOTION_STORAGES.values()),
    ]


def _curves() -> list[Row]:
    return [
        _row("curve", c.name, f"{c.title}, from 0 to {c.usual_range:g}") | {"from": c.citation}
        for c in CURVE_ENCODINGS.values()
    ]


def _normal_sets() -> list[Row]:
    return [_row("normals", name, title) for name, title in {**NORMAL_SETS, **FILES_OF_NORMALS}.items()]


def _layouts() -> list[Row]:
    return [
        _row("layout", layout.name, layout.title, bytes_per_pixel=layout.bytes_per_pixel)
        | {"engine": layout.engine or None, "year": layout.year or None, "from": layout.source}
        | {"bytes_with_light": layout.bytes_with_light, "decals": layout.decals or None}
        | {"reflects_by": layout.reflects_by or None}
        | {"holds": layout.summary}
        for layout in sorted(LAYOUTS.values(), key=lambda layout: (layout.engine.lower(), layout.year))
    ]


def _pipelines() -> list[Row]:
    return [
        _row("pipeline", p.name, p.title, holds=", ".join(stage.name for stage in p.stages)) | {"from": p.source}
        for p in PIPELINES.values()
    ]


def said(setting: Number | Choice) -> str:
    """Return a number's default and range as text, such as `1 (0.5 to 2)`; for a choice, its words, joined by `|`."""
    if isinstance(setting, Choice):
        return "|".join(setting.words)
    return f"{setting.usual:g} ({setting.least:g} to {setting.most:g})"


def _effects() -> list[Row]:
    return [
        _row("effect", e.name, e.title, holds=", ".join(f"{name}={said(s)}" for name, s in e.settings.items()))
        | {"from": e.source}
        for e in EFFECTS.values()
    ]


def _environments() -> list[Row]:
    return [_row("environment", environment.name, environment.title) for environment in ENVIRONMENTS.values()]


def _scenes() -> list[Row]:
    return [_row("scene", scene.name, scene.title) for scene in SCENES.values()]


def _light_buffers() -> list[Row]:
    return [
        _row("light buffer", light.name, light.title, bytes_per_pixel=light.bytes_per_pixel)
        | {"holds": f"up to {light.limit:.6g}, accumulated by {HOW[light.blend]}", "from": light.encoding.citation}
        for light in LIGHT_BUFFERS.values()
    ]


KINDS = {
    "encodings": _encodings,
    "storages": _storages,
    "depths": _depths,
    "frames": _frames,
    "vectors": _vectors,
    "curves": _curves,
    "normals": _normal_sets,
    "layouts": _layouts,
    "pipelines": _pipelines,
    "effects": _effects,
    "scenes": _scenes,
    "environments": _environments,
    "lights": _light_buffers,
}


def listing(what: Names) -> list[Row]:
    """Return the rows that list some of KINDS, or all of them for "all". Raises UsageError."""
    return [row for rows in choose("list", what, KINDS) for row in rows()]
