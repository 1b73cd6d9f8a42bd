"""The process that runs a file of NumPy:

    python -m normalbench.bench.shaders.code.run.python_child FILE FOLDER PREFIX VALUE SETTINGS SIGN STRUCTURE FIELDS

VALUE and SETTINGS say where in n and view lies what the functions are given: n.xy,view.x. SIGN is how many numbers of
a code are signs that are kept elsewhere, 0 or 1. STRUCTURE is the type that holds the parts of VALUE, and FIELDS are
what they are called there; both are empty for none. It reads given.npz of the folder (n, view, texels) and writes
made.npz, with the names of `interface.Ran`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import numpy as np

from ....ground.machine import children
from ...translator.writer import PUBLIC
from .interface import Ran


def imported(path: Path) -> ModuleType:
    """A file as a module. Raises whatever the file raises."""
    spec = spec_from_file_location("normalbench_code", path)
    if not spec or not spec.loader:
        raise ImportError(f"{path.name} is not a file of Python")
    module = module_from_spec(spec)
    # No folder of bytecode next to a user's file.
    sys.dont_write_bytecode = True
    spec.loader.exec_module(module)
    return module


def _taken(rows: Mapping[str, np.ndarray], place: str) -> np.ndarray:
    """Some of the numbers of rows: n.xy; of one number an array of scalars."""
    name, _, fields = place.partition(".")
    taken = rows[name][..., ["xyzw".index(field) for field in fields]]
    return taken[..., 0] if len(fields) == 1 else taken


def _sorted(places: Iterable[str]) -> list[str]:
    """Places in the order of their rows and of their numbers there: n.xyz before n.w."""
    return sorted(places, key=lambda place: (place.partition(".")[0], "xyzw".index(place.partition(".")[2][0])))


def _joined(parts: Mapping[str, np.ndarray]) -> np.ndarray:
    """The fields of a structure as rows, by their places: what lies in n first."""
    ordered = [
        parts[place] if len(place.partition(".")[2]) > 1 else parts[place][..., None] for place in _sorted(parts)
    ]
    shape = np.broadcast_shapes(*(part.shape[:-1] for part in ordered))
    return np.concatenate([np.broadcast_to(part, (*shape, part.shape[-1])) for part in ordered], axis=-1)


def main(words: list[str]) -> None:
    """Run the six functions. Raises whatever they raise."""
    children.limit_this_process()
    path, folder, (prefix, value, settings, sign_bits, structure, fields) = Path(words[0]), Path(words[1]), words[2:]
    module = imported(path)
    six = {name: getattr(module, f"{prefix}_{name}") for name in PUBLIC}
    with np.load(folder / "given.npz") as given:
        rows = {name: given[name] for name in ("n", "view")}
        texels = given["texels"]
    behind = [_taken(rows, place) for place in settings.split(",") if place]
    places = value.split(",")
    given = [_taken(rows, place) for place in places]
    code = six["encode"](*([getattr(module, structure)(*given)] if structure else given), *behind)
    sign = (code[..., -1],) if int(sign_bits) else ()
    packed = six["pack"](code)
    unpacked = six["unpack"](packed, *sign)
    decoded, back = six["decode"](unpacked, *behind), six["from_target"](texels, *sign)
    if structure:
        decoded = _joined(
            {place: getattr(decoded, field) for place, field in zip(places, fields.split(","), strict=True)}
        )
    made = Ran(code, packed, unpacked, decoded, six["to_target"](code), back)
    np.savez(folder / "made.npz", **made._asdict())


if __name__ == "__main__":
    main(sys.argv[1:])
