"""What there is to choose from. Imports nothing heavy."""

from __future__ import annotations

from ..encodings.catalogue import ENCODINGS
from ..encodings.storage import STORAGES
from .errors import pick

# Said here and not asked of normal_sets.py, which imports JAX; a test compares the two.
NORMAL_SETS = {
    "sphere": "directions spread evenly over the sphere, seeded",
    "hemisphere": "directions spread evenly over z >= 0, seeded",
    "axes": "axis-aligned, both zeros, and a few units in the last place around",
    "playground": "the seeds' scene rendered at 640 x 480, without its four lamp arms",
}


def _encodings() -> list[dict[str, object]]:
    return [
        {
            "kind": "encoding",
            "name": e.name,
            "title": e.title,
            "components": f"{e.components}" + (" + sign" if e.sign_bits else ""),
            "domain": e.domain,
            "from": e.citation,
        }
        for e in ENCODINGS.values()
    ]


def _storages() -> list[dict[str, object]]:
    return [
        {
            "kind": "storage",
            "name": s.name,
            "title": f"{s.title}, {s.kind}",
            "components": str(s.channels),
            "domain": None,
            "from": f"{':'.join(map(str, s.bits))} bits",
        }
        for s in STORAGES.values()
    ]


def _normal_sets() -> list[dict[str, object]]:
    return [
        {"kind": "normals", "name": name, "title": title, "components": None, "domain": None, "from": None}
        for name, title in NORMAL_SETS.items()
    ]


KINDS = {"encodings": _encodings, "storages": _storages, "normals": _normal_sets}


def listing(what: str) -> list[dict[str, object]]:
    """Rows for "encodings", "storages", "normals" (comma-separated) or "all". Raises UsageError."""
    return [row for rows in pick("list", what, KINDS) for row in rows()]
