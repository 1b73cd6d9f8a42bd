"""Users' own codes of depth."""

from __future__ import annotations

from typing import Any

import numpy as np

from .....encodings.codecs.depth_codec import DepthEncoding
from .....encodings.kinds import DEPTH
from .....encodings.storages.depth_storage import DEPTH_STORAGES
from .....gbuffer.codecs.own.own_passes import Tried
from .....gbuffer.gl.device import Device
from .own import COUNT, Own, OwnKind, Values, longest, number, one_number_errors, rows

# The planes of functions that are given them; and between which depths functions without them are tried.
NEAR, FAR, NEAREST, FARTHEST = 0.1, 1000.0, 1e-4, 1e6
# What a depth of floats comes back as by half a step of an encoder's, as a share of the depth.
DEPTH_NEARLY = 1e-2


def _depths(own: Own) -> Values:
    """Depths between the planes, as many in each power of ten."""
    near, far = own.found.get("planes", (NEAR, FAR))
    return Values(rows(np.geomspace(near, far, COUNT)), rows(np.full(COUNT, near), far))


def _depth_errors(values: Values, found: Tried) -> np.ndarray:
    return one_number_errors(values, found) / values.given[:, 0]


def _depth_facts(own: Own, gl: Device) -> dict[str, Any]:
    """`planes`, between which functions that are given none undo each other, and `is_open`, whether codes lead beyond
    1, as depths in the scene's own units do."""
    planes = (NEAR, FAR)
    if not own.settings:
        depths = Values(rows(np.geomspace(NEAREST, FARTHEST, COUNT)), rows(np.zeros(COUNT)))
        found = own.tried(gl, depths.given, depths.more)
        planes = longest(depths.given[:, 0], _depth_errors(depths, found) < DEPTH_NEARLY) or planes
    facts = {"planes": planes}
    values = _depths(Own(own.file, own.made, facts))
    codes = own.tried(gl, values.given, values.more).codes[:, 0]
    is_open = bool(np.nanmax(codes) > 1 + DEPTH_NEARLY)
    notes = [OPEN] if is_open else []
    if not own.settings:
        notes.append(OWN_PLANES.format(*planes))
    return facts | {"is_open": is_open, "notes": notes}


OPEN = "its codes lead beyond 1: floats hold them, and nothing else"
OWN_PLANES = "it undoes itself for depths from {0:.3g} to {1:.3g}: --near and --far say where it is measured"


def _depth_encoding(own: Own) -> DepthEncoding:
    is_open = own.found.get("is_open", False)
    storages = tuple(name for name, storage in DEPTH_STORAGES.items() if storage.is_open or not is_open)
    return DepthEncoding(**own.described(), storages=storages)


KIND = OwnKind(
    kind=DEPTH,
    values=_depths,
    errors=_depth_errors,
    unit="of the depth",
    nearly=DEPTH_NEARLY,
    exactly=lambda _: {},
    encoding=_depth_encoding,
    facts=_depth_facts,
    said=number,
)
